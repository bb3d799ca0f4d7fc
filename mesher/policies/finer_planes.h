// Policy: other runs, with less planar facets, where the vertices as given invert tetrahedra.
#pragma once

#include <chrono>
#include <cstddef>

#include "mesher/delmesher.h"

namespace delmesher::policies {

// Facets were made planar by moving vertices. The mesh is written with the vertices as given, which
// may invert tetrahedra that are thinner than the vertices moved. If inverted or flat ones are
// left, or repairs gave up the exact coordinates, the surface is meshed again with a 32nd of the
// bound, and then without planar facets; the best result counts. With --planar 0 there is one such
// run, without a stand-in; also if the first one had to give up, because no way led back to the
// surface as given (as_given.h). The time limit holds for all runs together, the other limits for
// each.
class FinerPlanes {
 public:
  // The first run begins now, with these options.
  explicit FinerPlanes(const Options& options)
      : options_(options), time_limit_(options.time_limit_seconds), exact_(options.planar == 0) {}

  // Plans another run, with options(), where `best`, the best result so far, asks for one. Returns
  // whether it does.
  bool plan_run_after(const Result& best);
  const Options& options() const { return options_; }
  // Is the run that was planned one without a stand-in?
  bool directly() const { return options_.planar == 0; }
  // `best` becomes the result of that run if it is better, if that run was interrupted, or if the
  // run of `best` had to give up. If it does not, its statistics name the limit that ended that
  // run.
  static void keep_better(Result result, Result& best);

 private:
  using Clock = std::chrono::steady_clock;

  const Clock::time_point start_ = Clock::now();
  Options options_;
  const double time_limit_;
  const bool exact_;
  std::size_t attempts_ = 0;
};

}  // namespace delmesher::policies
