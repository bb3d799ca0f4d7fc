#include "mesher/policies/finer_planes.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace delmesher::policies {
namespace {

// Of the bound in force, in the second and third run.
constexpr double kFactors[] = {0x1p-5, 0};
constexpr std::pair<std::uint64_t, std::uint64_t> kNoDefects;

// Of the mesh as written, and of its exact coordinates alone. Compared in this order.
std::pair<std::uint64_t, std::uint64_t> defects(const Result& result) {
  const Statistics& s = result.statistics;
  return {s.rounding_inverted + s.rounding_flat, s.rounding_inexact};
}

}  // namespace

bool FinerPlanes::plan_run_after(const Result& best) {
  const Statistics& s = best.statistics;
  if (!best.status.ok() || s.planar_groups == 0) return false;
  if (!s.planar_given_up && defects(best) == kNoDefects) return false;
  if (attempts_ == (exact_ ? 1 : std::size(kFactors))) return false;
  if (time_limit_ > 0) {
    const std::chrono::duration<double> spent = Clock::now() - start_;
    options_.time_limit_seconds = time_limit_ - spent.count();
    // Without a mesh, there is a run that tells so.
    if (s.planar_given_up)
      options_.time_limit_seconds = std::max(options_.time_limit_seconds, 1e-9);
    if (options_.time_limit_seconds <= 0) return false;
  }
  // Options::planar is twice the bound (planar_bound.h).
  if (!exact_) options_.planar = kFactors[attempts_] * 2 * s.planar_bound / s.bbox_diagonal;
  ++attempts_;
  return true;
}

void FinerPlanes::keep_better(Result result, Result& best) {
  const bool interrupted = result.status.code == StatusCode::interrupted;
  const bool better = result.status.ok() && defects(result) < defects(best);
  const Statistics& s = best.statistics;
  if (s.planar_given_up) {  // however the other ended
    result.statistics.diagonals = s.diagonals;
    result.statistics.diagonals_missing = s.diagonals_missing;
    result.statistics.planar_given_up = true;
  }
  if (interrupted || better || s.planar_given_up) {
    best = std::move(result);
  } else if (!result.status.ok()) {
    best.statistics.planar_limit = result.status.limit;
  }
}

}  // namespace delmesher::policies
