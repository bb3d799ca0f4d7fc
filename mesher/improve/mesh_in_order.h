// A mesh as the operations see it: in numbers of its own vertices, near ones near in memory; and
// back.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mesher/improve/improve.h"
#include "mesher/improve/state.h"

namespace delmesher::improve {

Goals goals_of(const ImproveOptions& options);

// The vertices of a mesh along a Hilbert curve, so that near ones are near in memory.
std::vector<VertexId> vertices_in_order(const ImproveMesh& mesh, const PointStore& points);

// The mesh in numbers of its own vertices, `point` in the store of `points` points. Tetrahedra and
// their vertices are in the order of those numbers, so that it does not matter in which order they
// were given.
WorkMesh work_mesh(ImproveMesh mesh, std::span<const VertexId> point, std::size_t points);

// With points of the store.
ImproveMesh result_of(const State& state);

}  // namespace delmesher::improve
