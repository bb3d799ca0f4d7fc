// The bridges and strips of chamfering: their angles, and how they are when as the paper has them.
#include "mesher/chamfer/bridges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesher/chamfer/assemble.h"
#include "mesher/chamfer/test_model.h"
#include "mesher/chamfer/test_outline.h"
#include "mesher/chamfer/test_plc_angles.h"
#include "mesher/chamfer/test_polyhedra.h"
#include "mesher/surface/feature_size.h"

namespace delmesher::chamfer {
namespace {

using plc_angles::degrees;
using plc_angles::measure;
using plc_angles::position;
using plc_angles::Report;
using test_polyhedra::Sample;

// Rounding of points to 2^-20 of the bridges, in degrees.
constexpr double kRounding = 1e-3;

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

ChamferOptions as_paper(bool link, bool bridges) {
  ChamferOptions options = below(90);
  options.link_distances = link || bridges;
  options.bridge_per_triangle = bridges;
  return options;
}

// Section 4.1: the link of a vertex are the edges of its triangles that it is not on.
TEST(AsPaper, ChamfersReachAThirdOfTheWayToTheLink) {
  int nearer = 0;
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    Model model(sample.surface), other(sample.surface);
    const ChamferResult result = model.run(as_paper(true, false));
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
    const ChamferOptions options = as_paper(true, true);
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

// Each choice leaves no acute angle and simple outlines, as the default.
TEST(AsPaper, NoAngleIsLeftBelowTheThreshold) {
  for (const Sample& sample : test_polyhedra::samples()) {
    SCOPED_TRACE(sample.name);
    for (const ChamferOptions& options : {as_paper(true, false), as_paper(true, true)}) {
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

}  // namespace
}  // namespace delmesher::chamfer
