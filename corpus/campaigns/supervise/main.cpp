// tetproof-supervise REPORT_FD DIRECTORY WALL_S CPU_S MEMORY_BYTES FILE_BYTES COMMAND [ARG...]
//
// Runs COMMAND in DIRECTORY under limits (0: none), ends it when standard input closes, and writes
// the outcome to REPORT_FD. Started by tetproof; see supervisor.h.
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "corpus/campaigns/supervise/supervisor.h"

int main(int argc, char** argv) {
  if (argc < 8) {
    std::fprintf(stderr, "tetproof-supervise is started by tetproof\n");
    return 2;
  }
  const int report = std::atoi(argv[1]);
  fcntl(report, F_SETFD, FD_CLOEXEC);
  setsid();  // a Ctrl-C at the terminal is the runner's to handle
  tetproof::Limits limits;
  limits.wall_seconds = std::atof(argv[3]);
  limits.cpu_seconds = std::atof(argv[4]);
  limits.memory_bytes = std::strtoull(argv[5], nullptr, 10);
  limits.file_bytes = std::strtoull(argv[6], nullptr, 10);
  const std::vector<std::string> command(argv + 7, argv + argc);

  tetproof::Outcome outcome;
  if (chdir(argv[2]) != 0) {
    outcome.ending = tetproof::Ending::not_started;
    outcome.error = std::string(argv[2]) + ": cannot be entered";
  } else {
    outcome = tetproof::supervise(command, limits, STDIN_FILENO);
  }
  const std::string text = tetproof::serialize(outcome);
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t size = write(report, text.data() + at, text.size() - at);
    if (size <= 0) return 3;
    at += static_cast<std::size_t>(size);
  }
  return 0;
}
