#include "mesher/policies/finer_planes.h"

#include <algorithm>
#include <utility>

#include "mesher/policies/as_given.h"

namespace delmesher::policies {
namespace {

// The bound of the run after the first ones, as a fraction of the first one's.
constexpr double kFiner = 0x1p-5;
constexpr std::pair<std::uint64_t, std::uint64_t> kNoDefects;

// Of the mesh as written, and of its exact coordinates alone. Compared in this order.
std::pair<std::uint64_t, std::uint64_t> defects(const Result& result) {
  const Statistics& s = result.statistics;
  return {s.rounding_inverted + s.rounding_flat, s.rounding_inexact};
}

}  // namespace

FinerPlanes::FinerPlanes(const Options& options)
    : options_(options), time_limit_(options.time_limit_seconds) {
  if (options.planar != 0) {
    Options as_given = options;
    as_given.planar = 0;
    if (goes_back(as_given)) left_.push_back(Attempt::as_given);
    left_.push_back(Attempt::finer);
  }
  left_.push_back(Attempt::directly);
}

bool FinerPlanes::plan_run_after(const Result& best) {
  const Statistics& s = best.statistics;
  if (!best.status.ok() || s.planar_groups == 0) return false;
  if (!s.planar_given_up && defects(best) == kNoDefects) return false;
  if (left_.empty()) return false;
  if (first_share_ < 0) first_share_ = 2 * s.planar_bound / s.bbox_diagonal;
  if (time_limit_ > 0) {
    const std::chrono::duration<double> spent = Clock::now() - start_;
    options_.time_limit_seconds = time_limit_ - spent.count();
    // Without a mesh, there is a run that tells so.
    if (s.planar_given_up)
      options_.time_limit_seconds = std::max(options_.time_limit_seconds, 1e-9);
    if (options_.time_limit_seconds <= 0) return false;
  }
  attempt_ = left_.front();
  left_.erase(left_.begin());
  options_.planar = attempt_ == Attempt::finer ? kFiner * first_share_ : 0;
  return true;
}

void FinerPlanes::keep_better(Result result, Result& best) {
  const bool interrupted = result.status.code == StatusCode::interrupted;
  const bool gave_up = result.statistics.planar_given_up;
  const bool better = result.status.ok() && !gave_up && defects(result) < defects(best);
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
