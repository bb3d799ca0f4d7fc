// Policy: where the vertices as given do not go with planar facets.
#pragma once

#include <chrono>
#include <cstddef>

#include "mesher/delmesher.h"

namespace delmesher::policies {

// Facets were made planar by moving vertices; the mesh is written with the vertices as given, which
// may turn over tetrahedra that are no thicker than the vertices moved. If some are left, the
// surface is meshed again with a bound a 32nd as large, and then without planar facets; the best
// result counts. The limits hold for all runs together.
class FinerPlanes {
 public:
  // The first run begins now, with these options.
  explicit FinerPlanes(const Options& options)
      : options_(options), time_limit_(options.time_limit_seconds) {}

  // Is another run wanted, with options()? `best` is the best result so far.
  bool wants_run_after(const Result& best);
  const Options& options() const { return options_; }
  // Takes the result of that run for the best one if it is, or if the run was interrupted.
  static void compare(Result result, Result& best);

 private:
  using Clock = std::chrono::steady_clock;

  const Clock::time_point start_ = Clock::now();
  Options options_;
  const double time_limit_;
  std::size_t attempts_ = 0;
};

}  // namespace delmesher::policies
