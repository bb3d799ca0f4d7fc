#include "mesher/tetmesh/conforming_mesh.h"

#include <algorithm>
#include <cstddef>

#include "mesher/base/disjoint_sets.h"
#include "mesher/base/face_key.h"
#include "mesher/delaunay/tetrahedrization.h"

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
  struct Face {
    std::array<VertexId, 3> key;
    std::array<std::uint32_t, 3> corner;  // 4 * tetrahedron + index, by the vertices of the key
  };
  std::vector<Face> faces;
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (mesh.region[t] == kOutside) continue;
    const Tet& v = mesh.tetrahedra[t];
    for (const auto& f : kFace) {
      Face face{undirected_face(v[f[0]], v[f[1]], v[f[2]]), {}};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<std::uint32_t>(std::ranges::find(v, face.key[k]) - v.begin());
        face.corner[k] = 4 * t + i;
      }
      faces.push_back(face);
    }
  }
  std::ranges::sort(faces, {}, &Face::key);
  DisjointSets corners(4 * mesh.tetrahedra.size());
  for (std::size_t n = 1; n < faces.size(); ++n) {
    if (faces[n].key != faces[n - 1].key) continue;
    for (std::size_t k = 0; k < 3; ++k) corners.join(faces[n - 1].corner[k], faces[n].corner[k]);
  }
  std::vector<VertexId> parts;  // the vertex of each
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (mesh.region[t] != kOutside && corners.smallest(4 * t + i) == 4 * t + i) {
        parts.push_back(mesh.tetrahedra[t][i]);
      }
    }
  }
  std::ranges::sort(parts);
  return std::ranges::adjacent_find(parts) != parts.end();
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
