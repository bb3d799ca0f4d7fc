#include "mesher/improve/face_removal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace delmesher::improve::face_removal_test {
namespace {

// Flat tetrahedra above and below the triangles of a pentagon: vertices 0 to 4, then the one above
// and the one below. Around the edge between those two there would be five good ones.
struct Pentagon {
  static constexpr VertexId kAbove = 5, kBelow = 6;
  static constexpr Vec3 kCorner[] = {{1, 0, 0},
                                     {0.3125, 0.9375, 0},
                                     {-0.8125, 0.5625, 0},
                                     {-0.8125, -0.5625, 0},
                                     {0.3125, -0.9375, 0},
                                     {0, 0, 0.625},
                                     {0, 0, -0.625}};

  // `wall`: a face of the surface among the three of the pentagon; 3: none.
  explicit Pentagon(int wall = 3, double max_edge = 0) {
    for (const Vec3& x : kCorner) points.add_explicit(x[0], x[1], x[2]);
    std::vector<Tet> tetrahedra;
    std::vector<SurfaceFace> boundary;
    for (VertexId k = 0; k < 3; ++k) {
      tetrahedra.push_back({0, k + 1, k + 2, kAbove});
      tetrahedra.push_back({0, k + 2, k + 1, kBelow});
      if (static_cast<int>(k) == wall) boundary.push_back({{0, k + 1, k + 2}, 1});
    }
    const std::vector<RegionId> region(tetrahedra.size(), 1);
    const Goals goals{.target = {0.14F, 0.12F, 0.16F}, .max_edge = max_edge};
    state.emplace(
        NumberedMesh{{0, 1, 2, 3, 4, 5, 6}, MeshTopology(tetrahedra, region, boundary, 7)}, nullptr,
        std::span<const Vec3>{}, points, predicates, goals);
  }

  // Removes the n-th face of the pentagon.
  bool run(TetId n) { return FaceRemoval(*state).run(2 * n, 3); }

  std::vector<Tet> tetrahedra() const {
    std::vector<Tet> all;
    for (TetId t = 0; t < state->mesh.slots(); ++t) {
      if (state->mesh.alive(t)) all.push_back(state->mesh.tet(t));
    }
    return all;
  }

  PointStore points;
  Predicates predicates{points};
  std::optional<State> state;
};

double volume(const std::vector<Tet>& tetrahedra) {
  double sum = 0;  // of numbers with few bits: exact
  for (const Tet& t : tetrahedra) {
    const auto at = [&](int i) { return Pentagon::kCorner[t[i]]; };
    sum += dot(cross(subtract(at(1), at(0)), subtract(at(2), at(0))), subtract(at(3), at(0)));
  }
  return sum;
}

// From whichever of its faces it begins.
TEST(FaceRemoval, TakesAllFacesBetweenTwoVertices) {
  for (TetId n = 0; n < 3; ++n) {
    Pentagon p;
    const double before = volume(p.tetrahedra());
    const Quality was = p.state->worst_of(std::vector<TetId>{0, 1, 2, 3, 4, 5});
    ASSERT_TRUE(p.run(n)) << n;
    p.state->mesh.validate();
    const std::vector<Tet> after = p.tetrahedra();
    EXPECT_EQ(after.size(), 5U);
    EXPECT_EQ(volume(after), before);
    for (const Tet& t : after) {
      EXPECT_GT(p.predicates.orient3d(t[0], t[1], t[2], t[3]), 0);
      EXPECT_EQ(std::count(t.begin(), t.end(), Pentagon::kAbove), 1);
      EXPECT_EQ(std::count(t.begin(), t.end(), Pentagon::kBelow), 1);
      EXPECT_GT(p.state->score(p.state->quality_of(t)), p.state->score(was));
    }
  }
}

// What is left would not be convex.
TEST(FaceRemoval, KeepsFacesOfTheSurface) {
  for (int wall = 0; wall < 3; ++wall) {
    for (TetId n = 0; n < 3; ++n) EXPECT_FALSE(Pentagon(wall).run(n)) << wall << ' ' << n;
  }
}

TEST(FaceRemoval, MakesNoLongEdge) {
  EXPECT_FALSE(Pentagon(3, 1.125).run(1));
  EXPECT_TRUE(Pentagon(3, 1.375).run(1));
}

}  // namespace
}  // namespace delmesher::improve::face_removal_test
