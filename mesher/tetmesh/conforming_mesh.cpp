#include "mesher/tetmesh/conforming_mesh.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "mesher/base/face_key.h"
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

std::size_t drop_bare_faces(ConformingMesh& mesh) {
  const auto key = [](VertexId a, VertexId b, VertexId c) { return undirected_face(a, b, c); };
  std::vector<std::array<VertexId, 3>> bare;
  for (const auto& [v, facet] : mesh.boundary) bare.push_back(key(v[0], v[1], v[2]));
  std::ranges::sort(bare);
  std::vector<std::uint8_t> taken(bare.size(), 0);
  for (const Tet& t : mesh.tetrahedra) {
    for (const auto& f : kFace) {
      const auto face = std::ranges::lower_bound(bare, key(t[f[0]], t[f[1]], t[f[2]]));
      if (face != bare.end() && *face == key(t[f[0]], t[f[1]], t[f[2]])) {
        taken[static_cast<std::size_t>(face - bare.begin())] = 1;
      }
    }
  }
  return std::erase_if(mesh.boundary, [&](const SurfaceFace& face) {
    const auto& v = face.vertices;
    return taken[static_cast<std::size_t>(std::ranges::lower_bound(bare, key(v[0], v[1], v[2])) -
                                          bare.begin())] == 0;
  });
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
