// Laws of single stages, each against a judge that shares no code with it: Delaunay against CGAL's,
// chamfering against the paper's statements, refinement on the paper's Figure 8.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "mesher/base/control.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/delmesher.h"
#include "oracles/cgal/kernel_opinion.h"
#include "oracles/mesh/angles.h"
#include "oracles/mesh/delaunay.h"
#include "oracles/record/chamfer.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::stage_test {
namespace {

using delmesher::Options;
using delmesher::Result;
using delmesher::Surface;
using oracles::Index;
using oracles::Position;
using oracles::Tet;
using oracles::VerifyReport;

constexpr std::uint64_t kSeed = 20261124;
constexpr double kDegrees = 180 / 3.14159265358979323846;

// ------------------------------------------------------------------------------------- Delaunay

std::vector<Tet> our_delaunay(const std::vector<Position>& points) {
  delmesher::predicates::PointStore store;
  std::vector<delmesher::base::VertexId> vertices;
  for (const Position& p : points) vertices.push_back(store.add_explicit(p[0], p[1], p[2]));
  delmesher::predicates::Predicates predicates(store);
  delmesher::delaunay::Tetrahedrization dt(predicates);
  const Options options;
  delmesher::base::Control control(options);
  dt.build(vertices, control);
  dt.validate(true);  // throws
  std::vector<Tet> tets;
  for (delmesher::base::TetId t = 0; t < dt.capacity(); ++t) {
    if (!dt.alive(t) || dt.is_ghost(t)) continue;
    tets.push_back({dt.vertex(t, 0), dt.vertex(t, 1), dt.vertex(t, 2), dt.vertex(t, 3)});
  }
  return tets;
}

std::vector<Tet> canonical(std::vector<Tet> tets) {
  for (Tet& t : tets) std::sort(t.begin(), t.end());
  std::sort(tets.begin(), tets.end());
  return tets;
}

TEST(DelaunayStage, IsThatOfCgalWhereNothingIsCospherical) {
  std::mt19937_64 random(kSeed);
  for (int n = 0; n < samples::iterations(3); ++n) {
    std::vector<Position> points(300 + 400 * (n % 3));
    for (Position& p : points) {
      for (double& x : p) x = static_cast<double>(random() >> 11) * 0x1p-53 - 0.25;
      if (n % 2 == 1) p[2] *= 0x1p-20;  // nearly flat
    }
    const std::vector<Tet> ours = canonical(our_delaunay(points));
    EXPECT_GT(ours.size(), points.size());
    EXPECT_EQ(ours, canonical(oracles::cgal_delaunay(points)));
  }
}

// With ties any choice is Delaunay, and both fill the hull.
TEST(DelaunayStage, IsDelaunayAndFillsTheHullWhereManyAreCospherical) {
  std::vector<Position> points;
  for (int i = 0; i < 125; ++i) {
    points.push_back({i % 5 * 0.1, i / 5 % 5 * 0.1, i / 25 * 0.1});
  }
  oracles::ExactPoints exact;
  exact.assign(points);
  oracles::ExactSum volumes[2];
  int which = 0;
  for (const std::vector<Tet>& tets : {our_delaunay(points), oracles::cgal_delaunay(points)}) {
    oracles::TetComplex complex{&exact, tets, {}, 0, static_cast<Index>(points.size())};
    oracles::Neighbours neighbours;
    EXPECT_TRUE(check_complex(complex, neighbours).passed());
    EXPECT_TRUE(check_orientation(complex).passed());
    const oracles::OracleReport report = check_delaunay(complex, neighbours);
    EXPECT_TRUE(report.passed());
    EXPECT_GT(report.checked, 400U);
    for (const auto& [a, b, c, d] : tets) {
      volumes[which] += oracles::exact::volume6(exact, a, b, c, d);
    }
    ++which;
  }
  EXPECT_TRUE(volumes[0] == volumes[1]);
}

// ------------------------------------------------------------------------------------ chamfering

// Figure 3: a triangle split in three, its split point P lifted a little over the plane.
Surface figure_3() {
  Surface s;
  s.vertices = {{-1, -0.75, 0}, {1, -0.75, 0}, {0, 1, 0}, {0, 0, 0.0625}};
  s.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return s;
}

// The chamfer angles of a record, as the oracle sees them.
oracles::OracleReport chamfer_angles(const Surface& surface, const delmesher::ExactRecord& record) {
  oracles::ExactPoints points;
  EXPECT_EQ(points.assign(record.points), "");
  oracles::InputSurface input;
  EXPECT_EQ(input.assign(samples::to_polyhedron(surface), points), "");
  const oracles::TetComplex complex{&points, {}, {}, 0, 0};
  const oracles::Neighbours neighbours;
  return oracles::check_chamfer_angles({&record, &points, &input, &complex, &neighbours});
}

// The naive chamfer of section 4.1 at P alone: the three edges at P are cut at one distance, and
// the cut points joined. The record has only the surroundings of the hole.
delmesher::ExactRecord naive_chamfer(const Surface& surface, double share) {
  delmesher::ExactRecord r;
  r.parameters.acute = 90;
  r.points = oracles::explicit_points(surface.vertices);
  for (std::uint32_t corner = 0; corner < 3; ++corner) {  // points 4, 5, 6
    const auto &p = surface.vertices[3], &q = surface.vertices[corner];
    const double length = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
    r.points.push_back(
        {delmesher::ExactPoint::Kind::on_segment, corner, 3, 0, share / length, 0, 0});
    r.chamfer_points.push_back({4 + corner, 3});
  }
  r.corners = {{3, share}};
  r.facets = {{0, 0, false, {0}}, {1, 0, false, {1}}, {2, 0, false, {2}}, {3, 0, false, {3}}};
  const std::array<std::array<std::uint32_t, 2>, 3> bases = {{{0, 1}, {1, 2}, {2, 0}}};
  for (std::uint32_t f = 0; f < 3; ++f) {
    const auto [a, b] = bases[f];
    r.segments.push_back({true, f + 1, {4 + b, 4 + a}});
    r.refined_facets.push_back({a, b, 4 + b, f + 1});
    r.refined_facets.push_back({a, 4 + b, 4 + a, f + 1});
    r.segments.push_back({false, 0, {a, 4 + a}});
  }
  return r;
}

TEST(Figure3, NaiveChamferingLeavesAcuteAnglesAtTheHole) {
  const Surface surface = figure_3();
  const oracles::OracleReport report = chamfer_angles(surface, naive_chamfer(surface, 0.125));
  EXPECT_GT(report.checked, 10U);
  EXPECT_GE(report.violations, 3U);
  // The hole is a nearly equilateral triangle.
  EXPECT_NEAR(report.figure("smallest angle").value(), 60, 15);
}

// Chamfers all that is acute, and drops nothing.
Options every_corner(bool simplify_bridges) {
  Options options = samples::split_surface();
  options.acute = options.corner = 90;
  options.tau = 0;
  options.want_exact = true;
  options.simplify_bridges = simplify_bridges;
  return options;
}

TEST(Figure3, OrthogonalChamferingLeavesNone) {
  for (const bool simplify : {false, true}) {
    const Options options = every_corner(simplify);
    const Surface surface = figure_3();
    const Result result = delmesher::tetrahedralize(surface, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    const oracles::OracleReport report = chamfer_angles(surface, result.exact);
    EXPECT_TRUE(report.passed()) << report.findings[0];
    EXPECT_GT(report.checked, 20U);
    EXPECT_LE(report.figure("largest shortfall in degrees").value(), 1e-3);
  }
}

// Appendix B, statement 1: of the pentagon V A P Q B with right angles at A and B, |VA| = |VB| and
// |AP| = |PQ| = |QB|, the angles at P and Q facing V are 180 - alpha / 2, those that remain in the
// chamfered triangle 180 + alpha / 2.
TEST(AppendixB, Statement1AnglesOfTheBridge) {
  int checked = 0;
  for (double alpha = 1; alpha < 180; alpha += 7) {
    const double half = alpha / 2 / kDegrees;
    // With |VA| = 1: P is sin(half) - s cos(half) off the bisector, and that is s / 2.
    const double s = std::sin(half) / (0.5 + std::cos(half));
    const double a[2] = {std::cos(half), std::sin(half)};
    const double p[2] = {a[0] + s * std::sin(half), a[1] - s * std::cos(half)};
    const double q[2] = {p[0], -p[1]};
    EXPECT_NEAR(p[1], s / 2, 1e-12);
    const double angle =
        std::acos(((a[0] - p[0]) * (q[0] - p[0]) + (a[1] - p[1]) * (q[1] - p[1])) / (s * s));
    EXPECT_NEAR(angle * kDegrees, 180 - alpha / 2, 1e-6) << alpha;
    EXPECT_GT(360 - angle * kDegrees, 180);  // what remains outside the pentagon
    ++checked;
  }
  EXPECT_GT(checked, 20);
}

double angle_at(const oracles::ExactPoints& points, Index apex, Index p, Index q) {
  const auto u = oracles::exact::difference(points, apex, p);
  const auto v = oracles::exact::difference(points, apex, q);
  return oracles::exact_angle(oracles::exact::squared(oracles::exact::cross(u, v)),
                              oracles::exact::dot(u, v));
}

// The same of the mesher's own bridges, before they are simplified, where no edge is acute.
TEST(AppendixB, Statement1HoldsOnTheMeshersBridges) {
  // The lifted point is acute, but its edges are not; those of the base are.
  const Surface surface = figure_3();
  const Options options = every_corner(false);
  const Result result = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const delmesher::ExactRecord& r = result.exact;
  oracles::ExactPoints points;
  points.assign(r.points);
  std::vector<std::uint32_t> made_for(r.points.size(), oracles::kNone);
  for (const auto& [point, vertex] : r.chamfer_points) made_for[point] = vertex;
  int right_angles = 0;
  for (const auto& chain : r.segments) {
    if (!chain.artificial) continue;
    // From a cut point A on an edge of V to a bridge point P: orthogonal to the edge.
    for (const bool reverse : {false, true}) {
      const Index a = reverse ? chain.vertices.back() : chain.vertices.front();
      const Index p = reverse ? chain.vertices.front() : chain.vertices.back();
      const bool from_cut = r.points[a].kind == delmesher::ExactPoint::Kind::on_segment;
      const bool to_bridge = r.points[p].kind == delmesher::ExactPoint::Kind::on_triangle;
      if (!from_cut || !to_bridge || made_for[a] == oracles::kNone) continue;
      EXPECT_NEAR(angle_at(points, a, made_for[a], p), 90, 1e-3);
      ++right_angles;
    }
  }
  EXPECT_GE(right_angles, 3) << "the apex has three facets";
}

// Statement 2: edge chamfering removes the rectangle A P P' A' from a facet and leaves an angle of
// 90 + alpha / 2 at P. Here it is asked whether that is at least 90. The wedge has two acute edges,
// of 26.6 degrees; the others are not acute.
TEST(AppendixB, Statement2HoldsOnTheMeshersRectangles) {
  const Surface wedge = samples::triangular_prism({{{0, 0}, {1, 0}, {0.5, 0.25}}}, 0, 1);
  const Options options = every_corner(false);
  const Result result = delmesher::tetrahedralize(wedge, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  ASSERT_EQ(result.statistics.acute_edges, 2U);
  EXPECT_TRUE(chamfer_angles(wedge, result.exact).passed());
  const delmesher::ExactRecord& r = result.exact;
  oracles::ExactPoints points;
  ASSERT_EQ(points.assign(r.points), "");
  std::vector<std::uint32_t> made_for(r.points.size(), oracles::kNone);
  for (const auto& [point, vertex] : r.chamfer_points) made_for[point] = vertex;
  // New edges join the bridges of two different corners within a facet.
  int edges = 0, angles = 0;
  std::vector<std::array<Index, 3>> ends;  // facet, end, other end
  for (const auto& chain : r.segments) {
    if (!chain.artificial) continue;
    ends.push_back({chain.facet, chain.vertices.front(), chain.vertices.back()});
    ends.push_back({chain.facet, chain.vertices.back(), chain.vertices.front()});
  }
  for (const auto& [facet, p, other] : ends) {
    if (made_for[p] == oracles::kNone || made_for[other] == oracles::kNone) continue;
    if (made_for[p] == made_for[other]) continue;
    ++edges;
    for (const auto& [f, q, next] : ends) {
      if (f != facet || q != p || next == other) continue;
      EXPECT_GE(angle_at(points, p, other, next), 90 - 1e-3);
      ++angles;
    }
  }
  EXPECT_GE(edges, 4) << "an acute edge has two facets";
  EXPECT_GE(angles, edges);
}

// --------------------------------------------------------------------------------------- filter

// Two plates over one another are kept from the tolerance on. Below it one of the facets that face
// each other is dropped, and no other.
TEST(FilterStage, DropsWhatIsCloserThanTheToleranceAndNothingElse) {
  for (const double gap : {0x1.01p-8, 0x1p-8, 0x1.fp-9, 0x1p-10}) {
    Surface plates;
    for (const double z : {0.0, 1 + gap}) {
      samples::add_box(plates, {0, 0, z}, {1, 1, z + 1});
    }
    Options options = samples::split_surface();
    options.want_exact = true;
    options.tau = 0x1p-8 / std::sqrt(1 + 1 + (2 + gap) * (2 + gap));
    const Result result = delmesher::tetrahedralize(plates, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    if (gap >= 0x1.01p-8) {
      EXPECT_EQ(result.statistics.dropped_triangles, 0U) << gap;
    } else if (gap < 0x1p-8) {
      EXPECT_GT(result.statistics.dropped_triangles, 0U) << gap;
    }
    VerifyReport report;
    EXPECT_EQ(
        oracles::verify(
            samples::to_polyhedron(plates), samples::to_mesh(result.mesh), &result.exact,
            {.stage = oracles::Stage::both, .promised = oracles::promise_of(options)}, report),
        "");
    EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
    ASSERT_NE(report.find("refined-filter"), nullptr);
    EXPECT_EQ(report.find("refined-filter")->figure("dropped that could return"), 0) << gap;
  }
}

// A sharp wedge loses a side, since the gap between its chamfers is long; its oracle sees why.
TEST(FilterStage, DropsWhatIsBesideALongGap) {
  for (const double length : {2000.0, 300.0}) {
    const Surface wedge =
        samples::triangular_prism({{{0, 0}, {length, 0}, {length, 3}}}, 0, length);
    Options options = samples::split_surface();
    options.want_exact = true;
    options.tau = 2 / std::hypot(length, length, 3);
    const Result result = delmesher::tetrahedralize(wedge, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.statistics.dropped_triangles > 0, length == 2000) << length;
    VerifyReport report;
    EXPECT_EQ(
        oracles::verify(samples::to_polyhedron(wedge), samples::to_mesh(result.mesh), &result.exact,
                        {.stage = oracles::Stage::both, .promised = oracles::promise_of(options)},
                        report),
        "");
    EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
    ASSERT_NE(report.find("refined-filter"), nullptr);
    EXPECT_EQ(
        report.find("refined-filter")->figure("dropped for what chamfering made of them").value() >
            0,
        length == 2000)
        << length;
  }
}

// ------------------------------------------------------------------------------------------ CDT

// Schoenhardt's polyhedron, a prism twisted so that the diagonals of its sides are reflex, has no
// tetrahedrization without Steiner points. With some on its segments it has a constrained Delaunay
// one.
TEST(CdtStage, SchoenhardtsPolyhedronIsFilledWithSteinerPoints) {
  for (const double turn : {-5.0, -30.0, -55.0}) {
    Surface s;
    for (const double z : {0.0, 1.0}) {
      for (int i = 0; i < 3; ++i) {
        const double angle = (120 * i + (z > 0 ? turn : 0)) / kDegrees;
        s.vertices.push_back({std::cos(angle), std::sin(angle), z});
      }
    }
    s.triangles = {{0, 2, 1}, {3, 4, 5}};
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t j = (i + 1) % 3;
      s.triangles.push_back({i, j, i + 3});  // the diagonal that the turn makes reflex
      s.triangles.push_back({j, j + 3, i + 3});
    }
    delmesher::CdtOptions options;
    options.want_exact = true;
    const Result result = delmesher::constrained_delaunay(s, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_GT(result.statistics.steiner_on_segments, 0U) << turn;
    VerifyReport report;
    EXPECT_EQ(oracles::verify(samples::to_polyhedron(s), samples::to_mesh(result.mesh),
                              &result.exact, {.promised = oracles::promise_of(options)}, report),
              "");
    EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
    const oracles::OracleReport* cdt = report.find("exact-constrained-delaunay");
    ASSERT_NE(cdt, nullptr);
    EXPECT_GT(cdt->checked, 0U);
  }
}

// ------------------------------------------------------------------------------------ refinement

TEST(Figure8, RefinementEndsAndCountsExplodeAsTheGapShrinks) {
  std::size_t last = 0;
  double last_ratio = 0;
  for (const double h : {0.1, 0.01, 0.001}) {
    const Surface surface = samples::finned_cube(0.03, h);
    Options options = samples::split_surface();
    options.tau = 0;
    options.gabriel = true;   // the paper's; without, thin gaps cost less
    options.improve = false;  // takes out more where there is more
    const Result result = delmesher::tetrahedralize(surface, options);
    ASSERT_TRUE(result.status.ok()) << h << result.status.message;
    const std::size_t count = result.mesh.tetrahedra.size();
    EXPECT_GT(count, last) << h;
    if (last > 0) {
      const double ratio = static_cast<double>(count) / static_cast<double>(last);
      EXPECT_GT(ratio, last_ratio) << "faster than any fixed power from step to step";
      last_ratio = ratio;
    }
    last = count;
  }
  EXPECT_GT(last_ratio, 10) << "ten times thinner, more than ten times as many";
}

}  // namespace
}  // namespace tetproof::stage_test
