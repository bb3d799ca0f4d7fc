#include "mesher/enrich/returning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "mesher/enrich/test_input.h"
#include "mesher/surface/given_place.h"
#include "mesher/surface/test_surfaces.h"

namespace delmesher::enrich {
namespace {

constexpr double kRaised = 0x1p-6;

// A unit cube except for the vertex (1, 1, 1), which is higher by kRaised: as given, the top is
// bent at the edge from (0, 0, 1) to it. On the stand-in the vertex is where the planes of the cube
// meet, and the top is one facet.
struct Case {
  Case() {
    Surface given = surface::test_surfaces::box({0, 0, 0}, {1, 1, 1});
    raised = at({1, 1, 1}, given);
    given.vertices[raised][2] += kRaised;
    StandIn cube;
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 normal = {0, 0, 0};
      normal[k] = 1;
      cube.planes.push_back({normal, {Vec3{1, 1, 1}}});
    }
    cube.planes_of.assign(given.vertices.size(), {kNone, kNone, kNone});
    cube.planes_of[raised] = {0, 1, 2};
    stand_in = build_topology(given, refined, predicates, cube);
    as_given = build_topology(given, points, predicates_as_given);
    vertices = given.vertices;
    bent = edge_between(as_given, at({0, 0, 1}, given), raised);
  }

  static VertexId at(const Vec3& x, const Surface& surface) {
    return static_cast<VertexId>(std::ranges::find(surface.vertices, x) - surface.vertices.begin());
  }
  VertexId vertex(double x, double y, double z) const {
    return static_cast<VertexId>(std::ranges::find(vertices, Vec3{x, y, z}) - vertices.begin());
  }

  // A vertex of the mesh, with these neighbours.
  VertexId in_mesh(VertexId v, const std::array<VertexId, 3>& neighbours) {
    mesh.tetrahedra.push_back({v, neighbours[0], neighbours[1], neighbours[2]});
    return v;
  }
  VertexId in_mesh(VertexId v) { return in_mesh(v, {foot(0), foot(1), foot(2)}); }
  VertexId in_volume(double x, double y, double z) {
    return in_mesh(refined.add_explicit(x, y, z));
  }
  // On the plane of the top, by the corners of one of its two triangles: that at the side y = 0,
  // with x >= y, or the other one. At least 1 from its neighbours.
  VertexId on_top(double x, double y, bool by_first) {
    const VertexId o = vertex(0, 0, 1), side = by_first ? vertex(1, 0, 1) : vertex(0, 1, 1);
    const double u = by_first ? x - y : y - x, w = by_first ? y : x;
    return put_on_top(refined.add_on_triangle(side, raised, o, u, w));
  }
  VertexId put_on_top(VertexId v) {
    const VertexId o = vertex(0, 0, 1);
    const std::uint32_t edge = edge_between(stand_in, o, raised);
    const FacetId top = stand_in.facet_of_half_edge(stand_in.edge_half_edge[edge]);
    mesh.boundary.push_back({.vertices = {v, v, v}, .facet = top});
    return in_mesh(v);
  }
  VertexId foot(std::size_t n) const {
    return n == 0 ? vertex(0, 0, 0) : n == 1 ? vertex(1, 0, 0) : vertex(1, 1, 0);
  }

  cdt::CdtInput input() {
    append_as_given(refined, vertices, points);
    Control control(limits);
    return input_as_given(mesh, stand_in, refined, as_given, points, predicates_as_given, control);
  }
  // The facet as given that contains the triangle of the top at the side y = 0, or the other one.
  FacetId facet(bool first) const {
    for (const std::uint32_t h : as_given.edge_half_edges(bent)) {
      const auto& t = as_given.triangles[h / 3];
      const VertexId side = first ? vertex(1, 0, 1) : vertex(0, 1, 1);
      if (std::ranges::find(t, side) != t.end()) return as_given.facet_of[h / 3];
    }
    return kNone;
  }

  Limits limits;
  std::vector<Vec3> vertices;
  VertexId raised = kNone;
  PointStore refined, points;
  Predicates predicates{refined}, predicates_as_given{points};
  SurfaceTopology stand_in, as_given;
  std::uint32_t bent = kNone;  // the edge that comes back
  ConformingMesh mesh;
};

bool contains(const std::vector<VertexId>& list, VertexId v) {
  return std::ranges::find(list, v) != list.end();
}

TEST(Returning, TheModelHasOneEdgeMoreThanItsStandIn) {
  const Case c;
  ASSERT_NE(c.bent, kNone);
  EXPECT_EQ(c.stand_in.edge_is_flat[c.bent], 1);
  EXPECT_EQ(c.as_given.edge_is_flat[c.bent], 0);
  EXPECT_EQ(c.stand_in.facet_triangles.size() + 1, c.as_given.facet_triangles.size());
  EXPECT_NE(c.facet(true), c.facet(false));
}

// Whether a vertex that they are given by was moved or not.
TEST(Returning, PointsAreWrittenOnTheVerticesAsGiven) {
  Case c;
  PointStore scratch;
  const VertexId from = c.vertex(0, 0, 1);
  for (const VertexId to : {c.raised, c.vertex(1, 1, 0)}) {
    const VertexId v = c.refined.add_on_segment(from, to, 0.3);
    PointStore as_given;
    for (const VertexId end : {from, to}) {
      const Vec3& x = c.vertices[end];
      as_given.add_explicit(x[0], x[1], x[2]);
    }
    const Vec3 expected = as_given.nearest(as_given.add_on_segment(0, 1, 0.3));
    EXPECT_EQ(surface::given_place(c.refined, v, c.vertices, scratch), expected);
    EXPECT_EQ(to == c.raised, expected != c.refined.nearest(v));
  }
}

TEST(Returning, PointsOnEdgesStayOnThem) {
  Case c;
  const VertexId a = c.vertex(0, 0, 1), b = c.vertex(1, 0, 1);
  const std::uint32_t e = edge_between(c.as_given, a, b);
  std::vector<VertexId> expected;
  for (const double t : {0.75, 0.25, 0.5}) {
    expected.push_back(c.put_on_top(c.refined.add_on_segment(a, b, t)));
  }
  // From the smaller end; t is the share of a.
  std::ranges::sort(expected, [&](VertexId v, VertexId w) {
    const double x = c.refined.nearest(v)[0], y = c.refined.nearest(w)[0];
    return a < b ? x < y : x > y;
  });
  const cdt::CdtInput input = c.input();
  EXPECT_EQ(wrong(input, c.points), "");
  EXPECT_EQ(input.on_edge[e], expected);
  for (const VertexId v : expected) {
    EXPECT_TRUE(contains(input.vertices, v));
    const auto planes = c.points.planes(v);
    EXPECT_EQ(std::vector<PlaneId>(planes.begin(), planes.end()), c.as_given.edge_planes(e));
    EXPECT_TRUE(std::ranges::find(c.points.lines(v), e) != c.points.lines(v).end());
  }
}

// 0.3 of the spacing is about 0.32 where the neighbours are below, and 0.03 beside a neighbour.
TEST(Returning, PointsNearAnEdgeThatComesBackAreOnIt) {
  Case c;
  c.on_top(0.75, 0.5, true);  // 0.18 from the edge
  const VertexId far = c.on_top(0.875, 0.25, true);
  const VertexId beside = c.on_top(0.5, 0.375, true);  // 0.09 from it
  c.in_mesh(c.refined.add_explicit(0.5, 0.375, 0.875), {beside, c.foot(0), c.foot(1)});
  const cdt::CdtInput input = c.input();
  EXPECT_EQ(wrong(input, c.points), "");
  ASSERT_EQ(input.on_edge[c.bent].size(), 1U);
  const VertexId v = input.on_edge[c.bent][0];
  EXPECT_GE(v, c.refined.size());
  // Where the point was nearest to it.
  EXPECT_NEAR(c.points.nearest(v)[0], 0.625, 0.01);
  EXPECT_NEAR(c.points.nearest(v)[2], 1 + 0.625 * kRaised, 0.01 * kRaised);
  const auto planes = c.points.planes(v);
  EXPECT_EQ(std::vector<PlaneId>(planes.begin(), planes.end()), c.as_given.edge_planes(c.bent));
  EXPECT_TRUE(contains(input.on_facet[c.facet(true)], far));
  EXPECT_TRUE(contains(input.on_facet[c.facet(true)], beside));
}

TEST(Returning, PointsInsideAFacetAreInATriangleAsGiven) {
  Case c;
  const VertexId own = c.on_top(0.875, 0.25, true), other = c.on_top(0.125, 0.75, false),
                 foreign = c.on_top(0.875, 0.125, false);  // by the corners of the other triangle
  const cdt::CdtInput input = c.input();
  EXPECT_EQ(wrong(input, c.points), "");
  const std::vector<VertexId>& first = input.on_facet[c.facet(true)];
  EXPECT_EQ(input.on_facet[c.facet(false)], std::vector<VertexId>{other});
  ASSERT_EQ(first.size(), 2U);
  EXPECT_TRUE(contains(first, own));
  EXPECT_FALSE(contains(first, foreign));
  const VertexId anew = first[0] == own ? first[1] : first[0];
  EXPECT_GE(anew, c.refined.size());
  const Vec3 place = c.points.nearest(anew);
  EXPECT_NEAR(place[0], 0.875, 0x1p-18);
  EXPECT_NEAR(place[1], 0.125, 0x1p-18);
  EXPECT_NEAR(place[2], 1 + 0.125 * kRaised, 0x1p-18);
  for (const VertexId v : {own, anew}) {
    EXPECT_TRUE(contains(input.vertices, v));
    const auto planes = c.points.planes(v);
    EXPECT_EQ(std::vector<PlaneId>(planes.begin(), planes.end()),
              std::vector<PlaneId>{c.as_given.facet_plane[c.facet(true)]});
    EXPECT_TRUE(c.points.lines(v).empty());
  }
}

// Points in the plane of the top, on its outline and beyond it, by its corners.
TEST(Returning, PointsThatAreNotInsideTheirFacetAreLeftOut) {
  Case c;
  const VertexId outline = c.on_top(1, 0.25, true), beyond = c.on_top(1.0625, 0.25, true),
                 inside = c.on_top(0.9375, 0.25, true);
  const cdt::CdtInput input = c.input();
  EXPECT_EQ(wrong(input, c.points), "");
  EXPECT_FALSE(contains(input.vertices, outline));
  EXPECT_FALSE(contains(input.vertices, beyond));
  EXPECT_TRUE(contains(input.vertices, inside));
}

TEST(Returning, OfPointsThatCoincideOneStays) {
  Case c;
  // On both sides of the edge that comes back, as far from it as from the middle of the other.
  c.on_top(0.625, 0.375, true);
  c.on_top(0.375, 0.625, false);
  // Twice the same.
  c.on_top(0.875, 0.25, true);
  c.put_on_top(
      c.refined.add_on_triangle(c.raised, c.vertex(1, 0, 1), c.vertex(0, 0, 1), 0.25, 0.625));
  const cdt::CdtInput input = c.input();
  EXPECT_EQ(wrong(input, c.points), "");
  EXPECT_EQ(input.on_edge[c.bent].size(), 1U);
  EXPECT_EQ(input.on_facet[c.facet(true)].size(), 1U);
}

// The vertex that goes back is kRaised away: twice that, around the triangles at it, is left out.
TEST(Returning, PointsThatTheSurfaceMayHavePassedOverAreLeftOut) {
  Case c;
  const VertexId within = c.in_volume(0.75, 0.25, 1 - 1.5 * kRaised),
                 beyond = c.in_volume(0.75, 0.25, 1 - 2.5 * kRaised),
                 between = c.in_volume(0.75, 0.25, 1 + 0.125 * kRaised),
                 middle = c.in_volume(0.5, 0.5, 0.5),
                 at_a_fixed_triangle = c.in_volume(0.75, 0.25, 0x1p-40),
                 unused = c.refined.add_explicit(0.5, 0.5, 0.25);
  const cdt::CdtInput input = c.input();
  EXPECT_EQ(wrong(input, c.points), "");
  for (const VertexId v : {within, between, unused}) EXPECT_FALSE(contains(input.vertices, v)) << v;
  for (const VertexId v : {beyond, middle, at_a_fixed_triangle}) {
    EXPECT_TRUE(contains(input.vertices, v)) << v;
  }
  EXPECT_EQ(input.vertices.size(), 8U + 3U);
}

}  // namespace
}  // namespace delmesher::enrich
