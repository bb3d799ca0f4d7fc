// A mesh as local operations see it: in numbers of its own vertices, near ones near in memory; and
// back.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mesher/predicates/points.h"
#include "mesher/tetmesh/conforming_mesh.h"
#include "mesher/tetmesh/mesh_topology.h"

namespace delmesher::tetmesh {

// The vertices of a mesh along a Hilbert curve.
std::vector<VertexId> vertices_in_order(const ConformingMesh& mesh, const PointStore& points);

// The mesh in numbers of its own vertices; `point`: of each, in the store of `points` points.
// Tetrahedra and their vertices are in the order of those numbers, so that it does not matter in
// which order they were given.
MeshTopology topology_of(ConformingMesh mesh, std::span<const VertexId> point, std::size_t points);

// With points of the store again. A face of the surface is seen from the side that tells of it.
ConformingMesh mesh_of(const MeshTopology& topology, std::span<const VertexId> point);

}  // namespace delmesher::tetmesh
