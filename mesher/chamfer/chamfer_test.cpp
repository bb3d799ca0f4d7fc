#include "mesher/chamfer/chamfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <tuple>

#include "mesher/chamfer/assemble.h"
#include "mesher/chamfer/chamfer_surface.h"
#include "mesher/chamfer/test_model.h"
#include "mesher/chamfer/test_plc_angles.h"
#include "mesher/chamfer/test_polyhedra.h"
#include "mesher/surface/feature_size.h"
#include "mesher/surface/validity.h"

namespace delmesher::chamfer {
namespace {

using plc_angles::degrees;
using plc_angles::measure;
using plc_angles::position;
using plc_angles::Report;
using test_polyhedra::Sample;

// Rounding of points to 2^-20 of the bridges, in degrees.
constexpr double kRounding = 1e-3;

std::array<double, 2> flat(const PlcFacet& facet, const plc_angles::QuadPoint& p) {
  const int x = (facet.axis + 1) % 3, y = (facet.axis + 2) % 3;
  return {static_cast<double>(p[x]), facet.axis_sign * static_cast<double>(p[y])};
}

double turn(const std::array<double, 2>& a, const std::array<double, 2>& b,
            const std::array<double, 2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

struct Outline {
  double area = 0;
  int crossings = 0;
};

// Signed area inside a facet's boundary, and the number of pairs of sides that cross.
Outline outline(const Plc& plc, const PlcFacet& facet, const PointStore& points) {
  std::vector<std::array<std::array<double, 2>, 2>> sides;
  Outline result;
  const auto origin = position(points, facet.frame[0]);
  for (const PlcFacet::Side& side : facet.boundary) {
    auto v = plc.segments[side.segment].vertex;
    if (side.reversed) std::swap(v[0], v[1]);
    std::array<std::array<double, 2>, 2> ends;
    for (int k = 0; k < 2; ++k) {
      auto p = position(points, v[k]);
      for (int i = 0; i < 3; ++i) p[i] -= origin[i];
      ends[k] = flat(facet, p);
    }
    result.area += 0.5 * (ends[0][0] * ends[1][1] - ends[0][1] * ends[1][0]);
    sides.push_back(ends);
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto &a = sides[i][0], &b = sides[i][1], &c = sides[j][0], &d = sides[j][1];
      if (a == c || a == d || b == c || b == d) continue;
      result.crossings += turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
    }
  }
  return result;
}

// A pyramid on a prism: its faces have corners of 43.6 and 95.9 degrees at the apex, vertex 8,
// where nothing else is acute.
TEST(Corners, OfOneFacetHaveAThresholdOfTheirOwn) {
  Surface surface = test_polyhedra::prism({{0, 0}, {8, 0}, {8, 4}, {0, 4}}, 6);
  std::erase_if(surface.triangles, [&](const auto& t) {
    return std::ranges::all_of(t, [&](std::uint32_t v) { return surface.vertices[v][2] == 6; });
  });
  surface.vertices.push_back({4, 2, 9});
  for (std::uint32_t i = 0; i < 4; ++i) surface.triangles.push_back({4 + i, 4 + (i + 1) % 4, 8});
  const auto acute = [&](double angle, double corner) {
    ChamferOptions options = below(angle);
    options.corner_cosine_squared = cosine_squared(corner);
    Model model(surface);
    const ChamferResult result = model.run(options);
    return std::pair(result.vertex_is_acute[8] != 0, result.vertex_is_apex[8] != 0);
  };
  EXPECT_EQ(acute(45, 45), std::pair(true, false));
  EXPECT_EQ(acute(45, 44), std::pair(true, false));
  EXPECT_EQ(acute(45, 40), std::pair(false, true));
  EXPECT_EQ(acute(40, 30), std::pair(false, false));
}

// So have edges that bound no common facet: every other edge of a low pyramid, 58 degrees apart
// where neighbours are 30.
TEST(Corners, OfDifferentFacetsHaveItToo) {
  const test_polyhedra::Polygon base = {{20, 0},    {17, 10},  {10, 17},  {0, 20},
                                        {-10, 17},  {-17, 10}, {-20, 0},  {-17, -10},
                                        {-10, -17}, {0, -20},  {10, -17}, {17, -10}};
  const Surface surface = test_polyhedra::pyramid(base, {0, 0, 4});
  const auto acute = [&](double corner) {
    ChamferOptions options = below(60);
    options.corner_cosine_squared = cosine_squared(corner);
    Model model(surface);
    const ChamferResult result = model.run(options);
    return std::pair(result.vertex_is_acute[12] != 0, result.vertex_is_apex[12] != 0);
  };
  EXPECT_EQ(acute(25), std::pair(false, true));
  EXPECT_EQ(acute(35), std::pair(true, false));
}

class ChamferSamples : public testing::TestWithParam<double> {};

TEST_P(ChamferSamples, AreValidSurfaces) {
  for (const Sample& sample : test_polyhedra::samples()) {
    Limits options;
    Control control(options);
    const ValidityResult validity = check_validity(sample.surface, false, control);
    EXPECT_TRUE(validity.report.status.ok()) << sample.name << validity.report.status.message;
    EXPECT_FALSE(validity.report.flipped) << sample.name;
  }
}

TEST_P(ChamferSamples, NoAngleIsLeftBelowTheThreshold) {
  const double threshold = GetParam();
  int acute = 0;
  for (const Sample& sample : test_polyhedra::samples()) {
    for (bool simplify : {false, true}) {
      SCOPED_TRACE(sample.name + (simplify ? " simplified" : ""));
      Model model(sample.surface);
      const double before = measure(model.run(untouched()).plc, model.points).smallest();
      ChamferOptions options = below(threshold);
      options.simplify_bridges = simplify;
      const ChamferResult result = model.run(options);
      const Report report = measure(result.plc, model.points);
      EXPECT_EQ(report.defect, "");
      EXPECT_GE(report.edge_edge.degrees, threshold - kRounding);
      EXPECT_GE(report.edge_facet.degrees, threshold - kRounding);
      EXPECT_GE(report.dihedral.degrees, threshold - kRounding);
      // The exact test of what is acute agrees with the measure.
      EXPECT_EQ(result.acute_vertices > 0, before < threshold - 1e-9) << before;
      acute += result.acute_vertices > 0;
    }
  }
  EXPECT_GT(acute, 100);
}

TEST_P(ChamferSamples, FacetsKeepSimpleOutlines) {
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    Model model(sample.surface);
    const ChamferResult whole = model.run(untouched());
    ChamferOptions options = below(GetParam());
    const ChamferResult simple = model.run(options);
    options.simplify_bridges = false;
    const ChamferResult full = model.run(options);
    ASSERT_EQ(whole.plc.facets.size(), full.plc.facets.size());
    for (std::size_t f = 0; f < whole.plc.facets.size(); ++f) {
      const Outline original = outline(whole.plc, whole.plc.facets[f], model.points);
      const Outline cut = outline(full.plc, full.plc.facets[f], model.points);
      const Outline simplified = outline(simple.plc, simple.plc.facets[f], model.points);
      EXPECT_EQ(original.crossings, 0);
      EXPECT_EQ(cut.crossings, 0);
      EXPECT_EQ(simplified.crossings, 0);
      EXPECT_GT(cut.area, 0);
      const double slack = 1e-9 * original.area;
      EXPECT_LE(cut.area, simplified.area + slack);
      EXPECT_LE(simplified.area, original.area + slack);
    }
  }
}

TEST_P(ChamferSamples, RemovedPartsStayWithinTheRadius) {
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    for (double radius : {0.0, 50.0, 1.0}) {
      Model model(sample.surface);
      ChamferOptions options = below(GetParam());
      options.max_radius = radius;
      const ChamferResult result = model.run(options);
      if (radius == 0) radius = HUGE_VAL;
      for (VertexId v = 0; v < sample.surface.vertices.size(); ++v) {
        EXPECT_LE(result.vertex_radius[v], radius * (1 + 1e-6));
        EXPECT_GE(result.vertex_radius[v], result.vertex_distance[v] * (1 - 1e-6));
        EXPECT_EQ(result.vertex_distance[v] > 0, result.vertex_is_acute[v] != 0);
      }
      for (double r : result.edge_radius) EXPECT_LE(r, radius);
      for (VertexId p = result.first_new_point; p < model.points.size(); ++p) {
        const VertexId v = result.new_point_vertex[p - result.first_new_point];
        const Vec3 a = model.points.nearest(p), b = model.points.nearest(v);
        EXPECT_LE(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]),
                  result.vertex_radius[v] * (1 + 1e-9));
      }
    }
  }
}

// A cut point is as far from its vertex along the edge as the chamfer distance says, but for the
// bits that are saved on its fraction: 2^-20 of it.
TEST_P(ChamferSamples, EdgesAreCutAtTheChamferDistance) {
  std::size_t cut = 0;
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    Model model(sample.surface);
    const ChamferResult result = model.run(below(GetParam()));
    for (VertexId p = result.first_new_point; p < model.points.size(); ++p) {
      if (model.points.definition(p).kind != PointKind::on_segment) continue;
      const VertexId v = result.new_point_vertex[p - result.first_new_point];
      const Vec3 a = model.points.nearest(p), b = model.points.nearest(v);
      const double distance = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
      EXPECT_NEAR(distance / result.vertex_distance[v], 1, 0x1p-20 + 1e-12);
      ++cut;
    }
  }
  EXPECT_GT(cut, 0U);
}

TEST_P(ChamferSamples, EveryNewPointIsUsed) {
  for (const Sample& sample : test_polyhedra::samples()) {
    Model model(sample.surface);
    const ChamferResult result = model.run(below(GetParam()));
    std::set<VertexId> used;
    for (const PlcSegment& s : result.plc.segments) used.insert(s.vertex.begin(), s.vertex.end());
    for (VertexId p = result.first_new_point; p < model.points.size(); ++p) {
      EXPECT_TRUE(used.count(p)) << sample.name;
    }
    EXPECT_EQ(result.first_new_point + result.new_point_vertex.size(), model.points.size());
    EXPECT_EQ(result.first_new_point, sample.surface.vertices.size());
  }
}

TEST_P(ChamferSamples, ScaleByPowersOfTwo) {
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    Model model(sample.surface);
    ChamferOptions options = below(GetParam());
    options.max_radius = 60;
    const ChamferResult result = model.run(options);
    for (int exponent : {-10, 20, -300, 300}) {
      const double factor = std::ldexp(1.0, exponent);
      Model other(test_polyhedra::scaled(sample.surface, factor));
      ChamferOptions scaled = options;
      scaled.max_radius *= factor;
      const ChamferResult same = other.run(scaled);
      ASSERT_EQ(model.points.size(), other.points.size());
      for (VertexId p = result.first_new_point; p < model.points.size(); ++p) {
        const PointDefinition &a = model.points.definition(p), &b = other.points.definition(p);
        EXPECT_EQ(a.kind, b.kind);
        EXPECT_EQ(a.corner, b.corner);
        EXPECT_EQ(a.u, b.u);
        EXPECT_EQ(a.v, b.v);
      }
      ASSERT_EQ(result.plc.segments.size(), same.plc.segments.size());
      for (std::size_t s = 0; s < result.plc.segments.size(); ++s) {
        EXPECT_EQ(result.plc.segments[s].vertex, same.plc.segments[s].vertex);
      }
      for (std::size_t v = 0; v < result.vertex_radius.size(); ++v) {
        EXPECT_EQ(result.vertex_radius[v] * factor, same.vertex_radius[v]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Thresholds, ChamferSamples, testing::Values(45.0, 60.0, 75.0, 90.0));

// Figure 3: joining the split points directly, as naive chamfering does, makes new acute angles.
TEST(Chamfer, NaiveChamferingOfALowSpikeFails) {
  for (double threshold : {60.0, 90.0}) {
    Model model(test_polyhedra::spike(1));
    const ChamferOptions options = below(threshold);
    const KeptSurface surface(model.topology, model.points, {});
    const Thresholds thresholds(options);
    const Acuteness acute = find_acute(surface, model.predicates, thresholds, {}, model.control);
    EXPECT_TRUE(acute.vertex[3]);
    const Cuts cuts = find_cuts(surface, acute, model.predicates, {}, model.control);
    NewPoints new_points(model.topology, model.points);
    Bridges bridges = build_bridges(surface, acute, cuts, thresholds, new_points, model.control);
    for (auto& chain : bridges.chain) {
      if (chain.size() > 2) chain = {chain.front(), chain.back()};
    }
    ChamferResult result;
    result.vertex_radius.assign(5, 0);
    assemble_plc(surface, acute, cuts, bridges, {}, 0, result);
    EXPECT_LT(measure(result.plc, model.points).smallest(), threshold - 1);
  }
}

// Length and angle helpers on exact positions.
plc_angles::Vector away(const PointStore& points, VertexId a, VertexId b) {
  return plc_angles::direction(position(points, a), position(points, b));
}
double length(const PointStore& points, VertexId a, VertexId b) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const auto d = static_cast<double>(position(points, a)[i] - position(points, b)[i]);
    sum += d * d;
  }
  return std::sqrt(sum);
}

// Statement 1 of appendix B, for all corners: right angles at A and B, equal sides, and
// 180 - alpha / 2 at P and Q (alpha: the part of the corner that the bridge spans).
TEST(Chamfer, BridgesHaveTheAnglesOfStatement1) {
  int bridges_seen = 0, wide_seen = 0;
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    Model model(sample.surface);
    const ChamferOptions options = below(90);
    const KeptSurface surface(model.topology, model.points, {});
    const Thresholds thresholds(options);
    // As if no edge were acute, so that no strip is cut.
    Acuteness acute = find_acute(surface, model.predicates, thresholds, {}, model.control);
    acute.edge.assign(acute.edge.size(), 0);
    const Cuts cuts = find_cuts(surface, acute, model.predicates, {}, model.control);
    NewPoints new_points(model.topology, model.points);
    const Bridges bridges =
        build_bridges(surface, acute, cuts, thresholds, new_points, model.control);
    const PointStore& p = model.points;
    for (std::size_t c = 0; c < bridges.chain.size(); ++c) {
      const auto& chain = bridges.chain[c];
      if (chain.empty()) continue;
      ++bridges_seen;
      const Corner& corner = surface.corners()[c];
      const std::size_t parts = cuts.split[c].size();
      ASSERT_EQ(chain.size(), 2 + 2 * parts);
      wide_seen += parts > 1;
      const double part = 2 * std::asin(cuts.split[c].front().half_sine) * 180 / M_PI;
      EXPECT_LE(part, 120 + 1e-6);
      const VertexId v = corner.vertex, a = chain.front(), b = chain.back();
      EXPECT_NEAR(length(p, v, a) / cuts.distance[v] * surface.scale(), 1, 1e-5);
      EXPECT_NEAR(length(p, v, b) / cuts.distance[v] * surface.scale(), 1, 1e-5);
      const double step = length(p, a, chain[1]);
      EXPECT_NEAR(length(p, b, chain[chain.size() - 2]) / step, 1, 1e-4);
      EXPECT_NEAR(length(p, chain[1], chain[2]) / step, 1, 1e-4);
      EXPECT_NEAR(degrees(away(p, a, v), away(p, a, chain[1])), 90, kRounding);
      EXPECT_NEAR(degrees(away(p, b, v), away(p, b, chain[chain.size() - 2])), 90, kRounding);
      // Never below a right angle on the side that stays, exactly.
      EXPECT_LE(model.predicates.dot_sign(model.topology.to(corner.outgoing), a, chain[1]), 0);
      EXPECT_LE(model.predicates.dot_sign(model.topology.from(corner.incoming), b,
                                          chain[chain.size() - 2]),
                0);
      for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
        EXPECT_NEAR(degrees(away(p, chain[i], chain[i - 1]), away(p, chain[i], chain[i + 1])),
                    180 - part / 2, 10 * kRounding);
      }
    }
  }
  EXPECT_GT(bridges_seen, 500);
  EXPECT_GT(wide_seen, 10);
}

// Statement 2: the strip beside an acute edge is a rectangle, with 90 + alpha / 2 beyond its ends
// if the bridge there is whole, and no less than a right angle in any case.
TEST(Chamfer, StripsHaveTheAnglesOfStatement2) {
  int strips = 0;
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    Model model(sample.surface);
    const ChamferOptions options = below(90);
    const KeptSurface surface(model.topology, model.points, {});
    const Thresholds thresholds(options);
    const Acuteness acute = find_acute(surface, model.predicates, thresholds, {}, model.control);
    const Cuts cuts = find_cuts(surface, acute, model.predicates, {}, model.control);
    NewPoints new_points(model.topology, model.points);
    const Bridges bridges =
        build_bridges(surface, acute, cuts, thresholds, new_points, model.control);
    const PointStore& p = model.points;
    for (std::uint32_t c = 0; c < surface.corners().size(); ++c) {
      const Corner& corner = surface.corners()[c];
      if (!acute.edge[model.topology.edge_of[corner.outgoing]]) continue;
      ++strips;
      const auto &here = bridges.chain[c], &there = bridges.chain[corner.next];
      const VertexId v = corner.vertex, w = model.topology.to(corner.outgoing);
      const VertexId p1 = here.front(), p2 = there.back();
      const double height = cuts.height[corner.outgoing];
      EXPECT_GT(height, 0);
      EXPECT_LE(height, cuts.split[c].front().step * cuts.distance[v] * (1 + 1e-9));
      EXPECT_LT(degrees(away(p, v, w), away(p, p1, p2)), kRounding);
      const double tail = length(p, v, w) * cuts.fraction_at_tail(model.topology, corner.outgoing);
      const double slope = degrees(away(p, v, w), away(p, v, p1));
      EXPECT_NEAR(slope, std::atan2(height / surface.scale(), tail) * 180 / M_PI, kRounding);
      const double angle = degrees(away(p, p1, p2), away(p, p1, here[1]));
      EXPECT_GE(angle, 90 - kRounding);
      const double part = 2 * std::asin(cuts.split[c].front().half_sine) * 180 / M_PI;
      if (height == cuts.split[c].front().step * cuts.distance[v] && cuts.split[c].size() > 1) {
        EXPECT_NEAR(angle, 90 + part / 2, 10 * kRounding);
      }
    }
  }
  EXPECT_GT(strips, 100);
}

ChamferOptions as_paper(bool link, bool bridges, bool angles) {
  ChamferOptions options = below(90);
  options.link_distances = link || bridges;
  options.bridge_per_triangle = bridges;
  options.simplify_to_angles = angles;
  return options;
}

// Section 4.1: the link of a vertex are the edges of its triangles that it is not on.
TEST(AsPaper, ChamfersReachAThirdOfTheWayToTheLink) {
  int nearer = 0;
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    Model model(sample.surface), other(sample.surface);
    const ChamferResult result = model.run(as_paper(true, false, false));
    const ChamferResult by_facets = other.run(below(90));
    EXPECT_EQ(result.vertex_is_acute, by_facets.vertex_is_acute);
    std::vector<double> link(result.vertex_distance.size(), HUGE_VAL);
    for (const auto& t : model.topology.triangles) {
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = model.points.nearest(t[(k + 1) % 3]),
                   q = model.points.nearest(t[(k + 2) % 3]);
        link[t[k]] = std::min(link[t[k]], point_segment_distance(model.points.nearest(t[k]), p, q));
      }
    }
    for (VertexId v = 0; v < link.size(); ++v) {
      if (!result.vertex_is_acute[v]) continue;
      EXPECT_NEAR(result.vertex_distance[v] / link[v], 1.0 / 3, 1e-9);
      nearer += link[v] < 2.99 * by_facets.vertex_distance[v];
    }
  }
  EXPECT_GT(nearer, 20);
}

// Section 4.2: around a vertex every triangle has two points of its own, inside it.
TEST(AsPaper, EveryTriangleHasABridge) {
  int flat = 0, wide = 0;
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    Model model(sample.surface);
    const ChamferOptions options = as_paper(true, true, false);
    const KeptSurface surface(model.topology, model.points, {});
    const Thresholds thresholds(options);
    const Acuteness acute = find_acute(surface, model.predicates, thresholds, {}, model.control);
    const Cuts cuts = find_cuts(surface, acute, model.predicates,
                                {.to_link = true, .per_triangle = true}, model.control);
    NewPoints new_points(model.topology, model.points);
    const Bridges bridges =
        build_bridges(surface, acute, cuts, thresholds, new_points, model.control);
    const PointStore& p = model.points;
    for (std::uint32_t c = 0; c < bridges.chain.size(); ++c) {
      const std::vector<VertexId>& chain = bridges.chain[c];
      if (chain.empty()) continue;
      const Corner& corner = surface.corners()[c];
      const std::vector<std::uint32_t> fan = surface.fan(corner);
      const std::size_t first = acute.edge[model.topology.edge_of[corner.outgoing]] ? 0 : 1;
      ASSERT_GE(chain.size(), first + 2 * fan.size());
      flat += fan.size() > 1;
      for (std::size_t n = 0; n < fan.size(); ++n) {
        const std::uint32_t h = fan[fan.size() - 1 - n];
        const VertexId v = corner.vertex, b = model.topology.to(h),
                       d = model.topology.from(SurfaceTopology::previous(h));
        wide += degrees(away(p, v, b), away(p, v, d)) > 120;
        const int axis = model.topology.facet_axis[corner.facet];
        const int sign = model.topology.facet_axis_sign[corner.facet];
        for (const VertexId x : {chain[first + 2 * n], chain[first + 2 * n + 1]}) {
          EXPECT_GT(sign * model.predicates.orient2d(axis, v, b, x), 0);
          EXPECT_GT(sign * model.predicates.orient2d(axis, b, d, x), 0);
          EXPECT_GT(sign * model.predicates.orient2d(axis, d, v, x), 0);
        }
      }
    }
  }
  EXPECT_GT(flat, 100);
  EXPECT_GT(wide, 10);
}

// Section 4.4, and that each choice leaves no acute angle and simple outlines, as the default.
TEST(AsPaper, SimplificationStopsAtAnglesAlone) {
  std::size_t points = 0, fewer = 0;
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    Model model(sample.surface), other(sample.surface);
    model.run(as_paper(false, false, true));
    other.run(below(90));
    points += other.points.size();
    fewer += model.points.size();
  }
  EXPECT_LT(fewer, points);
}

TEST(AsPaper, NoAngleIsLeftBelowTheThreshold) {
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    for (const ChamferOptions& options :
         {as_paper(true, false, false), as_paper(true, true, false), as_paper(true, true, true),
          as_paper(false, false, true)}) {
      Model model(sample.surface);
      const ChamferResult result = model.run(options);
      const Report report = measure(result.plc, model.points);
      EXPECT_EQ(report.defect, "");
      EXPECT_GE(report.smallest(), 90 - kRounding);
      for (const PlcFacet& facet : result.plc.facets) {
        EXPECT_EQ(outline(result.plc, facet, model.points).crossings, 0);
      }
    }
  }
}

// What the filter's local rounds rely on.
TEST(Chamfer, APartIsChamferedLikeTheWhole) {
  const auto points_of = [](const Model& model, const ChamferResult& result, VertexId v) {
    std::vector<std::tuple<std::array<VertexId, 3>, double, double>> list;
    for (VertexId p = result.first_new_point; p < model.points.size(); ++p) {
      if (result.new_point_vertex[p - result.first_new_point] != v) continue;
      const PointDefinition& d = model.points.definition(p);
      list.push_back({d.corner, d.u, d.v});
    }
    return list;
  };
  int compared = 0;
  for (const Sample& sample : test_polyhedra::samples()) {
    Model model(sample.surface), part(sample.surface);
    const ChamferOptions options = below(60);
    const ChamferResult whole = model.run(options);
    const KeptSurface surface(part.topology, part.points, {});
    const std::size_t count = surface.vertex_count();
    for (VertexId v = 0; v < count; ++v) {
      if (!whole.vertex_is_acute[v]) continue;
      std::vector<std::uint8_t> active(count);
      for (std::uint32_t e = 0; e < part.topology.edge_count(); ++e) {
        const auto [a, b] = part.topology.edge_vertices(e);
        if (a == v || b == v) active[a] = active[b] = 1;
      }
      const ChamferResult local =
          chamfer_surface(surface, part.points, part.predicates, options, active, part.control);
      EXPECT_EQ(points_of(model, whole, v), points_of(part, local, v)) << sample.name;
      part.points.truncate(count);
      compared += std::count(active.begin(), active.end(), 0) > 0;
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(Chamfer, NothingIsDoneWhereNothingIsAcute) {
  Model model(test_polyhedra::samples()[0].surface);  // a cube
  const ChamferResult result = model.run(below(90));
  EXPECT_EQ(result.acute_vertices + result.acute_edges, 0U);
  EXPECT_EQ(result.plc.segments.size(), 12U);
  EXPECT_EQ(result.plc.facets.size(), 6U);
  EXPECT_EQ(model.points.size(), 8U);
}

TEST(Chamfer, DroppedFacetsLeaveTheEdgesOfTheOthers) {
  Model model(test_polyhedra::samples()[0].surface);
  ChamferOptions options = below(60);
  options.facet_kept.assign(6, 1);
  options.facet_kept[0] = 0;
  EXPECT_EQ(model.run(options).plc.segments.size(), 12U);
  for (FacetId f = 0; f < 6; ++f) {
    options.facet_kept.assign(6, 0);
    options.facet_kept[f] = 1;
    const ChamferResult one = model.run(options);
    EXPECT_EQ(one.plc.segments.size(), 4U);
    EXPECT_EQ(one.plc.facets.size(), 1U);
    EXPECT_EQ(one.plc_facet[f], 0U);
  }
  options.facet_kept.assign(6, 0);
  EXPECT_TRUE(model.run(options).plc.segments.empty());
}

TEST(Chamfer, ADroppedFacetMakesNoEdgeAcute) {
  Model model(test_polyhedra::tetrahedron({{{0, 0, 0}, {1000, 0, 0}, {0, 1000, 0}, {0, 0, 1000}}}));
  ChamferOptions options = below(60);
  EXPECT_EQ(model.run(options).acute_edges, 3U);
  model.points.truncate(4);
  // Opposite to vertex 0: the facet with the three acute edges.
  options.facet_kept = {0, 1, 1, 1};
  const ChamferResult result = model.run(options);
  EXPECT_EQ(result.acute_edges, 0U);
  EXPECT_EQ(measure(result.plc, model.points).defect, "");
}

TEST(Chamfer, AVertexMayHaveItsOwnThreshold) {
  // A prism over a triangle with angles of 45, 45 and 90 degrees, all edges at 90 else.
  const Surface surface = test_polyhedra::prism({{0, 0}, {1000, 0}, {0, 1000}}, 700);
  Model model(surface);
  ChamferOptions options = below(40);
  EXPECT_EQ(model.run(options).acute_vertices, 0U);
  options.vertex_cosine_squared.assign(6, options.cosine_squared);
  options.vertex_cosine_squared[1] = 0;
  const ChamferResult result = model.run(options);
  // The vertical edge at vertex 1 is acute by the stricter threshold, and so its other end.
  EXPECT_EQ(result.acute_edges, 1U);
  EXPECT_EQ(result.vertex_is_acute, (std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0}));
}

TEST(Chamfer, FlatVerticesAreIsolatedUnlessNearAChamfer) {
  // A tetrahedron whose bottom is a fan around an inner vertex, once central, once at a corner.
  for (bool central : {true, false}) {
    const double x = central ? 330 : 10;
    Surface s;
    s.vertices = {{0, 0, 0}, {1000, 0, 0}, {0, 1000, 0}, {300, 300, 700}, {x, x, 0}};
    s.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}};
    Model model(s);
    EXPECT_EQ(model.topology.facet_triangles.size(), 4U);
    const ChamferResult result = model.run(below(60));
    EXPECT_TRUE(result.vertex_is_acute[0]);
    const PlcFacet& bottom = result.plc.facets[result.plc_facet[model.topology.facet_of[3]]];
    EXPECT_EQ(bottom.isolated, central ? std::vector<VertexId>{4} : std::vector<VertexId>{});
    ChamferOptions options = below(60);
    options.isolated_clearance = 300;
    const ChamferResult sparse = model.run(options);
    EXPECT_TRUE(sparse.plc.facets[sparse.plc_facet[model.topology.facet_of[3]]].isolated.empty());
  }
}

// Points are placed to about 2^-20 of their bridges, and take few more bits than that asks for: an
// interval of a relative width of 2^-b has a number of b + 1 bits in it.
TEST(Chamfer, ParametersAreShort) {
  Model model(test_polyhedra::prism({{0, 0}, {20, 0}, {0, 12}}, 16));
  const ChamferResult result = model.run(below(60));
  ASSERT_GT(model.points.size(), result.first_new_point);
  int on_segments = 0, on_triangles = 0;
  for (VertexId p = result.first_new_point; p < model.points.size(); ++p) {
    const PointDefinition& d = model.points.definition(p);
    (d.kind == PointKind::on_segment ? on_segments : on_triangles) += 1;
    for (const double x : {d.u, d.v}) {
      int exponent = 0;
      const double digits = std::ldexp(std::frexp(x, &exponent), 30);
      EXPECT_EQ(digits, std::floor(digits)) << x << " of point " << p << " has more than 30 bits";
    }
  }
  EXPECT_GT(on_segments, 0);
  EXPECT_GT(on_triangles, 0);
}

}  // namespace
}  // namespace delmesher::chamfer
