#include "corpus/campaigns/process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

extern char** environ;

namespace tetproof {
namespace {

std::string text_of(double value) {
  std::array<char, 40> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end.ptr};
}

[[noreturn]] void fail(const std::string& what, int error) {
  throw std::runtime_error(what + ": " + std::strerror(error));
}

std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe", errno);
  return ends;
}

// Starts the program with `control` as standard input and `report` as descriptor 3.
pid_t spawn(const std::vector<std::string>& argv, int control, int report) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, control, 0);
  posix_spawn_file_actions_adddup2(&actions, report, 3);
  std::vector<char*> arguments;
  for (const std::string& argument : argv) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) fail(argv[0], error);
  return pid;
}

// A pipe end that is not descriptor 0 or 3, which spawn() overwrites in the child.
int move_away(int fd) {
  const int moved = fcntl(fd, F_DUPFD_CLOEXEC, 10);
  if (moved < 0) fail("fcntl", errno);
  close(fd);
  return moved;
}

}  // namespace

SupervisedProcess::SupervisedProcess(const std::filesystem::path& supervisor,
                                     const ProcessSpec& spec) {
  std::vector<std::string> argv = {supervisor.string(),
                                   "3",
                                   spec.directory.string(),
                                   text_of(spec.limits.wall_seconds),
                                   text_of(spec.limits.cpu_seconds),
                                   std::to_string(spec.limits.memory_bytes),
                                   std::to_string(spec.limits.file_bytes)};
  argv.insert(argv.end(), spec.argv.begin(), spec.argv.end());
  auto [control_read, control_write] = make_pipe();
  auto [report_read, report_write] = make_pipe();
  control_read = move_away(control_read);
  report_write = move_away(report_write);
  control_fd_ = control_write;
  report_fd_ = report_read;
  pid_ = spawn(argv, control_read, report_write);
  close(control_read);
  close(report_write);
}

SupervisedProcess::~SupervisedProcess() {
  stop();
  while (!advance()) {
    pollfd waiting = {report_fd_, POLLIN, 0};
    poll(&waiting, 1, -1);
  }
}

bool SupervisedProcess::advance() {
  if (done_) return true;
  pollfd ready = {report_fd_, POLLIN, 0};
  while (poll(&ready, 1, 0) > 0) {
    std::array<char, 4096> buffer;
    const ssize_t size = read(report_fd_, buffer.data(), buffer.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) {
      finish();
      return true;
    }
    report_.append(buffer.data(), static_cast<std::size_t>(size));
  }
  return false;
}

void SupervisedProcess::finish() {
  close(report_fd_);
  report_fd_ = -1;
  stop();
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (!deserialize(report_, outcome_)) outcome_ = Outcome{};
  done_ = true;
}

void SupervisedProcess::stop() {
  if (control_fd_ >= 0) close(control_fd_);
  control_fd_ = -1;
}

Outcome run_supervised(const std::filesystem::path& supervisor, const ProcessSpec& spec) {
  SupervisedProcess process(supervisor, spec);
  while (!process.advance()) {
    pollfd waiting = {process.fd(), POLLIN, 0};
    poll(&waiting, 1, -1);
  }
  return process.outcome();
}

std::filesystem::path beside_this_program(const std::string& name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

std::string signal_name(int signal) {
  const char* name = sigabbrev_np(signal);
  return name != nullptr ? std::string("SIG") + name : "signal " + std::to_string(signal);
}

}  // namespace tetproof
