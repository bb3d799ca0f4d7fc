#include "mesher/cli/signals.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

#include "mesher/cli/arguments.h"

namespace delmesher::cli {
namespace {

// A signal handler can reach nothing but globals: the only ones of the program.
std::atomic<bool> signal_seen = false;
std::atomic<bool> deferring = false;
std::atomic<bool> files_in_place = false;

constexpr std::size_t kMaxTemporaries = 64, kMaxPath = 4096;
std::array<std::array<char, kMaxPath>, kMaxTemporaries> temporaries;
std::atomic<std::size_t> temporary_count = 0;

// At most as many as --jobs allows; 0 is free.
constexpr std::size_t kMaxChildren = 1024;
std::array<std::atomic<pid_t>, kMaxChildren> children;

// A terminal sends its signals to all processes of the group by itself.
bool is_from_terminal(const siginfo_t* info) {
#ifdef SI_KERNEL
  return info != nullptr && info->si_code == SI_KERNEL;
#else
  static_cast<void>(info);
  return false;
#endif
}

extern "C" void handle_signal(int signal, siginfo_t* info, void*) {
  for (const std::atomic<pid_t>& child : children) {
    if (const pid_t pid = child.load(); pid > 0 && !is_from_terminal(info)) ::kill(pid, signal);
  }
  if (files_in_place.load()) return;  // the run has done what it was to do
  const bool first = !signal_seen.exchange(true);
  if (first && deferring.load()) return;
  const std::size_t count = temporary_count.load();
  for (std::size_t i = 0; i < count; ++i) {
    if (::unlink(temporaries[i].data()) != 0) ::rmdir(temporaries[i].data());
  }
  ::_exit(kInterrupted);
}

std::array<int, 4> signals() {
  return {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
}

sigset_t signal_set() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals()) sigaddset(&set, signal);
  return set;
}

}  // namespace

void install_signal_handlers() {
  struct sigaction action = {};
  action.sa_sigaction = handle_signal;
  action.sa_flags = SA_SIGINFO;
  action.sa_mask = signal_set();
  for (const int signal : signals()) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  // A full pipe or file is an error of the write then.
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

Committing::Committing() {
  const sigset_t ours = signal_set();
  sigprocmask(SIG_BLOCK, &ours, &before_);
}
Committing::~Committing() {
  sigprocmask(SIG_SETMASK, &before_, nullptr);
}

void note_files_in_place(bool there) {
  files_in_place = there;
}

void begin_deferring() {
  deferring = true;
}

void end_deferring() {
  deferring = false;
}

bool interrupted() {
  return signal_seen;
}

void set_temporaries(const std::vector<std::string>& paths) {
  temporary_count = 0;
  std::size_t count = 0;
  for (const std::string& path : paths) {
    if (count == kMaxTemporaries || path.size() >= kMaxPath) continue;
    std::memcpy(temporaries[count++].data(), path.c_str(), path.size() + 1);
  }
  temporary_count = count;
}

int fork_child() {
  const auto slot = std::find(children.begin(), children.end(), 0);
  if (slot == children.end()) return -1;
  const sigset_t ours = signal_set();
  sigset_t before;
  sigprocmask(SIG_BLOCK, &ours, &before);  // until it is known to whom they are passed on
  const pid_t pid = ::fork();
  if (pid > 0) *slot = pid;
  if (pid == 0) {
    for (std::atomic<pid_t>& child : children) child = 0;
    end_deferring();
  }
  sigprocmask(SIG_SETMASK, &before, nullptr);
  return pid;
}

void forget_child(int pid) {
  std::replace(children.begin(), children.end(), pid, 0);
}

}  // namespace delmesher::cli
