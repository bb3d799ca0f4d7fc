// Margins that rounding does not swallow.
#pragma once

#include <cmath>

#include "mesher/base/namespaces.h"

namespace delmesher::base {

// `x`, or the first double beyond it that is at least |by| from `from`, in the direction of `by`.
// Where doubles are wider apart than a margin, a sum that x comes from may be `from` itself.
inline double moved_away(double x, double from, double by) {
  while (std::fabs(x - from) < std::fabs(by)) x = std::nextafter(x, std::copysign(HUGE_VAL, by));
  return x;
}

}  // namespace delmesher::base
