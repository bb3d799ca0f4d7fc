// The runner's side of a supervised child process (see supervise/supervisor.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "corpus/campaigns/supervise/supervisor.h"

namespace tetproof {

struct ProcessSpec {
  std::vector<std::string> argv;
  std::filesystem::path directory = ".";
  Limits limits;
};

// A running job. Single-threaded callers wait with poll() on fd(); when readable, advance().
class SupervisedProcess {
 public:
  // \throw std::runtime_error if the supervisor cannot be started.
  SupervisedProcess(const std::filesystem::path& supervisor, const ProcessSpec& spec);
  SupervisedProcess(const SupervisedProcess&) = delete;
  SupervisedProcess& operator=(const SupervisedProcess&) = delete;
  // Ends the job if it still runs and waits until nothing of it is left.
  ~SupervisedProcess();

  int fd() const { return report_fd_; }
  // Reads the report as far as it is there. True once the job is over and outcome() is final.
  bool advance();
  // Asks for the end of the job: everything below the supervisor is killed.
  void stop();
  const Outcome& outcome() const { return outcome_; }

 private:
  void finish();

  pid_t pid_ = -1;
  int control_fd_ = -1, report_fd_ = -1;
  bool done_ = false;
  std::string report_;
  Outcome outcome_;
};

// Runs to the end, for callers with a single job.
Outcome run_supervised(const std::filesystem::path& supervisor, const ProcessSpec& spec);

// A program installed or built beside the running one.
std::filesystem::path beside_this_program(const std::string& name);

// The name of a signal, as in "SIGSEGV".
std::string signal_name(int signal);

}  // namespace tetproof
