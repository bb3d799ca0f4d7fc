// The clock of the benchmarks.
#pragma once

#include <ctime>

namespace tetproof {

// Processor time of the calling thread so far. Not std::clock(): under a limit of processor time
// (RLIMIT_CPU) Linux counts that of a process by ticks of milliseconds.
inline double thread_seconds() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace tetproof
