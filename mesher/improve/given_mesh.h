// Decides exactly whether a mesh from elsewhere is conforming, before it is improved.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "mesher/base/control.h"
#include "mesher/improve/improve.h"
#include "mesher/predicates/points.h"

namespace delmesher::improve {

struct GivenMesh {
  std::span<const Vec3> vertices;
  std::span<const Tet> tetrahedra;
  std::span<const RegionId> region;  // of each tetrahedron
  std::span<const std::array<VertexId, 3>> triangles;
};

struct CheckedMesh {
  // Why it is not a conforming mesh, with numbers counted from 0; empty if it is one. It is one if
  //  - all coordinates are finite, and each tetrahedron and triangle has different, existing
  //  vertices;
  //  - tetrahedra are of one orientation, by exact signs, but for flat ones;
  //  - a face has one tetrahedron, or two on both sides; each triangle is a face;
  //  - the tetrahedra at a vertex that is on no kept face are connected by faces.
  // Whether tetrahedra that share no face overlap is not asked.
  std::string defect;
  bool turned = false;  // all tetrahedra were negative, and are positive now
  std::uint64_t flat = 0;
  // Its vertices are the first points of a store. The surface: all triangles, the hull, and where
  // regions meet, each face once.
  ConformingMesh mesh;
};

CheckedMesh check_given(const GivenMesh& given, Control& control);

}  // namespace delmesher::improve
