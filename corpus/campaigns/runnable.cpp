#include "corpus/campaigns/runnable.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "corpus/campaigns/process.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

constexpr int kNotExecutable = 126, kNotFound = 127;  // POSIX, "Exit Status for Commands"
constexpr int kUsage = 2;                             // of all programs of the project

// The first word of a command line if it is plain, that is, if no expansion changes it.
std::string plain_first_word(const std::string& line) {
  std::istringstream in(line);
  std::string word;
  in >> word;
  const bool plain = word.find_first_of("'\"\\$`=;&|<>(){}*?[]#~!") == std::string::npos;
  return plain ? word : "";
}

}  // namespace

std::string why_no_interpreter(const fs::path& program) {
  std::ifstream file(program, std::ios::binary);
  std::string line;
  if (file.get() != '#' || file.get() != '!' || !std::getline(file, line)) return "";
  // As in the kernel, a carriage return belongs to the name.
  const auto start = std::min(line.find_first_not_of(" \t"), line.size());
  const std::string interpreter = line.substr(start, line.find_first_of(" \t", start) - start);
  if (access(interpreter.c_str(), X_OK) == 0 && fs::is_regular_file(interpreter)) return "";
  return "its interpreter " + interpreter + " cannot be run";
}

std::string why_not_runnable(const std::string& line, const fs::path& supervisor) {
  const std::string word = plain_first_word(line);
  // Prints the path of a program, or the name of a command that the shell has built in.
  const ProcessSpec ask = {
      .argv = {"/bin/sh", "-c", "command -v -- \"$1\"", "sh", word.empty() ? "true" : word},
      .directory = "/",
      .limits = {.wall_seconds = 60}};
  Outcome outcome;
  try {
    outcome = run_supervised(supervisor, ask);
  } catch (const std::runtime_error& error) {
    throw CannotRun(error.what());
  }
  if (outcome.ending != Ending::exited) {
    throw CannotRun(outcome.error.empty() ? "/bin/sh: " + judge(outcome, ExitCodes::unknown).reason
                                          : outcome.error);
  }
  if (word.empty()) return "";
  if (word.find('/') != std::string::npos && word[0] != '/') {
    return word + ": commands run in a folder of their own; an absolute path is expected";
  }
  if (outcome.exit_code != 0) return word + ": not found";
  const fs::path program = last_line(outcome.stdout_tail);
  if (!program.is_absolute()) return "";
  if (!fs::is_regular_file(program)) return word + ": is not a file";
  if (access(program.c_str(), X_OK) != 0) return word + ": is not executable";
  const std::string interpreter = why_no_interpreter(program);
  return interpreter.empty() ? "" : word + ": " + interpreter;
}

bool cannot_run(const Outcome& outcome, ExitCodes codes, bool through_shell) {
  if (outcome.ending == Ending::not_started) return true;
  if (outcome.ending != Ending::exited) return false;
  if (codes == ExitCodes::ours && outcome.exit_code == kUsage) return true;
  return through_shell && (outcome.exit_code == kNotExecutable || outcome.exit_code == kNotFound);
}

}  // namespace tetproof
