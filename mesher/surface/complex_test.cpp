#include "mesher/surface/complex.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesher/surface/test_surfaces.h"
#include "mesher/surface/topology.h"
#include "mesher/surface/validity.h"

namespace delmesher::surface {
namespace {

using namespace test_surfaces;

using Corners = std::array<std::uint32_t, 3>;

// Two unit cubes side by side, each with the wall between them, labelled 1 and 2.
Surface pair_of_cubes() {
  Surface pair = box({0, 0, 0}, {1, 1, 1});
  pair.labels.assign(pair.triangles.size(), 1);
  const Surface second = box({1, 0, 0}, {2, 1, 1});
  std::vector<std::uint32_t> number;
  for (const Point& p : second.vertices) {
    const auto at = std::ranges::find(pair.vertices, p);
    number.push_back(static_cast<std::uint32_t>(at - pair.vertices.begin()));
    if (at == pair.vertices.end()) pair.vertices.push_back(p);
  }
  for (const auto& [a, b, c] : second.triangles) {
    pair.triangles.push_back({number[a], number[b], number[c]});
    pair.labels.push_back(2);
  }
  return pair;
}

bool is_valid(const Surface& surface, Rules rules) {
  Limits limits;
  Control control(limits);
  return check_validity(surface, false, control, kMostPlaces, rules).report.status.ok();
}

TEST(Complex, WallsThatAreGivenTwiceCountOnce) {
  const Surface given = pair_of_cubes();
  const MergedSurface merged = merge_repeated(given);
  EXPECT_EQ(given.triangles.size(), 24U);
  ASSERT_EQ(merged.surface.triangles.size(), 22U);
  EXPECT_EQ(merged.surface.vertices, given.vertices);
  EXPECT_TRUE(std::ranges::is_sorted(merged.given));
  std::size_t walls = 0;
  for (std::uint32_t t = 0; t < merged.given.size(); ++t) {
    EXPECT_EQ(merged.surface.triangles[t], given.triangles[merged.given[t]]);
    const bool wall = std::ranges::all_of(
        merged.surface.triangles[t], [&](std::uint32_t v) { return given.vertices[v][0] == 1; });
    walls += wall ? 1 : 0;
    const std::vector<std::int32_t> own = {given.labels[merged.given[t]]}, both = {1, 2};
    EXPECT_EQ(merged.labels_of(t), wall ? both : own);
  }
  EXPECT_EQ(walls, 2U);
}

// Refused later, with the numbers of the triangles given.
TEST(Complex, TrianglesThatAreNoneAreLeftAlone) {
  Surface surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  surface.triangles = {{0, 0, 1}, {0, 0, 1}, {7, 8, 9}};
  EXPECT_EQ(merge_repeated(surface).surface.triangles, surface.triangles);
}

TEST(Complex, IsValidWhereASolidIsNot) {
  const Surface pair = merge_repeated(pair_of_cubes()).surface;
  EXPECT_FALSE(is_valid(pair, Rules::solid));
  EXPECT_TRUE(is_valid(pair, Rules::complex));
  EXPECT_FALSE(is_valid(pair_of_cubes(), Rules::complex)) << "repeated triangles";
  Surface crossed = pair;
  crossed.vertices.insert(crossed.vertices.end(), {{0.5, 0.5, -1}, {0.5, 0.5, 2}, {0.6, 0.5, 2}});
  const auto n = static_cast<std::uint32_t>(pair.vertices.size());
  crossed.triangles.push_back({n, n + 1, n + 2});
  crossed.labels.push_back(0);
  EXPECT_FALSE(is_valid(crossed, Rules::complex));
}

struct BuiltComplex {
  Surface surface;
  PointStore points;
  Predicates predicates{points};
  SurfaceTopology topology;
  explicit BuiltComplex(Surface s)
      : surface(std::move(s)),
        topology(build_topology(surface, points, predicates, Rules::complex)) {}

  std::size_t half_edges_of(std::uint32_t e) const {
    std::size_t count = 0;
    topology.for_each_half_edge(e, [&](std::uint32_t h) {
      EXPECT_EQ(topology.edge_of[h], e);
      ++count;
      return true;
    });
    return count;
  }
};

TEST(Complex, EveryEdgeHasAllOfItsHalfEdges) {
  const BuiltComplex built(merge_repeated(pair_of_cubes()).surface);
  const SurfaceTopology& s = built.topology;
  std::vector<std::size_t> count(5, 0);
  for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
    ++count[built.half_edges_of(e)];
    const auto [a, b] = s.edge_vertices(e);
    EXPECT_LT(a, b);
    EXPECT_EQ(edge_between(s, a, b), e);
    EXPECT_EQ(edge_between(s, b, a), e);
  }
  EXPECT_EQ(count[3], 4U) << "around the wall";
  EXPECT_EQ(count[1] + count[4], 0U);
  EXPECT_EQ(3 * count[3] + 2 * count[2], 3 * s.triangles.size());
}

// The sides of the two cubes are in one plane, and the wall ends at the edge between them.
TEST(Complex, FacetsEndWhereMoreThanTwoTrianglesMeet) {
  Surface pair = merge_repeated(pair_of_cubes()).surface;
  pair.labels.clear();
  const BuiltComplex built(pair);
  const SurfaceTopology& s = built.topology;
  EXPECT_EQ(s.facet_triangles.size(), 11U);
  for (const auto& triangles : s.facet_triangles) EXPECT_EQ(triangles.size(), 2U);
}

// A floor of 3 x 3 squares, and a sheet on an edge in its middle: the floor goes around the edge.
TEST(Complex, AFacetThatSurroundsAnEdgeFallsApart) {
  Surface surface = box({0, 0, 0}, {3, 3, 3}, 3);
  const std::size_t before = BuiltComplex(surface).topology.facet_triangles.size();
  EXPECT_EQ(before, 6U);
  const auto at = [&](const Point& p) {
    return static_cast<std::uint32_t>(std::ranges::find(surface.vertices, p) -
                                      surface.vertices.begin());
  };
  surface.vertices.push_back({1.5, 1, 1});
  surface.triangles.push_back({at({1, 1, 0}), at({2, 1, 0}), at({1.5, 1, 1})});
  const BuiltComplex built(surface);
  EXPECT_EQ(built.topology.facet_triangles.size(), 5 + 18 + 1U);
  std::size_t free = 0;
  for (std::uint32_t e = 0; e < built.topology.edge_count(); ++e) {
    free += built.topology.is_free(e) ? 1 : 0;
  }
  EXPECT_EQ(free, 2U);
}

}  // namespace
}  // namespace delmesher::surface
