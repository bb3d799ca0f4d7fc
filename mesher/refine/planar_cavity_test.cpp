#include "mesher/refine/planar_cavity.h"

#include <gtest/gtest.h>

#include <set>

#include "mesher/refine/test_parts.h"

namespace delmesher::refine {
namespace {

// The bottom of the box with some points in it.
struct Bottom : Parts {
  std::uint32_t facet = facet_through({{{0, 0, 0}, {3, 0, 0}, {3, 2, 0}}});
  PlanarCavity cavity;

  void insert_some() {
    split(segment(0, 1));
    for (const auto& [x, y] : {std::array{0.5, 0.75}, std::array{1.25, 1.5}, std::array{2.125, 1.0},
                               std::array{2.25, 0.25}, std::array{0.875, 0.25}}) {
      insert_in_facet(facet, {x, y, 0});
    }
  }

  void expect_laws(VertexId v, std::uint32_t start, SubfacetEdge split) const {
    const std::set<std::uint32_t> in(cavity.subfacets().begin(), cavity.subfacets().end());
    ASSERT_EQ(in.size(), cavity.subfacets().size());
    EXPECT_EQ(cavity.subfacets().front(), start);
    // Connected.
    std::set<std::uint32_t> reached = {start};
    for (bool grows = true; grows;) {
      grows = false;
      for (const std::uint32_t s : std::set(reached)) {
        for (const SubfacetEdge e : subfacets[s].neighbor) {
          if (e.exists() && in.contains(e.subfacet())) grows |= reached.insert(e.subfacet()).second;
        }
      }
    }
    EXPECT_EQ(reached, in);
    // The skin is the boundary of the cavity, without the edge that is split, and is visible.
    std::size_t bounding = 0;
    for (const std::uint32_t s : in) {
      for (std::uint32_t i = 0; i < 3; ++i) {
        const SubfacetEdge beyond = subfacets[s].neighbor[i];
        const bool bounds = !beyond.exists() || !in.contains(beyond.subfacet());
        const bool expected = bounds && SubfacetEdge(s, i) != split;
        EXPECT_EQ(std::ranges::count(cavity.skin(), SubfacetEdge(s, i)), expected ? 1 : 0);
        bounding += expected ? 1 : 0;
      }
    }
    EXPECT_EQ(cavity.skin().size(), bounding);
    for (const SubfacetEdge e : cavity.skin()) {
      const auto [from, to] = planar.ends(e);
      EXPECT_GT(planar.orient(facet, from, to, v), 0);
    }
  }
};

TEST(PlanarCavity, AllCirclesAroundAPointInTheFacet) {
  Bottom bottom;
  bottom.insert_some();
  std::size_t largest = 0;
  for (const auto& [x, y] : {std::array{1.0, 1.0}, std::array{2.5, 0.125}, std::array{0.125, 1.75},
                             std::array{1.625, 0.5}, std::array{1.375, 0.5}}) {
    const VertexId v = bottom.points.add_explicit(x, y, 0);
    std::set<std::uint32_t> expected;
    for (const std::uint32_t s : bottom.live_in(bottom.facet)) {
      if (bottom.planar.in_circle(s, v)) expected.insert(s);
    }
    const std::uint32_t start =
        bottom.planar.locate(v, bottom.live_in(bottom.facet).front()).subfacet;
    bottom.cavity.find(bottom.planar, v, start, {});
    bottom.expect_laws(v, start, {});
    const auto& found = bottom.cavity.subfacets();
    EXPECT_EQ(std::set(found.begin(), found.end()), expected);
    largest = std::max(largest, found.size());
  }
  EXPECT_GT(largest, 3U);
}

TEST(PlanarCavity, AnEdgeThatIsSplitIsNotOnTheSkin) {
  Bottom bottom;
  bottom.insert_some();
  const std::uint32_t s = bottom.segment(2, 3);
  const VertexId v = bottom.points.add_explicit(1.5, 2, 0);
  for (const SubfacetEdge side : bottom.subsegments[s].side) {
    if (bottom.subfacets[side.subfacet()].facet != bottom.facet) continue;
    bottom.cavity.find(bottom.planar, v, side.subfacet(), side);
    bottom.expect_laws(v, side.subfacet(), side);
    return;
  }
  FAIL() << "no subfacet beside the segment";
}

// A point that bends one part of a side far outwards, at its end, sees the next part from behind,
// though the circle of the obtuse triangle there contains it. Without that triangle it sees its own
// from behind.
TEST(PlanarCavity, APointThatSeesItsSkinFromBehindIsRefused) {
  Bottom bottom;
  const std::uint32_t side = bottom.segment(0, 1);
  const auto part_of_side = [&](double from, double to) {
    for (std::uint32_t s = side; s != kNone; s = bottom.subsegments[s].next) {
      const double a = bottom.points.nearest(bottom.subsegments[s].a)[0];
      const double b = bottom.points.nearest(bottom.subsegments[s].b)[0];
      if (std::min(a, b) == from && std::max(a, b) == to) return s;
    }
    return kNone;
  };
  const auto beside = [&](double from, double to) {
    const auto& both = bottom.subsegments[part_of_side(from, to)].side;
    return bottom.subfacets[both[0].subfacet()].facet == bottom.facet ? both[0] : both[1];
  };
  bottom.split(side);
  bottom.split(part_of_side(0, 1.5));
  bottom.insert_in_facet(bottom.facet, {1.75, 0.25, 0});
  const SubfacetEdge bent = beside(0.75, 1.5);
  const std::uint32_t obtuse = beside(1.5, 3).subfacet();
  const VertexId v = bottom.points.add_explicit(1.4375, -0.1875, 0);
  ASSERT_TRUE(bottom.planar.in_circle(obtuse, v));
  ASSERT_TRUE(std::ranges::any_of(bottom.subfacets[obtuse].neighbor, [&](SubfacetEdge e) {
    return e.exists() && e.subfacet() == bent.subfacet();
  }));
  EXPECT_THROW(bottom.cavity.find(bottom.planar, v, bent.subfacet(), bent), InternalError);
  // Nearer to the middle of its part it sees everything.
  const VertexId w = bottom.points.add_explicit(1.125, -0.0625, 0);
  bottom.cavity.find(bottom.planar, w, bent.subfacet(), bent);
  bottom.expect_laws(w, bent.subfacet(), bent);
}

}  // namespace
}  // namespace delmesher::refine
