#include "mesher/refine/facet_triangulations.h"

#include <gtest/gtest.h>

#include "mesher/refine/test_parts.h"

namespace delmesher::refine {

// Breaks one invariant at a time.
struct FacetTriangulationsBreaker {
  Parts& parts;
  FacetTriangulations& part;

  std::uint32_t live() const {
    std::uint32_t s = 0;
    while (!part.list_[s].alive) ++s;
    return s;
  }
  // One with an edge that is not a subsegment.
  SubfacetEdge inner() const {
    SubfacetEdge e(live(), 0);
    while (!neighbor(e).exists()) e = {e.subfacet(), e.edge() + 1};
    return e;
  }
  SubfacetEdge& neighbor(SubfacetEdge e) const {
    return part.list_[e.subfacet()].neighbor[e.edge()];
  }
  void turn() const { std::swap(part.list_[live()].v[0], part.list_[live()].v[1]); }
  void unlink() const { neighbor(inner()) = {}; }
  void link_to_no_edge() const { neighbor(inner()) = {part.size(), 0}; }
  void link_to_itself() const { neighbor(inner()) = inner(); }
  // Seen from below, circles have their inside outside.
  void look_from_below() const {
    const std::uint32_t f = part.list_[inner().subfacet()].facet;
    const auto& frame = parts.plc().facets[f].frame;
    for (const VertexId v : parts.all_vertices()) {
      if (parts.predicates.orient3d(frame[0], frame[1], frame[2], v) < 0)
        part.planes_[f].off_plane = v;
    }
  }
  void kill() const {
    part.list_[live()].alive = false;
    ++part.dead_;
  }
  void kill_uncounted() const { part.list_[live()].alive = false; }
};

namespace {

// Brute force: the subfacets of each facet are the Delaunay triangulation of its vertices.
void expect_delaunay(const Parts& parts) {
  for (std::uint32_t f = 0; f < parts.plc().facets.size(); ++f) {
    std::vector<VertexId> vertices;
    for (const std::uint32_t s : parts.live_in(f)) {
      for (const VertexId v : parts.planar[s].v) vertices.push_back(v);
    }
    for (const std::uint32_t s : parts.live_in(f)) {
      const auto& [a, b, c] = parts.planar[s].v;
      EXPECT_GT(parts.planar.orient(f, a, b, c), 0);
      for (const VertexId v : vertices) {
        EXPECT_TRUE(v == a || v == b || v == c || !parts.planar.in_circle(s, v));
      }
    }
  }
}

// The area within the boundary as it is given by the complex.
void expect_tiling(const Parts& parts) {
  for (std::uint32_t f = 0; f < parts.plc().facets.size(); ++f) {
    Vec3 expected{}, sum{};
    double total = 0;
    const PlcFacet& facet = parts.plc().facets[f];
    for (const PlcFacet::Side& side : facet.boundary) {
      auto [a, b] = parts.plc().segments[side.segment].vertex;
      if (side.reversed) std::swap(a, b);
      const Vec3 part = parts.area(facet.frame[0], a, b);
      for (int k = 0; k < 3; ++k) expected[k] += part[k];
    }
    for (const std::uint32_t s : parts.live_in(f)) {
      const auto& [a, b, c] = parts.planar[s].v;
      const Vec3 part = parts.area(a, b, c);
      for (int k = 0; k < 3; ++k) sum[k] += part[k];
      total += norm(part);
    }
    EXPECT_LT(distance(sum, expected), 1e-12 * norm(expected));
    EXPECT_NEAR(total, norm(expected), 1e-12 * total);  // none upside down, none twice
  }
}

constexpr std::array<Vec3, 3> kBottom = {{{0, 0, 0}, {3, 0, 0}, {3, 2, 0}}};

TEST(FacetTriangulations, EveryFacetIsTiledByDelaunayTriangles) {
  for (const Surface& surface : {box(), ell(), wedge(), tent()}) {
    const Parts parts(false, surface);
    ASSERT_TRUE(parts.planar.built());
    expect_tiling(parts);
    expect_delaunay(parts);
  }
  Parts parts;
  EXPECT_EQ(parts.planar.size(), 24U);
  EXPECT_EQ(complaint_of(parts.planar, parts.control), "nothing");
}

TEST(FacetTriangulations, PointsAreLocatedFromAnywhereInTheirFacet) {
  Parts parts;
  parts.insert_some();
  const std::uint32_t bottom = parts.facet_through(kBottom);
  const FacetTriangulations& part = parts.planar;
  const std::vector<std::uint32_t> live = parts.live_in(bottom);
  ASSERT_GT(live.size(), 6U);
  for (const std::uint32_t start : live) {
    for (const auto& [x, y] :
         {std::array{0.25, 1.875}, std::array{2.75, 0.125}, std::array{1.5, 1.0}}) {
      const VertexId v = parts.points.add_explicit(x, y, 0);
      const auto [s, blocked] = part.locate(v, start);
      ASSERT_NE(s, kNone);
      EXPECT_EQ(blocked, kNone);
      EXPECT_EQ(part[s].facet, bottom);
      for (std::uint32_t i = 0; i < 3; ++i) {
        const auto [from, to] = part.ends({s, i});
        EXPECT_GE(part.orient(bottom, from, to, v), 0);
      }
    }
    // Beyond a side, seen through one of its subsegments, with the point on their other side.
    const VertexId outside = parts.points.add_explicit(1.375, -0.25, 0);
    const auto [s, blocked] = part.locate(outside, start);
    EXPECT_EQ(s, kNone);
    ASSERT_NE(blocked, kNone);
    EXPECT_EQ(parts.subsegments[blocked].segment, parts.segment(0, 1));
  }
}

TEST(FacetTriangulations, PointsAreInsertedInTheirFacetAndOnItsSides) {
  Parts parts;
  const std::uint32_t bottom = parts.facet_through(kBottom);
  const VertexId v = parts.insert_in_facet(bottom, {1.25, 0.75, 0});
  EXPECT_EQ(parts.planar.created().size(), 4U);
  for (const std::uint32_t s : parts.planar.created()) EXPECT_EQ(parts.planar[s].v[0], v);
  EXPECT_EQ(parts.live_in(bottom).size(), 4U);
  const std::uint32_t half = parts.split(parts.segment(0, 1));
  EXPECT_EQ(parts.live_in(bottom).size(), 5U);
  for (const std::uint32_t s : {parts.segment(0, 1), half}) {
    for (const SubfacetEdge side : parts.subsegments[s].side) {
      ASSERT_TRUE(side.exists());
      EXPECT_EQ(parts.planar[side.subfacet()].subsegment[side.edge()], s);
      EXPECT_EQ(parts.subsegments.find(parts.planar.ends(side)[0], parts.planar.ends(side)[1]), s);
    }
  }
  parts.insert_in_facet(bottom, {0.125, 1.875, 0});
  parts.split(half);
  parts.split(parts.segment(2, 3));
  parts.insert_in_facet(bottom, {2.875, 0.25, 0});
  expect_tiling(parts);
  expect_delaunay(parts);
  EXPECT_EQ(complaint_of(parts.planar, parts.control), "nothing");
}

// Neighbours and subsegments know the new numbers.
TEST(FacetTriangulations, RenumberingKeepsOrderAndInvariants) {
  Parts parts;
  parts.insert_some();
  FacetTriangulations& part = parts.planar;
  std::vector<std::array<VertexId, 3>> before, after;
  for (const Subfacet& f : part) before.push_back(f.v);
  std::vector<std::uint8_t> lives;
  for (const Subfacet& f : part) lives.push_back(f.alive ? 1 : 0);
  const std::vector<std::uint32_t> number = part.renumber();
  for (const Subfacet& f : part) {
    EXPECT_TRUE(f.alive);
    after.push_back(f.v);
  }
  ASSERT_EQ(number.size(), before.size());
  std::uint32_t next = 0;
  for (std::size_t s = 0; s < before.size(); ++s) {
    EXPECT_EQ(number[s], lives[s] != 0 ? next : kNone);
    if (lives[s] == 0) continue;
    EXPECT_EQ(after[next++], before[s]);
  }
  EXPECT_EQ(next, after.size());
  EXPECT_LT(after.size(), before.size());
  EXPECT_EQ(complaint_of(part, parts.control), "nothing");
  for (std::uint32_t s = 0; s < parts.subsegments.size(); ++s) {
    for (const SubfacetEdge side : parts.subsegments[s].side) {
      EXPECT_EQ(part[side.subfacet()].subsegment[side.edge()], s);
    }
  }
}

TEST(FacetTriangulations, ValidateReportsEveryBrokenInvariant) {
  using Breaker = FacetTriangulationsBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::turn, "turned over"},
      {&Breaker::unlink, "has no other side"},
      {&Breaker::link_to_no_edge, "no such neighbour"},
      {&Breaker::link_to_itself, "disagree about their common edge"},
      {&Breaker::look_from_below, "not locally Delaunay"},
      {&Breaker::kill, "disagree about their common edge"},
      {&Breaker::kill_uncounted, "are not counted"},
  };
  expect_complaints(cases, [&](auto damage) {
    Parts parts;
    parts.insert_some();
    EXPECT_EQ(complaint_of(parts.planar, parts.control), "nothing");
    (Breaker{parts, parts.planar}.*damage)();
    return complaint_of(parts.planar, parts.control);
  });
}

}  // namespace
}  // namespace delmesher::refine
