// Exact tests of closed triangles, whose corners are points of any kind.
#pragma once

#include <array>
#include <cstdint>

#include "mesher/predicates/predicates.h"

namespace delmesher::surface {

using Corners = std::array<VertexId, 3>;

// Coordinate axis along which a triangle projects without degenerating, and the sign of its normal
// along it; sign 0 if the corners are collinear. Prefers a large component of the normal.
struct Projection {
  int axis = 0;
  int sign = 0;
};
Projection find_projection(Predicates& predicates, const Corners& triangle);

// Do two closed triangles, neither degenerate, meet outside the vertices or the edge that they
// share (by index; two at most)? Touching counts, and so do vertices of equal coordinates but
// different indices.
bool meet_outside_shared(Predicates& predicates, const Corners& s, const Corners& t,
                         const Projection& projection_s, const Projection& projection_t);

// Does the axis-parallel ray from p, in the given direction (+1 or -1) along the axis, cross the
// closed triangle? Degenerate positions are decided as if p were moved by infinitesimals along the
// other two axes, the same for all triangles, so that the parity of the crossings with a closed
// surface is right. p must not lie on the triangle.
bool ray_crosses(Predicates& predicates, VertexId p, int axis, int direction,
                 const Corners& triangle);

}  // namespace delmesher::surface
