#include "mesher/policies/finer_planes.h"

#include <chrono>

namespace delmesher::policies {
namespace {

std::uint64_t defects(const Result& result) {
  return result.statistics.rounding_inverted + result.statistics.rounding_flat;
}

}  // namespace

Result with_finer_planes(const Surface& surface, const Options& options,
                         const std::function<Result(const Surface&, const Options&)>& task) {
  using Clock = std::chrono::steady_clock;
  constexpr double kFiner = 0x1p-5;
  const Clock::time_point start = Clock::now();
  Result best = task(surface, options);
  Options again = options;
  for (const double factor : {kFiner, 0.0}) {
    const Statistics& s = best.statistics;
    if (!best.status.ok() || s.planar_groups == 0 || defects(best) == 0) break;
    if (options.time_limit_seconds > 0) {
      const std::chrono::duration<double> spent = Clock::now() - start;
      again.time_limit_seconds = options.time_limit_seconds - spent.count();
      if (again.time_limit_seconds <= 0) break;
    }
    again.planar = factor * 2 * s.planar_bound / s.bbox_diagonal;
    Result finer = task(surface, again);
    if (finer.status.code == StatusCode::interrupted) return finer;
    if (finer.status.ok() && defects(finer) < defects(best)) best = std::move(finer);
  }
  return best;
}

}  // namespace delmesher::policies
