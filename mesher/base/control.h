// Limits, cancellation and progress: the one object that long loops consult.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "mesher/base/namespaces.h"
#include "mesher/delmesher/run.h"

namespace delmesher::base {

// Thrown out of a stage when the caller cancelled or a limit was reached; caught by the public API.
struct Stopped {
  Status status;
};

// Throws Stopped, as a limit: a valid surface has features at `where` ("edge 3-7") that points with
// parameters of doubles cannot tell apart. Such a surface has coordinates far smaller than an ulp
// of its size.
[[noreturn]] void stop_at_precision(const std::string& where);

// Not thread-safe: one Control belongs to one call of the public API.
class Control {
 public:
  explicit Control(const Limits& limits);

  // Starts a phase and reports it; closes the previous one (its time is kept in phase_seconds()).
  void enter(Phase phase);

  // To be called in every long loop, at least a few times per millisecond; costs a counter
  // increment most of the time. Throws Stopped when the run has to end. `vertices` is the present
  // number of mesh vertices, checked against Limits::max_vertices; `done` in [0, 1] is the
  // fraction of the phase, or negative if unknown.
  void poll(std::uint64_t vertices = 0, double done = -1);

  // Consults clock and callback now, whatever the counter says.
  void poll_now(std::uint64_t vertices, double done);

  // No more vertices from now on, whatever Limits::max_vertices says beyond that: the run ends with
  // this status.
  void allow(std::uint64_t vertices, Status beyond) {
    allowed_ = vertices;
    beyond_ = std::move(beyond);
  }

  // Reported with the progress from now on.
  void predict(double tetrahedra) { predicted_ = tetrahedra; }

  // Seconds spent in each phase so far, indexed by Phase.
  const std::array<double, kPhaseCount>& phase_seconds() const { return seconds_; }
  void finish();

  // How many threads may share the work: Limits::threads, at least 1 (see base/parallel.h).
  unsigned threads() const { return threads_; }

 private:
  using Clock = std::chrono::steady_clock;

  const Limits& limits_;
  unsigned threads_;
  Clock::time_point start_;
  Clock::time_point phase_start_;
  Phase phase_ = Phase::check;
  bool in_phase_ = false;
  std::uint32_t calls_ = 0;
  double predicted_ = 0;
  std::uint64_t allowed_ = std::numeric_limits<std::uint64_t>::max();
  Status beyond_;
  std::array<double, kPhaseCount> seconds_{};
};

}  // namespace delmesher::base
