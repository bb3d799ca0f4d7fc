// Tetrahedra and triangles by their corners.
#pragma once

#include <array>
#include <utility>

#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

using Tet = std::array<Index, 4>;
using Face = std::array<Index, 3>;

// Face i is opposite to corner i, counter-clockwise seen from outside.
inline Face face_of(const Tet& tet, int i) {
  static constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  return {tet[kFaces[i][0]], tet[kFaces[i][1]], tet[kFaces[i][2]]};
}

// Sorts the corners; is that an even permutation?
inline bool sort_face(Face& face) {
  bool even = true;
  const auto order = [&](int a, int b) {
    if (face[a] > face[b]) {
      std::swap(face[a], face[b]);
      even = !even;
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return even;
}

}  // namespace tetproof::oracles
