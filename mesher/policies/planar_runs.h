// Policy: other runs where the vertices as given invert tetrahedra of planar facets.
#pragma once

#include <chrono>

#include "mesher/delmesher.h"

namespace delmesher::policies {

// Facets were made planar by moving vertices. The mesh is written with the vertices as given, which
// may invert tetrahedra that are thinner than the vertices moved. If inverted or flat ones are
// left, facets have swallowed lines, or repairs gave up the exact coordinates, the surface is
// meshed again: as with --planar 0, so that the mesh goes back to the surface as given, if the
// options allow that; and then without planar facets. The best result counts. With --planar 0 the
// last of these is the only one; it is run as well if the first run failed because no way led back
// to the surface as given (Statistics::planar_given_up). The time limit holds for all runs
// together, the other limits for each.
class PlanarRuns {
 public:
  // The first run begins now, with these options.
  explicit PlanarRuns(const Options& options) : first_(options) {}

  // Is the best result so far one that no other run can better?
  static bool good_enough(const Result& best);
  // May such a run, one of the rungs that repeat the run, make it better?
  bool applies(Rung rung) const;
  // The options of all runs after the first one, unless it was too heavy.
  Options options() const;
  // With SurfaceChoice::automatic: would the best result so far, the first, be too heavy, or finer
  // than doubles?
  bool is_too_heavy(const Result& best) const;
  // The options of the run after that.
  Options kept_options() const { return in_time_left(first_); }
  // Has the first more inverted or flat tetrahedra, lost lines, or coordinates given up?
  static bool is_worse(const Result& result, const Result& than);
  // `best` becomes the result of such a run if it is better, if that run was interrupted, or if no
  // way led back from `best`. If it does not, its statistics name the limit that ended that run.
  static void keep_better(Result result, Result& best);

 private:
  using Clock = std::chrono::steady_clock;

  double seconds_left() const;
  Options in_time_left(Options options) const;

  const Clock::time_point start_ = Clock::now();
  const Options& first_;
};

}  // namespace delmesher::policies
