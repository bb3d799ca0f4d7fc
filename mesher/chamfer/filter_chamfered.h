// The filter's second step (section 7): too small features that chamfering made.
#pragma once

#include <vector>

#include "mesher/chamfer/chamfer.h"
#include "mesher/chamfer/facet_set.h"
#include "mesher/chamfer/kept_surface.h"

namespace delmesher::chamfer {

// What is too small, in the scaled coordinates of the surface.
struct TooSmall {
  double tolerance = 0;  // any feature below this
  // Segments closer than this, if the gap between them fits so many times along each of them.
  double gap_tolerance = 0;
  double long_gap = 0;
};

// Drops facets from the set that are responsible for too small features: short segments, and
// points, segments and facets without a common point that are too close. The smallest come first.
// A facet goes if no facet that went before it changes what was found about it; the first one
// always goes. With `both_sides` all that were found go. Looks only at vertices v with
// changed[v] != 0, at the points made for them, and at the segments there. Gives the facets
// dropped.
std::vector<FacetId> drop_for_chamfered_features(
    const KeptSurface& surface, const PointStore& points, const ChamferResult& chamfered,
    const TooSmall& too_small, const std::vector<std::uint8_t>& changed, bool both_sides,
    FacetSet& facets, Control& control);

}  // namespace delmesher::chamfer
