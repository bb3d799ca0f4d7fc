#include "mesher/chamfer/filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesher/chamfer/closest.h"
#include "mesher/chamfer/test_model.h"
#include "mesher/chamfer/test_plc_angles.h"
#include "mesher/chamfer/test_polyhedra.h"
#include "mesher/geometry/vector.h"
#include "mesher/surface/feature_size.h"

namespace delmesher::chamfer::filter_test {
namespace {

using test_polyhedra::Sample;

Surface joined(Surface a, const Surface& b, const std::array<double, 3>& offset) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  for (const auto& v : b.vertices) {
    a.vertices.push_back({v[0] + offset[0], v[1] + offset[1], v[2] + offset[2]});
  }
  for (const auto& t : b.triangles) {
    a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return a;
}

Surface block(std::int64_t x, std::int64_t y, std::int64_t z) {
  return test_polyhedra::prism({{0, 0}, {x, 0}, {x, y}, {0, y}}, z);
}

// The smallest distance between kept elements without a common point, by comparing all: vertices
// and constrained edges of kept facets, and their triangles. Edges count with their own length.
double smallest_feature(const SurfaceTopology& t, const PointStore& points,
                        const std::vector<std::uint8_t>& kept) {
  struct Edge {
    VertexId a, b;
  };
  std::vector<Edge> edges;
  std::vector<std::uint8_t> alive(t.vertex_half_edge.size());
  for (std::uint32_t e = 0; e < t.edge_count(); ++e) {
    const auto [h, g] = t.edge_half_edges(e);
    if (t.edge_is_flat[e] || (!kept[t.facet_of_half_edge(h)] && !kept[t.facet_of_half_edge(g)])) {
      continue;
    }
    edges.push_back({t.from(h), t.to(h)});
    alive[t.from(h)] = alive[t.to(h)] = 1;
  }
  double best = HUGE_VAL;
  for (const Edge& e : edges) {
    const Vec3 a = points.nearest(e.a), b = points.nearest(e.b);
    best = std::min(best, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    for (const Edge& f : edges) {
      const bool touch = e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b;
      if (touch) continue;
      best =
          std::min(best, segment_segment_distance(a, b, points.nearest(f.a), points.nearest(f.b)));
    }
    for (VertexId v = 0; v < alive.size(); ++v) {
      if (!alive[v] || v == e.a || v == e.b) continue;
      best = std::min(best, point_segment_distance(points.nearest(v), a, b));
    }
  }
  for (VertexId v = 0; v < alive.size(); ++v) {
    if (!alive[v]) continue;
    std::vector<std::uint8_t> incident(t.facet_triangles.size());
    for (std::uint32_t h = 0; h < t.opposite.size(); ++h) {
      if (t.from(h) == v) incident[t.facet_of_half_edge(h)] = 1;
    }
    for (std::uint32_t k = 0; k < t.triangles.size(); ++k) {
      if (!kept[t.facet_of[k]] || incident[t.facet_of[k]]) continue;
      std::array<Vec3, 3> corner;
      for (int i = 0; i < 3; ++i) corner[i] = points.nearest(t.triangles[k][i]);
      best = std::min(best, point_triangle_distance(points.nearest(v), corner));
    }
  }
  return best;
}

std::vector<Sample> cases() {
  std::vector<Sample> result = test_polyhedra::samples();
  result.push_back({"thin slab", block(1000, 1000, 3)});
  result.push_back({"rod", block(3, 3, 1000)});
  result.push_back(
      {"two blocks", joined(block(500, 500, 500), block(500, 500, 500), {502, 100, 50})});
  result.push_back({"speck", joined(block(500, 500, 500), block(1, 2, 1), {700, 100, 50})});
  Surface swarm = block(300, 300, 300);
  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    swarm = joined(swarm, block(3 + random() % 20, 3 + random() % 20, 2 + random() % 20),
                   {310.0 + 40 * (i % 5), 30.0 * static_cast<double>(random() % 3), 25.0 * i});
  }
  result.push_back({"swarm", swarm});
  // Acute edges between acute vertices: rounds of the second step change their neighbours.
  std::uniform_int_distribution<std::int64_t> narrow(-100, 100);
  for (int i = 0; i < 40; ++i) {
    test_polyhedra::Polygon base;
    for (int k = 0; k < 10; ++k) {
      const double angle = k * 3.14159265358979323846 / 5;
      const double radius = 1000.0 + static_cast<double>(random() % 1000) * (k % 2);
      base.push_back(
          {std::llround(radius * std::cos(angle)), std::llround(radius * std::sin(angle))});
    }
    result.push_back(
        {"pyramid " + std::to_string(i),
         test_polyhedra::pyramid(base, {narrow(random), narrow(random), 50 + i * 10})});
  }
  return result;
}

// Calls test(model, tolerance) for every case with three tolerances.
template <class Test>
void for_each_case(Test test) {
  for (const Sample& sample : cases()) {
    for (double tolerance : {0.5, 5.0, 60.0}) {
      SCOPED_TRACE(sample.name + " " + std::to_string(tolerance));
      Model model(sample.surface);
      test(model, tolerance);
    }
  }
}

// No feature smaller than `least` is left, and nothing is dropped without need.
void expect_filtered(Model& model, double tolerance, double least, const FilterResult& result) {
  const std::vector<std::uint8_t> all(model.topology.facet_triangles.size(), 1);
  const double before = smallest_feature(model.topology, model.points, all);
  const double after = smallest_feature(model.topology, model.points, result.facet_kept);
  EXPECT_GE(after, least);
  EXPECT_EQ(result.dropped_triangles > 0, before < tolerance) << before;
}

TEST(Filter, LeavesNoFeatureBelowTheTolerance) {
  int dropping = 0;
  for_each_case([&](Model& model, double tolerance) {
    const FilterResult result =
        filter_input(model.topology, model.points, tolerance, model.control);
    expect_filtered(model, tolerance, tolerance * (1 - 1e-12), result);
    std::uint64_t dropped = 0;
    for (std::size_t f = 0; f < result.facet_kept.size(); ++f) {
      if (!result.facet_kept[f]) dropped += model.topology.facet_triangles[f].size();
    }
    EXPECT_EQ(dropped, result.dropped_triangles);
    dropping += dropped > 0;
  });
  EXPECT_GT(dropping, 40);
}

TEST(Filter, ThinSlabLosesOneSideOnly) {
  Model model(block(1000, 1000, 3));
  const FilterResult result = filter_input(model.topology, model.points, 5, model.control);
  // The four narrow sides and one of the two large ones.
  EXPECT_EQ(result.dropped_triangles, 10U);
}

TEST(Filter, NoDominoEffect) {
  // A hundred plates in a row, each closer to the next than the tolerance: every second may stay.
  Surface stack = block(1000, 1000, 100);
  for (int i = 1; i < 20; ++i) stack = joined(stack, block(1000, 1000, 100), {0, 0, 102.0 * i});
  Model model(stack);
  const FilterResult result = filter_input(model.topology, model.points, 5, model.control);
  // The 19 gaps cost one plate's side each, and the vertices and edges on it: not more than half
  // of the sides around it.
  EXPECT_LE(result.dropped_triangles, 19U * 10U);
  EXPECT_GE(result.dropped_triangles, 19U * 2U);
}

TEST(Filter, SmallestPartGoes) {
  Model model(joined(block(500, 500, 500), block(20, 20, 20), {502, 100, 50}));
  const FilterResult result = filter_input(model.topology, model.points, 5, model.control);
  for (std::uint32_t t = 0; t < 12; ++t) EXPECT_TRUE(result.facet_kept[model.topology.facet_of[t]]);
  EXPECT_GT(result.dropped_triangles, 0U);
}

ChamferedSurface filter_and_chamfer(Model& model, double tolerance,
                                    double fraction = kChamferedFraction) {
  const FilterOptions filter{.tolerance = tolerance, .chamfered_fraction = fraction};
  FilteredSurface surface(model.topology, model.points, model.predicates, {}, filter,
                          model.control);
  surface.drop_close();
  do surface.chamfer();
  while (surface.drop_small());
  return surface.result();
}

// Distances between the segments of a complex, in doubles.
double smallest_segment_feature(const Plc& plc, const PointStore& points) {
  double best = HUGE_VAL;
  for (std::size_t i = 0; i < plc.segments.size(); ++i) {
    const auto [a, b] = plc.segments[i].vertex;
    const Vec3 p = points.nearest(a), q = points.nearest(b);
    best = std::min(best, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    for (std::size_t j = 0; j < i; ++j) {
      const auto [c, d] = plc.segments[j].vertex;
      if (a == c || a == d || b == c || b == d) continue;
      best = std::min(best, segment_segment_distance(p, q, points.nearest(c), points.nearest(d)));
    }
  }
  return best;
}

// A wedge whose sides are nowhere closer than the tolerance. The gap between the strips cut off
// along its edge is half as wide as that; it fits 2000 times along the edge, or 300 times.
TEST(Filter, OnlyLongGapsBelowTheToleranceGo) {
  constexpr double kTolerance = 2;
  for (const std::int64_t length : {2000, 300}) {
    Model model(test_polyhedra::prism({{0, 0}, {length, 0}, {length, 3}}, length));
    const FilterResult first =
        filter_input(model.topology, model.points, kTolerance, model.control);
    EXPECT_EQ(first.dropped_triangles, 0U);
    const ChamferedSurface chamfered = filter_and_chamfer(model, kTolerance);
    if (length == 2000) {
      EXPECT_GT(chamfered.filter.dropped_triangles, 0U);
    } else {
      EXPECT_EQ(chamfered.filter.dropped_triangles, 0U);
      EXPECT_LT(smallest_segment_feature(chamfered.chamfer.plc, model.points), kTolerance / 1.5);
    }
  }
}

// Both sides of the gap, and the sides of both blocks around it.
TEST(FilterAsPaper, AllSidesOfAClosePairGo) {
  Model slab(block(1000, 1000, 3));
  EXPECT_EQ(filter_all_pairs(slab.topology, slab.points, 5, slab.control).dropped_triangles, 12U);
  Model two(joined(block(500, 500, 500), block(20, 20, 20), {502, 100, 50}));
  const FilterResult result = filter_all_pairs(two.topology, two.points, 5, two.control);
  // The large block's side, and all of the small one's but the one that looks away.
  EXPECT_EQ(result.dropped_triangles, 2U + 10U);
}

TEST(FilterAsPaper, DropsNothingElse) {
  int dropping = 0;
  for_each_case([&](Model& model, double tolerance) {
    const FilterResult result =
        filter_all_pairs(model.topology, model.points, tolerance, model.control);
    const FilterResult one_side =
        filter_input(model.topology, model.points, tolerance, model.control);
    expect_filtered(model, tolerance, tolerance, result);
    EXPECT_GE(result.dropped_triangles, one_side.dropped_triangles);
    dropping += result.dropped_triangles > one_side.dropped_triangles;
  });
  EXPECT_GT(dropping, 20);
}

// A feature that is too small costs both of its sides, so nothing below the tolerance is left.
TEST(FilterAsPaper, ChamferingLeavesNothingBelowTheTolerance) {
  int dropping = 0;
  for (const Sample& sample : cases()) {
    SCOPED_TRACE(sample.name);
    constexpr double kTolerance = 20;
    Model model(sample.surface), other(sample.surface);
    FilteredSurface surface(
        model.topology, model.points, model.predicates, {},
        {.tolerance = kTolerance, .all_pairs = true, .both_sides = true, .chamfered_fraction = 1},
        model.control);
    surface.drop_close();
    do surface.chamfer();
    while (surface.drop_small());
    const ChamferedSurface result = surface.result();
    EXPECT_GE(smallest_segment_feature(result.chamfer.plc, model.points), kTolerance * (1 - 1e-9));
    dropping += result.filter.dropped_triangles >
                filter_and_chamfer(other, kTolerance).filter.dropped_triangles;
  }
  EXPECT_GT(dropping, 5);
}

TEST(Filter, ScalesByPowersOfTwo) {
  for (const Sample& sample : cases()) {
    for (int exponent : {-10, 20, -300, -1015, 1000}) {
      Model model(sample.surface);
      Model other(test_polyhedra::scaled(sample.surface, std::ldexp(1.0, exponent)));
      const FilterResult result = filter_and_chamfer(model, 20).filter;
      const FilterResult same = filter_and_chamfer(other, std::ldexp(20.0, exponent)).filter;
      EXPECT_EQ(result.facet_kept, same.facet_kept) << sample.name;
      EXPECT_EQ(model.points.size(), other.points.size());
    }
  }
}

// Distances of the complex's points to facets they are not on, where they project into them.
double smallest_facet_feature(const Plc& plc, const PointStore& points) {
  double best = HUGE_VAL;
  for (const PlcFacet& facet : plc.facets) {
    const Vec3 o = points.nearest(facet.frame[0]);
    const auto from_o = [&](VertexId v) {
      const Vec3 p = points.nearest(v);
      return plc_angles::Vector{p[0] - o[0], p[1] - o[1], p[2] - o[2]};
    };
    plc_angles::Vector normal = plc_angles::cross(from_o(facet.frame[1]), from_o(facet.frame[2]));
    const double length = std::sqrt(plc_angles::dot(normal, normal));
    for (double& x : normal) x /= length;
    std::vector<std::uint8_t> on_facet(points.size());
    for (const PlcFacet::Side& side : facet.boundary) {
      for (VertexId v : plc.segments[side.segment].vertex) on_facet[v] = 1;
    }
    const int x = (facet.axis + 1) % 3, y = (facet.axis + 2) % 3;
    for (const PlcSegment& segment : plc.segments) {
      for (VertexId v : segment.vertex) {
        if (on_facet[v]) continue;
        plc_angles::Vector p = from_o(v);
        const double height = plc_angles::dot(p, normal);
        for (int i = 0; i < 3; ++i) p[i] -= height * normal[i];
        bool inside = false;
        for (const PlcFacet::Side& side : facet.boundary) {
          const auto a = from_o(plc.segments[side.segment].vertex[0]);
          const auto b = from_o(plc.segments[side.segment].vertex[1]);
          if ((a[y] > p[y]) == (b[y] > p[y])) continue;
          inside ^= p[x] < a[x] + (b[x] - a[x]) * (p[y] - a[y]) / (b[y] - a[y]);
        }
        if (inside) best = std::min(best, std::abs(height));
      }
    }
  }
  return best;
}

TEST(Filter, ChamferedFeaturesAreNotBelowTheirTolerance) {
  int second_step = 0;
  for (const Sample& sample : cases()) {
    for (double tolerance : {5.0, 60.0}) {
      for (double fraction : {0.0625, 1.0}) {
        SCOPED_TRACE(sample.name + " " + std::to_string(tolerance));
        Model model(sample.surface);
        const FilterResult first =
            filter_input(model.topology, model.points, tolerance, model.control);
        const ChamferedSurface chamfered = filter_and_chamfer(model, tolerance, fraction);
        const FilterResult& both = chamfered.filter;
        const ChamferResult& result = chamfered.chamfer;
        EXPECT_GE(smallest_segment_feature(result.plc, model.points),
                  fraction * tolerance * (1 - 1e-9));
        EXPECT_GE(smallest_facet_feature(result.plc, model.points),
                  fraction * tolerance * (1 - 1e-9));
        second_step += both.dropped_triangles > first.dropped_triangles;
        // Facets dropped by the first step stay dropped, and no rejected point is left.
        for (std::size_t f = 0; f < first.facet_kept.size(); ++f) {
          EXPECT_LE(both.facet_kept[f], first.facet_kept[f]);
          EXPECT_EQ(both.facet_kept[f] != 0, result.plc_facet[f] != kNone);
        }
        EXPECT_EQ(model.points.size(),
                  sample.surface.vertices.size() + result.new_point_vertex.size());
        const plc_angles::Report report = plc_angles::measure(result.plc, model.points);
        EXPECT_EQ(report.defect, "");
        EXPECT_GE(report.smallest(), 60 - 1e-3);
      }
    }
  }
  EXPECT_GT(second_step, 20);
}

// Where the nearest point is an end, the distance is that of this end, to the last digit.
TEST(Closest, AtTheEndsOfASegmentIsTheEnd) {
  const auto squared = [](const Vec3& p, const Vec3& q) {
    const Vec3 d = subtract(p, q);
    return dot(d, d);
  };
  for (const double x : {0.1, 0.3, 0.7, 1.1, 3.3}) {
    for (const double y : {0.1, 0.2, 0.3, 0.6, 0.7}) {
      const Vec3 a = {0, 0, 0}, b = {x, 0, 0};
      // Over the ends themselves, and beyond them.
      for (const Vec3& p : {Vec3{0, y, 0}, Vec3{0, y, 2 * y}, Vec3{-y, y, 0}}) {
        const ClosestOnSegment there = closest_on_segment(p, a, b);
        EXPECT_EQ(there.squared_distance, squared(p, a));
        EXPECT_EQ(there.s, 0);
      }
      for (const Vec3& p : {Vec3{x, y, 0}, Vec3{x, y, 2 * y}, Vec3{x + y, y, 0}}) {
        const ClosestOnSegment there = closest_on_segment(p, a, b);
        EXPECT_EQ(there.squared_distance, squared(p, b));
        EXPECT_EQ(there.s, 1);
      }
      const ClosestOnSegment middle = closest_on_segment({0.5 * x, y, 0}, a, b);
      EXPECT_DOUBLE_EQ(middle.squared_distance, y * y);
      EXPECT_DOUBLE_EQ(middle.s, 0.5);
    }
  }
}

TEST(Filter, NoToleranceNoFilter) {
  Model model(block(1000, 1000, 3));
  const FilterResult result = filter_and_chamfer(model, 0).filter;
  EXPECT_EQ(result.dropped_triangles, 0U);
  EXPECT_EQ(result.facet_kept, std::vector<std::uint8_t>(6, 1));
}

// Over parallel segments the length divided by the distance; from the tip of a wedge a logarithm.
TEST(Closest, GapsAreMeasuredInTheirOwnWidth) {
  const Vec3 a = {0, 0.5, 0}, b = {100, 0.5, 0}, c = {-10, 0, 0}, d = {110, 0, 0};
  EXPECT_NEAR(length_of_gap(a, b, 0.3, c, d, 1e9), 200, 1e-9);
  EXPECT_NEAR(length_of_gap(a, b, 0.3, c, d, 50), 50, 1);
  const Vec3 near = {1, 0.01, 0}, far = {10, 0.1, 0};
  const double whole = 100 * std::hypot(1, 0.01) * std::log(10);
  EXPECT_NEAR(length_of_gap(near, far, 0, c, d, 1e9), whole, 0.01 * whole);
  EXPECT_NEAR(length_of_gap(far, near, 1, c, d, 1e9), whole, 0.01 * whole);
}

}  // namespace
}  // namespace delmesher::chamfer::filter_test
