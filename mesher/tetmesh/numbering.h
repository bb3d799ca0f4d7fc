// A mesh as local operations see it: in numbers of its own vertices, near ones near in memory; and
// back.
#pragma once

#include <span>
#include <vector>

#include "mesher/predicates/points.h"
#include "mesher/tetmesh/conforming_mesh.h"
#include "mesher/tetmesh/mesh_topology.h"

namespace delmesher::tetmesh {

// A mesh in numbers of its own vertices, which are along a Hilbert curve. Tetrahedra and their
// vertices are in the order of those numbers, so that it does not matter in which order they were
// given.
struct NumberedMesh {
  std::vector<VertexId> point;  // of each vertex, in the store
  MeshTopology topology;
};
NumberedMesh numbered(ConformingMesh mesh, const PointStore& points);
// As it was given, in the numbers of the points; of how many there are.
NumberedMesh numbered_by_points(ConformingMesh mesh, std::size_t points);

// With points of the store again. A face of the surface is seen from the side that tells of it.
ConformingMesh mesh_of(const MeshTopology& topology, std::span<const VertexId> point);

}  // namespace delmesher::tetmesh
