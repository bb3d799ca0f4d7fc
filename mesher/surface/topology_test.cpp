#include "mesher/surface/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mesher/surface/carrier_key.h"
#include "mesher/surface/test_surfaces.h"

namespace delmesher::surface {
namespace {

using namespace test_surfaces;

struct Built {
  PointStore points;
  Predicates predicates{points};
  SurfaceTopology topology;
  explicit Built(const Surface& s) : topology(build_topology(s, points, predicates)) {}
};

bool has(std::span<const std::uint32_t> ids, std::uint32_t id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

TEST(Topology, AdjacencyOfABox) {
  const Built built(box({0, 0, 0}, {1, 2, 3}, 3));
  const SurfaceTopology& s = built.topology;
  EXPECT_EQ(s.edge_count(), s.triangles.size() * 3 / 2);
  for (std::uint32_t h = 0; h < s.opposite.size(); ++h) {
    EXPECT_EQ(s.opposite[s.opposite[h]], h);
    EXPECT_EQ(s.from(h), s.to(s.opposite[h]));
    EXPECT_EQ(s.to(h), s.from(s.opposite[h]));
    EXPECT_EQ(s.edge_of[h], s.edge_of[s.opposite[h]]);
  }
  for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
    EXPECT_LT(s.edge_vertices(e)[0], s.edge_vertices(e)[1]);
    EXPECT_EQ(s.edge_of[s.edge_half_edge[e]], e);
  }
  for (VertexId v = 0; v < s.vertex_half_edge.size(); ++v) {
    EXPECT_EQ(s.from(s.vertex_half_edge[v]), v);
  }
}

TEST(Topology, FacetsOfASubdividedBox) {
  constexpr std::uint32_t n = 4;
  const Built built(box({0.1, 0.2, 0.3}, {1.7, 2.9, 3.1}, n));
  const SurfaceTopology& s = built.topology;
  ASSERT_EQ(s.facet_triangles.size(), 6U);
  EXPECT_EQ(s.plane_count, 6U);
  std::uint32_t previous = 0;
  for (FacetId f = 0; f < 6; ++f) {
    EXPECT_EQ(s.facet_triangles[f].size(), 2U * n * n);
    EXPECT_TRUE(std::is_sorted(s.facet_triangles[f].begin(), s.facet_triangles[f].end()));
    if (f > 0) {
      EXPECT_GT(s.facet_triangles[f][0], previous);
    }
    previous = s.facet_triangles[f][0];
    EXPECT_EQ(s.facet_axis[f], static_cast<int>(f / 2));
    EXPECT_EQ(s.facet_axis_sign[f], f % 2 == 0 ? -1 : 1);
  }
  const auto edges = std::count(s.edge_is_flat.begin(), s.edge_is_flat.end(), 0);
  EXPECT_EQ(edges, 12 * n);
  std::set<std::uint32_t> lines;
  for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
    EXPECT_EQ(s.edge_is_flat[e] != 0, s.edge_line[e] == kNone);
    if (s.edge_is_flat[e] == 0) lines.insert(s.edge_line[e]);
  }
  EXPECT_EQ(lines.size(), 12U);
}

TEST(Topology, Supports) {
  const Built built(box({0, 0, 0}, {1, 1, 1}, 2));
  const SurfaceTopology& s = built.topology;
  std::array<int, 4> seen{};
  for (VertexId v = 0; v < built.points.size(); ++v) {
    const auto p = built.points.nearest(v);
    const auto outer = static_cast<std::size_t>(
        std::count_if(p.begin(), p.end(), [](double x) { return x != 0.5; }));
    ++seen[outer];
    EXPECT_EQ(built.points.planes(v).size(), outer);
    if (outer == 1) {
      EXPECT_TRUE(built.points.lines(v).empty());
    }
  }
  EXPECT_EQ(seen, (std::array<int, 4>{0, 6, 12, 8}));
  for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
    if (s.edge_is_flat[e] != 0) continue;
    for (const VertexId v : s.edge_vertices(e)) {
      EXPECT_TRUE(has(built.points.lines(v), e));
      EXPECT_TRUE(has(built.points.lines(v), s.edge_line[e]));
    }
  }
}

TEST(Topology, LabelsSeparateCoplanarFacets) {
  Surface s = box({0, 0, 0}, {1, 1, 1});
  s.labels.assign(s.triangles.size(), 7);
  s.labels[1] = 8;
  const Built built(s);
  EXPECT_EQ(built.topology.facet_triangles.size(), 7U);
  EXPECT_EQ(built.topology.plane_count, 6U);
  EXPECT_EQ(built.topology.facet_plane[0], built.topology.facet_plane[1]);
  EXPECT_EQ(std::count(built.topology.edge_is_flat.begin(), built.topology.edge_is_flat.end(), 0),
            13);
}

TEST(Topology, AFacetPerTriangleConstrainsAllEdges) {
  const Built built(box({0, 0, 0}, {1, 2, 3}, 2));
  const SurfaceTopology& s = built.topology;
  const SurfaceTopology each = with_facet_per_triangle(s);
  ASSERT_EQ(each.facet_triangles.size(), s.triangles.size());
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    EXPECT_EQ(each.facet_triangles[each.facet_of[t]], std::vector<std::uint32_t>{t});
    EXPECT_EQ(each.facet_plane[each.facet_of[t]], s.facet_plane[s.facet_of[t]]);
    EXPECT_EQ(each.facet_axis[each.facet_of[t]], s.facet_axis[s.facet_of[t]]);
    EXPECT_EQ(each.facet_axis_sign[each.facet_of[t]], s.facet_axis_sign[s.facet_of[t]]);
  }
  for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
    EXPECT_EQ(each.edge_is_flat[e], 0);
    EXPECT_EQ(each.edge_line[e], s.edge_is_flat[e] != 0 ? e : s.edge_line[e]);
  }
}

TEST(Topology, NearlyCoplanarIsNotCoplanar) {
  Surface s = box({0, 0, 0}, {1, 1, 1});
  s.vertices[2][0] += 0x1p-52;  // some corner: at least one of its three squares is bent
  const Built built(s);
  EXPECT_GT(built.topology.facet_triangles.size(), 6U);
}

TEST(Topology, SeparateFacetsInOnePlaneShareIt) {
  // Two boxes with equal extents along z: their bottoms and tops are coplanar, and so are the sides
  // facing away from each other in opposite orientations at y = 0 and y = 1.
  const Built built(joined(box({0, 0, 0}, {1, 1, 1}), box({2, 1, 0}, {3, 4, 1})));
  EXPECT_EQ(built.topology.facet_triangles.size(), 12U);
  EXPECT_EQ(built.topology.plane_count, 9U);
}

TEST(CarrierKey, DependsOnTheCarrierOnly) {
  // Planes through points of a grid with awkward spacing: equal key iff equal plane.
  const double h = 0x1.8p-40;
  const auto p = [&](int i, int j, int k) { return Vec3{i * h, j * h, k * h}; };
  EXPECT_EQ(plane_key(p(1, 0, 0), p(0, 1, 0), p(0, 0, 1)),
            plane_key(p(2, -1, 0), p(-1, 1, 1), p(0, -4, 5)));
  EXPECT_NE(plane_key(p(1, 0, 0), p(0, 1, 0), p(0, 0, 1)),
            plane_key(p(2, 0, 0), p(0, 2, 0), p(0, 0, 2)));
  EXPECT_EQ(plane_key(p(1, 0, 0), p(0, 1, 0), p(0, 0, 1)),
            plane_key(p(0, 1, 0), p(1, 0, 0), p(0, 0, 1)));
  EXPECT_EQ(line_key(p(1, 2, 3), p(2, 4, 6)), line_key(p(-5, -10, -15), p(0, 0, 0)));
  EXPECT_NE(line_key(p(1, 2, 3), p(2, 4, 6)), line_key(p(1, 2, 3), p(2, 4, 7)));
  EXPECT_NE(line_key({0, 0, 0}, {1, 1, 1}), line_key({0, 0, 0x1p-1074}, {1, 1, 1}));
  EXPECT_EQ(line_key({0, 0, 0}, {0x1p-1074, 0, 0}), line_key({0x1p1000, 0, 0}, {3, -0.0, 0}));
}

TEST(Topology, HugeAndTinyCoordinates) {
  for (const double scale : {0x1p-500, 0x1p-1040, 0x1p1000}) {
    const Built built(scaled(box({0, 0, 0}, {1, 2, 3}, 2), scale));
    EXPECT_EQ(built.topology.facet_triangles.size(), 6U) << scale;
    EXPECT_EQ(built.topology.plane_count, 6U) << scale;
    for (FacetId f = 0; f < 6; ++f) {
      EXPECT_EQ(built.topology.facet_axis[f], static_cast<int>(f / 2));
    }
  }
}

}  // namespace
}  // namespace delmesher::surface
