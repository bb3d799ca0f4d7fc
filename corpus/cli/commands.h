// The subcommands of tetproof; each adds its options and, when chosen, runs and returns an exit
// code: 0 done, 1 a check failed, 2 usage, 3 unreadable input, 130 interrupted.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace tetproof {

struct Command {
  CLI::App* app;
  std::function<int()> run;
};

Command add_run_command(CLI::App& tetproof);
Command add_report_command(CLI::App& tetproof);
Command add_measure_command(CLI::App& tetproof);

}  // namespace tetproof
