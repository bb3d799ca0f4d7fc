// Policy: where the vertices as given do not go with planar facets.
#pragma once

#include <chrono>
#include <cstddef>

#include "mesher/delmesher.h"

namespace delmesher::policies {

// Facets were made planar by moving vertices; the mesh is written with the vertices as given, which
// may turn over tetrahedra that are no thicker than the vertices moved. If some are left, the
// surface is meshed again with a bound a 32nd as large, and then without planar facets; the best
// result counts. With --planar 0 there is one more run, without a stand-in, also if the first was
// given up because no way led back to the surface as given (as_given.h). The limits hold for all
// runs together.
class FinerPlanes {
 public:
  // The first run begins now, with these options.
  explicit FinerPlanes(const Options& options)
      : options_(options), time_limit_(options.time_limit_seconds), exact_(options.planar == 0) {}

  // Is another run wanted, with options()? `best` is the best result so far.
  bool wants_run_after(const Result& best);
  const Options& options() const { return options_; }
  // Is that run one without a stand-in?
  bool directly() const { return options_.planar == 0; }
  // Takes the result of that run for the best one if it is, or if the run was interrupted.
  static void compare(Result result, Result& best);

 private:
  using Clock = std::chrono::steady_clock;

  const Clock::time_point start_ = Clock::now();
  Options options_;
  const double time_limit_;
  const bool exact_;
  std::size_t attempts_ = 0;
};

}  // namespace delmesher::policies
