// Runs one command under limits of wall time, processor time and memory. They hold for all
// processes that it starts: children, grandchildren, and processes that ignore signals or leave
// their process group.
//
// This is a small program of its own (tetproof-supervise) rather than part of the runner, because
//   - as "subreaper" it inherits orphaned grandchildren, and every process below it belongs to
//     exactly one job;
//   - it ends the job when its control pipe closes, hence also when the runner is killed;
//   - Linux counts the resident set of the forking process in the peak of the forked one, and
//     this program is small.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tetproof {

// Is RLIMIT_DATA set in addition to polling? Not in builds with a sanitizer, whose shadow memory
// alone is beyond any limit.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kMemoryBackstop = false;
#elif defined(__has_feature)
inline constexpr bool kMemoryBackstop =
    !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
inline constexpr bool kMemoryBackstop = true;
#endif

// Limits of one child; 0 means none.
struct Limits {
  double wall_seconds = 0;
  double cpu_seconds = 0;          // all processes of the job together, ended ones included
  std::uint64_t memory_bytes = 0;  // resident, all processes together, shared pages once
  std::uint64_t file_bytes = 0;    // largest file it may write
};

// Why the command ended.
enum class Ending : std::uint8_t {
  exited,      // by itself: exit code
  signalled,   // by a signal that the supervisor did not send
  wall_limit,  // ended by the supervisor ...
  cpu_limit,
  memory_limit,
  stopped,      // ... because the runner asked
  not_started,  // exec failed: see Outcome::error
  lost          // the supervisor itself vanished
};

const char* ending_name(Ending ending);

struct Outcome {
  Ending ending = Ending::lost;
  int exit_code = -1;  // if exited
  int signal = 0;      // if signalled
  double wall_seconds = 0, cpu_seconds = 0;
  std::uint64_t peak_rss_bytes = 0;  // largest of getrusage and of the polled sum over the job
  int leftover_processes = 0;        // processes of the job ended after the command was done
  int unkillable_processes = 0;      // still there after all attempts
  std::string error;                 // not_started: why
  std::string stderr_tail, stdout_tail;
};

// Runs argv in the calling process's environment until it ends or `control_fd` reaches its end of
// file (-1: no control). Must be called from a single-threaded process without other children; it
// changes signal masks and becomes a subreaper.
Outcome supervise(const std::vector<std::string>& argv, const Limits& limits, int control_fd);

// The report passed from the supervisor to the runner.
std::string serialize(const Outcome& outcome);
bool deserialize(const std::string& text, Outcome& outcome);

}  // namespace tetproof
