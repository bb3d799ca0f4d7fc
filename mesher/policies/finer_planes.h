// Policy: other runs, with less planar facets, where the vertices as given invert tetrahedra.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "mesher/delmesher.h"

namespace delmesher::policies {

// Facets were made planar by moving vertices. The mesh is written with the vertices as given, which
// may invert tetrahedra that are thinner than the vertices moved. If inverted or flat ones are
// left, or repairs gave up the exact coordinates, the surface is meshed again: as with --planar 0,
// so that the mesh goes back to the surface as given (as_given.h), if the options allow that; then
// with a 32nd of the bound, which takes many times the tetrahedra where facets are noisier than
// that; and then without planar facets. The best result counts. With --planar 0 the last of these
// is the only one; it is run as well if the first run had to give up, because no way led back to
// the surface as given. The time limit holds for all runs together, the other limits for each.
class FinerPlanes {
 public:
  // The first run begins now, with these options.
  explicit FinerPlanes(const Options& options);

  // Plans another run, with options(), where `best`, the best result so far, asks for one. Returns
  // whether it does.
  bool plan_run_after(const Result& best);
  const Options& options() const { return options_; }
  // Is the run that was planned one without a stand-in?
  bool directly() const { return attempt_ == Attempt::directly; }
  // `best` becomes the result of that run if it is better, if that run was interrupted, or if the
  // run of `best` had to give up. If it does not, its statistics name the limit that ended that
  // run.
  static void keep_better(Result result, Result& best);

 private:
  using Clock = std::chrono::steady_clock;
  enum class Attempt : std::uint8_t { as_given, finer, directly };

  const Clock::time_point start_ = Clock::now();
  Options options_;
  const double time_limit_;
  std::vector<Attempt> left_;
  Attempt attempt_ = Attempt::directly;  // what was planned last
  double first_share_ = -1;              // Options::planar of the first run; it is twice the bound
};

}  // namespace delmesher::policies
