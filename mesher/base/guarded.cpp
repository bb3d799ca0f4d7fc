#include "mesher/base/guarded.h"

#include <cmath>

namespace delmesher {

std::string options_defect(const Options& o, int most_delta, int least_acute) {
  const auto bad = [](double x, double low, double high) { return !(x >= low && x <= high); };
  if (bad(o.delta, 0, most_delta) || o.delta == 0) {
    return "delta must be above 0 and at most " + std::to_string(most_delta) + " degrees";
  }
  if (bad(o.tau, 0, 1)) return "tau must be between 0 and 1";
  if (bad(o.acute, least_acute, 90)) {
    return "acute must be between " + std::to_string(least_acute) + " and 90 degrees";
  }
  if (bad(o.corner, 0, 90)) return "corner must be between 0 and 90 degrees";
  if (bad(o.chamfer_radius, 0, HUGE_VAL)) return "chamfer radius must not be negative";
  if (bad(o.max_edge, 0, HUGE_VAL)) return "max edge must not be negative";
  if (bad(o.time_limit_seconds, 0, HUGE_VAL)) return "time limit must not be negative";
  return {};
}

}  // namespace delmesher
