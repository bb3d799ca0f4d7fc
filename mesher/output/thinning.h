// Taking Steiner points out again where the doubles that will be written are too coarse for them.
#pragma once

#include <cstddef>
#include <span>

#include "mesher/base/control.h"
#include "mesher/geometry/local_frame.h"
#include "mesher/predicates/predicates.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::output {

// Collapses vertices of a conforming mesh along its edges: `around` and the vertices up to `rings`
// edges away, except the first `fixed_vertices` of the store, explicit points of the surface, and
// the hull where that is not the surface. The tetrahedra stay positive on exact coordinates, the
// faces on the surface tile the same facets, and no more tetrahedra than before are inverted or
// flat as written. They are not constrained Delaunay any more. Returns how many vertices have gone.
std::size_t thin_out(std::span<const VertexId> around, int rings, std::size_t fixed_vertices,
                     const LocalFrame& frame, const PointStore& points, Predicates& predicates,
                     Control& control, ConformingMesh& mesh);

}  // namespace delmesher::output
