#include "mesher/tetmesh/conforming_mesh.h"

#include <gtest/gtest.h>

namespace delmesher::tetmesh {
namespace {

// Tetrahedra that share a vertex, an edge, or a face with the first one.
ConformingMesh pair(const Tet& second) {
  ConformingMesh mesh;
  mesh.tetrahedra = {{0, 1, 2, 3}, second};
  mesh.region = {1, 2};
  return mesh;
}

TEST(ConformingMesh, TouchesItselfInVerticesAndEdges) {
  EXPECT_FALSE(touches_itself(pair({1, 2, 3, 4})));
  EXPECT_TRUE(touches_itself(pair({2, 3, 4, 5})));
  EXPECT_TRUE(touches_itself(pair({3, 4, 5, 6})));
  EXPECT_FALSE(touches_itself(pair({4, 5, 6, 7})));
}

// Around an edge on both sides of which are faces: a fan of three tetrahedra, of which one is
// outside.
TEST(ConformingMesh, TheOutsideDoesNotJoin) {
  ConformingMesh mesh;
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 4, 5}};
  mesh.region = {1, 1, 1};
  EXPECT_FALSE(touches_itself(mesh));
  mesh.region = {1, kOutside, 1};
  EXPECT_TRUE(touches_itself(mesh));
}

TEST(ConformingMesh, TellsTheRegionsBesideAFace) {
  ConformingMesh mesh = pair({1, 2, 3, 4});
  mesh.boundary = {{{3, 2, 1}, 0}, {{0, 1, 2}, 1}, {{7, 8, 9}, 2}};
  using Sides = std::vector<std::array<RegionId, 2>>;
  mesh.region = {3, 2};
  EXPECT_EQ(regions_beside(mesh), (Sides{{2, 3}, {0, 3}, {0, 0}}));
  mesh.region = {kOutside, 2};
  EXPECT_EQ(regions_beside(mesh), (Sides{{0, 2}, {0, 0}, {0, 0}}));
  mesh.region = {2, 2};
  EXPECT_EQ(regions_beside(mesh), (Sides{{2, 2}, {0, 2}, {0, 0}}));
}

TEST(ConformingMesh, FacesWithoutTetrahedraGo) {
  ConformingMesh mesh = pair({1, 2, 3, 4});
  mesh.boundary = {{{3, 2, 1}, 0}, {{0, 1, 4}, 1}, {{2, 3, 4}, 2}, {{7, 8, 9}, 3}};
  EXPECT_EQ(drop_bare_faces(mesh), 2U);
  ASSERT_EQ(mesh.boundary.size(), 2U);
  EXPECT_EQ(mesh.boundary[0].facet, 0U);
  EXPECT_EQ(mesh.boundary[1].facet, 2U);
}

}  // namespace
}  // namespace delmesher::tetmesh
