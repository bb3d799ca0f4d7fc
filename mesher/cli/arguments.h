// The command line, parsed and checked.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "mesher/delmesher_files.h"
#include "mesher/delmesher_plane.h"

namespace delmesher::cli {

enum class Job : std::uint8_t { mesh, cdt, plane, check, improve, repair, remesh };

// Exit codes of all programs of the project.
inline constexpr int kDone = 0, kFailed = 1, kUsage = 2, kUnreadable = 3, kInvalid = 4, kLimit = 5,
                     kInternal = 6, kInterrupted = 130;

// In the order of Job.
using JobOptions = std::variant<Options, CdtOptions, PlaneOptions, CheckOptions, ImproveOptions,
                                RepairOptions, RemeshOptions>;

struct Command {
  std::string input;
  std::vector<std::string> outputs;
  JobOptions options;
  std::string stats_file, chamfered_file, exact_file;  // empty: not wanted
  std::string names_file;                              // empty: names of the input
  std::string sizes_file;                              // empty: no size field
  std::string points_file;                             // empty: those of the input alone
  std::string defects_file;                            // of check
  double label_angle = 0;                              // 0: labels as read
  io::WriteOptions write;
  bool json = false, quiet = false, verbose = false;

  Job job() const { return static_cast<Job>(options.index()); }
};

// The files that are written beside the outputs.
inline constexpr std::string Command::*kWrittenBeside[] = {
    &Command::stats_file, &Command::chamfered_file, &Command::exact_file, &Command::defects_file};

// Either a command to run, or a text to print and an exit code.
struct Parsed {
  bool run = false;
  Command command;             // the first of the batch, if there is one
  std::vector<Command> batch;  // one for each input, if there are several
  unsigned jobs = 1;           // how many of them at a time
  int exit_code = kDone;
  std::string out, error;  // for stdout and stderr
};

// `arguments` without the program's name. Without a subcommand, `mesh` is meant. Nothing is opened.
Parsed parse_arguments(std::vector<std::string> arguments);

}  // namespace delmesher::cli
