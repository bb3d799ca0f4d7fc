// Can a mesher's program be run at all? Asked once, before the first model.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "corpus/campaigns/disposition.h"
#include "corpus/campaigns/supervise/supervisor.h"

namespace tetproof {

// A mesher that cannot be run on any model: its program does not exist, is not executable, or is a
// script whose interpreter does not exist, or it does not know what it is asked for. Says nothing
// about any model, and ends a campaign.
struct CannotRun : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Why the program that a line of shell begins with cannot be run; empty if it can. Lines that begin
// with something that only the shell knows (a keyword, a variable) are not examined; cannot_run()
// decides on them at the first model.
// \throw CannotRun if not even the supervisor or the shell can be run.
std::string why_not_runnable(const std::string& line, const std::filesystem::path& supervisor);

// Why a script's interpreter ("#!" in its first line) cannot be run; empty if it can.
std::string why_no_interpreter(const std::filesystem::path& program);

// Did the run end because there was nothing to run: exec failed, a shell says so by its exit codes
// 126 (not executable) and 127 (not found), or a program with our exit codes was called in a wrong
// way?
bool cannot_run(const Outcome& outcome, ExitCodes codes, bool through_shell);

}  // namespace tetproof
