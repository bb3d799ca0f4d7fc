// Exact test between an open tetrahedron and a closed triangle.
#pragma once

#include <array>
#include <cstdint>

#include "mesher/predicates/predicates.h"
#include "mesher/surface/triangle_contact.h"

namespace delmesher::surface {

// Does the closed triangle meet the interior of the tetrahedron (orient3d > 0)? Points of any kind;
// the triangle must not be degenerate. Uses orient3d only.
//
// They are disjoint iff some plane has the tetrahedron on one closed side and the triangle on the
// other. The separating planes (n, c), with n.k >= c for the corners k of the tetrahedron and
// n.t <= c for those of the triangle, form a polyhedral cone in four dimensions. It has no
// lineality, because no plane contains all corners; so if it is not {0} it has an extreme ray, on
// which three linearly independent constraints are tight: a separating plane through three affinely
// independent corners (n = 0 would force c = 0). So it is enough to try the planes through three of
// the seven corners, and every question asked is the sign of orient3d of four of them: at most 35.
bool meets_interior(Predicates& predicates, const std::array<VertexId, 4>& tetrahedron,
                    const Corners& triangle);

}  // namespace delmesher::surface
