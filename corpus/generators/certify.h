// Is a surface valid input? Decided exactly, by CGAL and without a line of the mesher's code.
#pragma once

#include <optional>
#include <vector>

#include "mesher/delmesher.h"

namespace tetproof {

// The first defect, in the order of Defect::Kind, so that a surface reported for a
// self-intersection has no other defect. Nothing if the surface is closed, manifold, oriented,
// without degenerate triangles, and no two closed triangles meet outside a shared vertex or edge.
// Orientation is consistent within components; parity decides which side is inside.
std::optional<delmesher::Defect::Kind> first_defect(const delmesher::Surface& surface);

inline bool certified_valid(const delmesher::Surface& surface) {
  return !first_defect(surface);
}

// Exact convex hull of points not all in one plane, coplanar faces triangulated; outwards.
delmesher::Surface convex_hull(const std::vector<std::array<double, 3>>& points);

}  // namespace tetproof
