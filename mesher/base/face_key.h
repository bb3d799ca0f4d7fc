// Keys of triangular faces. Equal faces have equal keys, whatever vertex they begin with.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "mesher/base/ids.h"

namespace delmesher::base {

// The same for both sides of the face.
inline std::array<VertexId, 3> undirected_face(VertexId a, VertexId b, VertexId c) {
  if (b < a) std::swap(a, b);
  if (c < b) std::swap(b, c);
  if (b < a) std::swap(a, b);
  return {a, b, c};
}

// The same for one side of the face: its vertices in their order, from the smallest one on.
inline std::array<VertexId, 3> directed_face(std::array<VertexId, 3> face) {
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return face;
}

// Key of the face as seen from one side, by the numbers of its vertices among `vertices`, which are
// ascending and fewer than 2^21. Never ~0.
inline std::uint64_t directed_face_key(std::array<VertexId, 3> face,
                                       std::span<const VertexId> vertices) {
  std::uint64_t key = 0;
  for (const VertexId v : directed_face(face)) {
    const auto n = std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin();
    key = (key << 21U) | static_cast<std::uint64_t>(n);
  }
  return key;
}

}  // namespace delmesher::base
