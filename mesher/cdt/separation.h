// How a tetrahedron and a triangle meet, decided exactly from orient3d alone.
#pragma once

#include <array>

#include "mesher/predicates/predicates.h"

namespace delmesher::cdt {

// Do the open tetrahedron and the closed triangle have a point in common? They do not iff some
// plane through three of their vertices weakly separates them: weakly separating planes form a
// pointed cone, and each of its extreme rays is a plane that touches three vertices.
bool interior_meets(Predicates& predicates, const std::array<VertexId, 4>& tetrahedron,
                    const std::array<VertexId, 3>& triangle);

// False only if the two meet in nothing but the simplex spanned by their common vertices. May be
// true without need where four vertices are coplanar.
bool may_meet_improperly(Predicates& predicates, const std::array<VertexId, 4>& tetrahedron,
                         const std::array<VertexId, 3>& triangle);

// Are the bounding boxes of the two sets of points disjoint, whatever the rounding?
bool boxes_disjoint(const PointStore& points, const std::array<VertexId, 4>& tetrahedron,
                    const std::array<VertexId, 3>& triangle);

}  // namespace delmesher::cdt
