#include "mesher/tetmesh/conforming_mesh.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "mesher/tetmesh/boundary_sides.h"
#include "mesher/tetmesh/mesh_topology.h"

namespace delmesher::tetmesh {

void keep_inside(ConformingMesh& mesh) {
  if (std::ranges::find(mesh.region, kOutside) == mesh.region.end()) return;
  std::size_t kept = 0;
  for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
    if (mesh.region[n] == kOutside) continue;
    mesh.tetrahedra[kept] = mesh.tetrahedra[n];
    mesh.region[kept++] = mesh.region[n];
  }
  mesh.tetrahedra.resize(kept);
  mesh.region.resize(kept);
  mesh.repeated_faces.clear();
}

bool touches_itself(const ConformingMesh& mesh) {
  ConformingMesh inside{mesh.tetrahedra, mesh.region, {}, {}};
  keep_inside(inside);
  VertexId vertices = 0;
  for (const Tet& t : inside.tetrahedra) vertices = std::max(vertices, std::ranges::max(t) + 1);
  return !MeshTopology(std::move(inside.tetrahedra), inside.region, {}, vertices).pinched().empty();
}

std::vector<std::array<RegionId, 2>> regions_beside(const ConformingMesh& mesh) {
  std::vector<std::array<RegionId, 2>> beside(mesh.boundary.size(), {kOutside, kOutside});
  for_each_side(mesh, [&](std::size_t n, std::size_t t, int) {
    // A tetrahedron outside changes nothing; of two inside each takes a place.
    auto& [low, high] = beside[n];
    low = std::exchange(high, std::max(high, mesh.region[t]));
    low = std::min(low, mesh.region[t]);
  });
  return beside;
}

std::size_t drop_bare_faces(ConformingMesh& mesh) {
  const std::vector<std::array<RegionId, 2>> beside = regions_beside(mesh);
  std::size_t n = 0;
  return std::erase_if(mesh.boundary,
                       [&](const SurfaceFace&) { return beside[n++][1] == kOutside; });
}

ConformingMesh part_within(Region region, const ConformingMesh& mesh) {
  const auto is_written = [&](RegionId id) { return region == Region::hull || id != kOutside; };
  const auto count = static_cast<std::size_t>(std::ranges::count_if(mesh.region, is_written));
  ConformingMesh part;
  part.boundary = mesh.boundary;
  part.tetrahedra.reserve(count);
  part.region.reserve(count);
  part.repeated_faces.reserve(mesh.repeated_faces.empty() ? 0 : count);
  for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
    if (!is_written(mesh.region[n])) continue;
    part.tetrahedra.push_back(mesh.tetrahedra[n]);
    part.region.push_back(mesh.region[n]);
    if (mesh.repeated_faces.empty()) continue;
    part.repeated_faces.push_back(repeated_within(region, mesh.repeated_faces[n]));
  }
  return part;
}

}  // namespace delmesher::tetmesh
