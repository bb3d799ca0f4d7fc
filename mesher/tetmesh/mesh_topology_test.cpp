#include "mesher/tetmesh/mesh_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mesher/base/check.h"

namespace delmesher::tetmesh {
namespace {

// Two tetrahedra on both sides of the face 0 1 2, the second one outside.
struct Pair {
  std::vector<Tet> tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  std::vector<RegionId> region = {1, 0};
  std::vector<SurfaceFace> boundary = {{{0, 1, 2}, 7}};

  MeshTopology mesh() const { return {tetrahedra, region, boundary, 5}; }
};

// Three tetrahedra around the edge 3 4, inside a wall of six faces.
MeshTopology three_around_an_edge() {
  const std::vector<Tet> tetrahedra = {{0, 1, 3, 4}, {1, 2, 3, 4}, {2, 0, 3, 4}};
  const std::vector<RegionId> region = {1, 1, 1};
  std::vector<SurfaceFace> boundary;
  for (std::uint32_t i = 0; i < 3; ++i) {
    boundary.push_back({{i, (i + 1) % 3, 3}, i});
    boundary.push_back({{(i + 1) % 3, i, 4}, 3 + i});
  }
  return {tetrahedra, region, boundary, 5};
}

std::vector<TetId> star(const MeshTopology& mesh, VertexId v) {
  std::vector<TetId> result;
  mesh.star(v, result);
  std::sort(result.begin(), result.end());
  return result;
}

TEST(MeshTopology, KnowsNeighboursAndFacets) {
  const MeshTopology mesh = Pair().mesh();
  mesh.validate();
  EXPECT_EQ(mesh.neighbor(0, 3), 1U);
  EXPECT_EQ(mesh.mirror(0, 3), 3);
  EXPECT_EQ(mesh.facet(0, 3), 7U);
  EXPECT_EQ(mesh.facet(1, 3), 7U);
  EXPECT_EQ(mesh.neighbor(0, 0), kNone);
  EXPECT_EQ(mesh.facet(0, 0), kNone);
  EXPECT_EQ(star(mesh, 0), (std::vector<TetId>{0, 1}));
  EXPECT_EQ(star(mesh, 3), (std::vector<TetId>{0}));
}

// Vertex 8 has no tetrahedra.
TEST(MeshTopology, KnowsVerticesOfSeveralStars) {
  const std::vector<Tet> tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}, {3, 5, 6, 7}};
  const std::vector<RegionId> region = {1, 1, 1};
  EXPECT_EQ(MeshTopology(tetrahedra, region, {}, 9).pinched(), std::vector<VertexId>{3});
}

TEST(MeshTopology, RefusesAFaceOfThree) {
  Pair pair;
  pair.tetrahedra.push_back({0, 1, 2, 4});
  pair.region.push_back(0);
  EXPECT_THROW(pair.mesh(), InternalError);
}

TEST(MeshTopology, RegionsChangeAtTheSurfaceAlone) {
  Pair same_side;
  same_side.region = {1, 1};
  EXPECT_NO_THROW(same_side.mesh().validate());
  Pair no_surface;
  no_surface.boundary.clear();
  EXPECT_THROW(no_surface.mesh().validate(), InternalError);
  no_surface.region = {2, 1};
  EXPECT_THROW(no_surface.mesh().validate(), InternalError);
  no_surface.region = {2, 2};
  EXPECT_NO_THROW(no_surface.mesh().validate());
}

TEST(MeshTopology, ReplacesAndKeepsTheOuterFaces) {
  MeshTopology mesh = three_around_an_edge();
  mesh.validate();
  const std::vector<TetId> all = {0, 1, 2};
  const std::vector<CreatedTet> two = {{{0, 1, 2, 4}, 1}, {{1, 0, 2, 3}, 1}};
  mesh.replace(all, two, {});
  mesh.validate();
  EXPECT_EQ(mesh.created().size(), 2U);
  EXPECT_EQ(star(mesh, 3).size(), 1U);
  for (const TetId t : mesh.created()) {
    for (int i = 0; i < 4; ++i) {
      const VertexId opposite = mesh.tet(t)[i];
      EXPECT_EQ(mesh.facet(t, i) == kNone, opposite == 3 || opposite == 4);
    }
  }
}

TEST(MeshTopology, ForgetsAVertexThatIsSwallowed) {
  // Four tetrahedra around 4 become one.
  const std::vector<Tet> tetrahedra = {{0, 1, 2, 4}, {0, 3, 1, 4}, {1, 3, 2, 4}, {0, 2, 3, 4}};
  const std::vector<RegionId> region = {1, 1, 1, 1};
  std::vector<SurfaceFace> boundary = {
      {{0, 1, 2}, 0}, {{0, 3, 1}, 1}, {{1, 3, 2}, 2}, {{0, 2, 3}, 3}};
  MeshTopology mesh(tetrahedra, region, boundary, 5);
  mesh.validate();
  const std::vector<TetId> all = {0, 1, 2, 3};
  const std::vector<CreatedTet> one = {{{0, 1, 2, 3}, 1}};
  mesh.replace(all, one, {});
  mesh.validate();
  EXPECT_EQ(mesh.incident(4), kNone);
  EXPECT_NE(mesh.incident(3), kNone);
}

TEST(MeshTopology, ContractsAnEdge) {
  const std::vector<Tet> tetrahedra = {{0, 1, 2, 4}, {0, 3, 1, 4}, {1, 3, 2, 4}, {0, 2, 3, 4}};
  const std::vector<RegionId> region = {1, 1, 1, 1};
  std::vector<SurfaceFace> boundary = {
      {{0, 1, 2}, 0}, {{0, 3, 1}, 1}, {{1, 3, 2}, 2}, {{0, 2, 3}, 3}};
  MeshTopology mesh(tetrahedra, region, boundary, 5);
  std::vector<TetId> around;
  mesh.star(4, around);
  mesh.contract(4, 0, around);
  mesh.validate();
  EXPECT_EQ(mesh.incident(4), kNone);
  std::size_t alive = 0;
  for (TetId t = 0; t < mesh.slots(); ++t) alive += mesh.alive(t) ? 1 : 0;
  EXPECT_EQ(alive, 1U);
  const TetId left = mesh.incident(0);
  std::multiset<FacetId> facets;
  for (int i = 0; i < 4; ++i) facets.insert(mesh.facet(left, i));
  EXPECT_EQ(facets, (std::multiset<FacetId>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace delmesher::tetmesh
