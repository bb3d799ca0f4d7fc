// The values that the options of a run may have.
#pragma once

#include <cmath>

namespace delmesher {

// The values of an option that are accepted; others are StatusCode::invalid_options. The command
// line refuses the same values, and also 0 where 0 means none: there the option is left out.
struct Bounds {
  double low, high;
  bool above_low = false;  // low itself is not accepted

  constexpr bool allow(double x) const {  // not a NaN
    return (above_low ? x > low : x >= low) && x <= high;
  }
};
inline constexpr double kNoBound = HUGE_VAL;
struct OptionBounds {
  Bounds delta, tau, acute, corner;
  Bounds planar{.low = 0, .high = 0.01};      // or kPlanarAuto
  Bounds length{.low = 0, .high = kNoBound};  // chamfer_radius and max_edge
  Bounds growth{.low = 0, .high = 1, .above_low = true};
  Bounds seconds{.low = 0, .high = kNoBound};
  Bounds budget{.low = 0, .high = 1e15};
  Bounds max_vertices{.low = 0, .high = 4294967294};  // the largest index
  Bounds threads{.low = 0, .high = 1024};
};
inline constexpr OptionBounds kBounds{.delta = {.low = 0, .high = 30, .above_low = true},
                                      .tau = {.low = 0, .high = 1},
                                      .acute = {.low = 0, .high = 90},
                                      .corner = {.low = 0, .high = 90}};

}  // namespace delmesher
