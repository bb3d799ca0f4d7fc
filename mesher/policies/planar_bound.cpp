#include "mesher/policies/planar_bound.h"

#include <algorithm>

#include "mesher/surface/flatness.h"

namespace delmesher::policies {

double planar_bound(const Surface& surface, const Options& options, double diagonal) {
  constexpr double kMostAuto = 0x1p-18;  // of the diagonal
  if (options.planar != kPlanarAuto) return options.planar / 2 * diagonal;
  // Twice: planes may be moved by as much again for vertices that lie on more than three.
  return std::min(2 * surface::flatness(surface), kMostAuto / 2 * diagonal);
}

}  // namespace delmesher::policies
