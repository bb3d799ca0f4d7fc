#include "mesher/cli/signals.h"

#include <unistd.h>

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

constexpr std::size_t kMaxTemporaries = 64, kMaxPath = 4096;
std::array<std::array<char, kMaxPath>, kMaxTemporaries> temporaries;
std::atomic<std::size_t> temporary_count = 0;

extern "C" void handle_signal(int) {
  const bool first = !signal_seen.exchange(true);
  if (first && deferring.load()) return;
  const std::size_t count = temporary_count.load();
  for (std::size_t i = 0; i < count; ++i) ::unlink(temporaries[i].data());
  ::_exit(kInterrupted);
}

}  // namespace

void install_signal_handlers() {
  struct sigaction action = {};
  action.sa_handler = handle_signal;
  sigemptyset(&action.sa_mask);
  sigaddset(&action.sa_mask, SIGINT);
  sigaddset(&action.sa_mask, SIGTERM);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
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

}  // namespace delmesher::cli
