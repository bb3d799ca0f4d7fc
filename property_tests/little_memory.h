// Processes that run out of memory.
#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <fstream>
#include <functional>
#include <new>
#include <string>
#include <vector>

namespace tetproof {

// Runs a process that may use this much more address space than it has: returns its exit code, or
// -1 if it was killed, after two minutes at the latest. Appends its output to `said`.
inline int with_more_memory(std::size_t bytes, const std::string& said,
                            const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t limit = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + bytes;
    const rlimit both = {limit, limit};
    const bool ready = std::freopen(said.c_str(), "a", stderr) != nullptr &&
                       std::freopen("/dev/null", "w", stdout) != nullptr &&
                       setrlimit(RLIMIT_AS, &both) == 0;
    alarm(120);
    const int code = ready ? work() : 99;
    std::fflush(nullptr);
    _exit(code);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Not with sanitizers: they take address space for themselves, and end a process that wants too
// much.
inline bool can_be_limited(const std::string& said) {
  return with_more_memory(64 << 20, said, [] {
           const std::vector<char> some(1 << 20, 'x');
           void* const volatile too_much = ::operator new (std::size_t{256} << 20, std::nothrow);
           return some.back() == 'x' && too_much == nullptr ? 0 : 1;
         }) == 0;
}

}  // namespace tetproof
