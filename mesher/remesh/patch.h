// Changes of a complex of triangles that keep its topology: what they would remove and add.
#pragma once

#include <optional>

#include "mesher/remesh/triangle_mesh.h"

namespace delmesher::remesh {

// The edge ab becomes the vertex p, which is b or new; lines that then have the same ends become
// one. Empty if that would change the topology (link condition, Dey et al. 1999) or make a triangle
// twice.
std::optional<Patch> collapse_patch(const TriangleMesh& mesh, VertexId a, VertexId b, VertexId p);
// p, a new vertex, in the place of v.
Patch move_patch(const TriangleMesh& mesh, VertexId v, VertexId p);
// The edge ab, of two triangles and no line, becomes the other diagonal. Empty if that is an edge
// already, or the triangles have different labels.
std::optional<Patch> flip_patch(const TriangleMesh& mesh, VertexId a, VertexId b);
// The line ab, of two triangles, becomes the lines av and vb: v is the third vertex of one of the
// triangles, which goes, and the other one gets its edges in the place of ab. Empty if an edge
// would be there already.
std::optional<Patch> bypass_patch(const TriangleMesh& mesh, VertexId a, VertexId b, VertexId v);
// A new vertex p on the edge ab.
Patch split_patch(const TriangleMesh& mesh, VertexId a, VertexId b, VertexId p);

}  // namespace delmesher::remesh
