// Do a tetrahedron and a triangle meet in more than they have in common? Decided exactly, from
// orient3d alone. Whether the triangle enters the tetrahedron: surface/tetrahedron_contact.h.
#pragma once

#include <array>

#include "mesher/predicates/predicates.h"

namespace delmesher::cdt {

// False only if the two meet in nothing but the simplex spanned by their common vertices. May be
// true without need where four vertices are coplanar.
bool may_meet_improperly(Predicates& predicates, const std::array<VertexId, 4>& tetrahedron,
                         const std::array<VertexId, 3>& triangle);

// Are the bounding boxes of the two sets of points disjoint, whatever the rounding?
bool boxes_disjoint(const PointStore& points, const std::array<VertexId, 4>& tetrahedron,
                    const std::array<VertexId, 3>& triangle);

}  // namespace delmesher::cdt
