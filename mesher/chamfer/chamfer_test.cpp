#include "mesher/chamfer/chamfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "mesher/chamfer/chamfer_surface.h"
#include "mesher/chamfer/test_model.h"
#include "mesher/chamfer/test_outline.h"
#include "mesher/chamfer/test_plc_angles.h"
#include "mesher/chamfer/test_polyhedra.h"
#include "mesher/surface/validity.h"

namespace delmesher::chamfer::chamfer_test {
namespace {

using plc_angles::measure;
using plc_angles::Report;
using test_polyhedra::Sample;

// Rounding of points to 2^-20 of the bridges, in degrees.
constexpr double kRounding = 1e-3;

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

// Edges that bound no common facet have that threshold, too: every other edge of a low pyramid, 58
// degrees apart where neighbours are 30.
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
      // The exact test for acute corners agrees with the measured angles.
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

// A cut point is as far from its vertex along the edge as the chamfer distance says, except for the
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

// The filter's local rounds rely on this.
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
      const Acuteness acute =
          find_acute(surface, part.predicates, Thresholds(options), active, part.control);
      const ChamferResult local = chamfer_surface(surface, acute, part.points, part.predicates,
                                                  options, active, part.control);
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
}  // namespace delmesher::chamfer::chamfer_test
