#include "mesher/tetmesh/placed_mesh.h"

#include <algorithm>

namespace delmesher::tetmesh {

void PlacedMesh::contract(VertexId v, VertexId w, std::span<const TetId> star) {
  ++clock_;
  mesh.contract(v, w, star);
  for (const TetId t : star) {
    if (mesh.alive(t)) changed(t);
  }
}

bool PlacedMesh::accept(const Change& change) {
  const auto is_valid = [&](const CreatedTet& tet) { return is_positive(tet.vertices); };
  if (!std::ranges::all_of(change.created, is_valid)) return false;
  replace(change.removed, change.created, change.faces);
  return true;
}

void PlacedMesh::replace(std::span<const TetId> removed, std::span<const CreatedTet> created,
                         std::span<const SurfaceFace> faces) {
  ++clock_;
  mesh.replace(removed, created, faces);
  for (const TetId t : mesh.created()) changed(t);
}

}  // namespace delmesher::tetmesh
