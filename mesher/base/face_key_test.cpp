#include "mesher/base/face_key.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace delmesher::base {
namespace {

using Face = std::array<VertexId, 3>;

// All faces of some vertices, as seen from either side, beginning with any corner.
std::vector<Face> faces_of(const std::vector<VertexId>& vertices) {
  std::vector<Face> faces;
  for (const VertexId a : vertices) {
    for (const VertexId b : vertices) {
      for (const VertexId c : vertices) {
        if (a != b && b != c && c != a) faces.push_back({a, b, c});
      }
    }
  }
  return faces;
}

TEST(FaceKey, EqualExactlyForEqualFaces) {
  const std::vector<VertexId> vertices = {0, 3, 4, 1000, 0xfffffffeU};
  const std::vector<Face> faces = faces_of(vertices);
  ASSERT_EQ(faces.size(), 60U);
  for (const Face& f : faces) {
    const auto [a, b, c] = f;
    for (const Face& g : faces) {
      const bool rotation = g == Face{a, b, c} || g == Face{b, c, a} || g == Face{c, a, b};
      const bool reversal = g == Face{a, c, b} || g == Face{c, b, a} || g == Face{b, a, c};
      EXPECT_EQ(directed_face(f) == directed_face(g), rotation);
      EXPECT_EQ(directed_face_key(f, vertices) == directed_face_key(g, vertices), rotation);
      EXPECT_EQ(undirected_face(a, b, c) == undirected_face(g[0], g[1], g[2]),
                rotation || reversal);
    }
  }
}

}  // namespace
}  // namespace delmesher::base
