// The tetrahedra on both sides of the boundary of a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "mesher/base/face_key.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::tetmesh {

// Calls visit(n, t, i) for each face n of the boundary that is face i of tetrahedron t.
template <class Visit>
void for_each_side(const ConformingMesh& mesh, Visit&& visit) {
  struct Face {
    std::array<VertexId, 3> key;
    std::size_t place;
  };
  std::vector<Face> faces;
  for (std::size_t n = 0; n < mesh.boundary.size(); ++n) {
    const auto& [a, b, c] = mesh.boundary[n].vertices;
    faces.push_back({undirected_face(a, b, c), n});
  }
  std::ranges::sort(faces, {}, &Face::key);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const Tet& v = mesh.tetrahedra[t];
    for (int i = 0; i < 4; ++i) {
      const auto& f = kFace[i];
      const auto key = undirected_face(v[f[0]], v[f[1]], v[f[2]]);
      const auto face = std::ranges::lower_bound(faces, key, {}, &Face::key);
      if (face != faces.end() && face->key == key) visit(face->place, t, i);
    }
  }
}

}  // namespace delmesher::tetmesh
