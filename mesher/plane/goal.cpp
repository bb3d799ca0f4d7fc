#include "mesher/plane/goal.h"

#include "mesher/predicates/predicates.h"

namespace delmesher::plane {

Goal::Goal(double degrees, double max_edge) : max_edge_(max_edge > 0 ? max_edge : HUGE_VAL) {
  // The computed squared sine is off by less than 1e-14 of itself; doubles as written may be off
  // more.
  sine_squared_ = (1 - cosine_squared(degrees)) * (1 + 1e-9);
  const double cosine = std::sqrt(cosine_squared(degrees));
  // Half the cotangent of half the angle, less five percent so that rounding makes no new one.
  off_centre_ = 0.475 * std::sqrt((1 + cosine) / (1 - cosine));
}

}  // namespace delmesher::plane
