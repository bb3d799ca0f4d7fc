// The filter's second step (section 7): too small features that chamfering made.
#pragma once

#include <vector>

#include "mesher/chamfer/chamfer.h"
#include "mesher/chamfer/facet_set.h"
#include "mesher/chamfer/kept_surface.h"

namespace delmesher::chamfer {

// Drops from the set facets responsible for segments shorter than the tolerance (in the scaled
// coordinates of the surface) and for points, segments and facets without a common point that are
// closer, smallest first. Several facets go at a time if none of them changes what was found about
// another, and at least one if there is any; with `both_sides` all that were found. Looks only at
// points and segments made for a vertex with changed[v] != 0. Gives the facets dropped.
std::vector<FacetId> drop_for_chamfered_features(const KeptSurface& surface,
                                                 const PointStore& points,
                                                 const ChamferResult& chamfered, double tolerance,
                                                 const std::vector<std::uint8_t>& changed,
                                                 bool both_sides, FacetSet& facets,
                                                 Control& control);

}  // namespace delmesher::chamfer
