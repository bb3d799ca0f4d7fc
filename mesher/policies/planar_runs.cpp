#include "mesher/policies/planar_runs.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "mesher/planar/planar.h"

namespace delmesher::policies {
namespace {

using Defects = std::array<std::uint64_t, 3>;

// Of the mesh as written, of its surface, and of its exact coordinates alone. Compared in this
// order.
Defects defects(const Result& result) {
  const Statistics& s = result.statistics;
  return {s.rounding_inverted + s.rounding_flat, s.lines_lost, s.rounding_inexact};
}

}  // namespace

bool PlanarRuns::good_enough(const Result& best) {
  const Statistics& s = best.statistics;
  if (!best.status.ok()) return !s.planar_given_up;
  return s.planar_groups == 0 || defects(best) == Defects{};
}

bool PlanarRuns::is_worse(const Result& result, const Result& than) {
  return defects(than) < defects(result);
}

bool PlanarRuns::applies(Rung rung) const {
  if (first_.time_limit_seconds > 0 && seconds_left() <= 0) return false;
  return rung == Rung::no_planes || (first_.planar != 0 && goes_back(options()));
}

Options PlanarRuns::options() const {
  Options options = in_time_left(first_);
  options.planar = 0;
  return options;
}

bool PlanarRuns::is_too_heavy(const Result& best) const {
  const Limit limit = best.status.limit;
  return first_.surface == SurfaceChoice::automatic &&
         (limit == Limit::budget || limit == Limit::size || limit == Limit::precision);
}

Options PlanarRuns::in_time_left(Options options) const {
  if (first_.time_limit_seconds > 0) options.time_limit_seconds = std::max(seconds_left(), 1e-9);
  return options;
}

double PlanarRuns::seconds_left() const {
  const std::chrono::duration<double> spent = Clock::now() - start_;
  return first_.time_limit_seconds - spent.count();
}

void PlanarRuns::keep_better(Result result, Result& best) {
  RungCounts taken = best.statistics.ladder;
  taken += result.statistics.ladder;
  const Statistics& s = best.statistics;
  if (s.planar_given_up) {  // however the other ended
    result.statistics.diagonals = s.diagonals;
    result.statistics.diagonals_missing = s.diagonals_missing;
    result.statistics.planar_given_up = true;
  }
  const bool interrupted = result.status.code == StatusCode::interrupted;
  const bool better = result.status.ok() && is_worse(best, result);
  if (interrupted || better || s.planar_given_up) {
    best = std::move(result);
  } else if (!result.status.ok() && !result.statistics.planar_given_up) {
    best.statistics.planar_limit = result.status.limit;
  }
  best.statistics.ladder = taken;
}

}  // namespace delmesher::policies
