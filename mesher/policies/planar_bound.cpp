#include "mesher/policies/planar_bound.h"

#include "mesher/surface/flatness.h"

namespace delmesher::policies {

double planar_bound(const Surface& surface, const Options& options, double diagonal,
                    Control& control) {
  if (options.planar != kPlanarAuto) return options.planar / 2 * diagonal;
  // Twice: planes may be moved by as much again for vertices that lie on more than three.
  return 2 * surface::flatness(surface, control);
}

}  // namespace delmesher::policies
