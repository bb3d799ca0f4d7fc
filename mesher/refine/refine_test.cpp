// Laws of the refinement, checked by brute force on small complexes: nothing is encroached, angles
// are bounded, the pieces add up.
#include "mesher/refine/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/geometry/vector.h"
#include "mesher/refine/prediction.h"
#include "mesher/refine/refiner.h"
#include "mesher/refine/test_complexes.h"
#include "mesher/surface/facet_locator.h"

namespace delmesher::refine {

// Breaks the links between the parts of a refinement, and one invariant of each part: its own tests
// break the others.
struct RefinerBreaker {
  Refiner& r;

  std::uint32_t live_subfacet() const {
    std::uint32_t s = 0;
    while (!r.subfacets_[s].alive) ++s;
    return s;
  }
  TetId finite() const {
    TetId t = 0;
    while (!r.dt_.alive(t) || r.dt_.is_ghost(t)) ++t;
    return t;
  }
  void damage_tetrahedra() const { r.dt_.glue(finite(), 0, finite(), 1); }
  void leave_subsegment_queued() const { r.subsegments_.queue(0); }
  void leave_subfacet_queued() const { r.subfacets_.queue(live_subfacet()); }
  void lose_side() const { r.subsegments_.replace_side(0, r.subsegments_[0].side[0], {}); }
  void take_side_of_another() const {
    r.subsegments_.replace_side(0, r.subsegments_[0].side[0], r.subsegments_[1].side[0]);
  }
  void take_one_side_twice() const {
    r.subsegments_.replace_side(0, r.subsegments_[0].side[0], r.subsegments_[0].side[1]);
  }
  void take_dead_side() const {
    std::uint32_t s = 0;
    while (r.subfacets_[s].alive) ++s;
    r.subsegments_.replace_side(0, r.subsegments_[0].side[0], {s, 0});
  }
  void forget_edges() const {
    for (TetId t = 0; t < r.dt_.capacity(); ++t) note(r.dt_, t, Note::edges) = 0;
  }
  void forget_faces() const {
    for (TetId t = 0; t < r.dt_.capacity(); ++t) note(r.dt_, t, Note::faces) = 0;
  }
  void ask_for_side() const { r.sides_.inherit(finite(), Sides::State::asked); }
  void let_wait() const { note(r.dt_, finite(), Note::waiting) = 1; }
  void ask_for_more() const { r.goal_ = Goal(50, false, 0); }
};

namespace {

struct Refinement : Complex {
  RefineResult result;

  Refinement(const Surface& surface, RefineOptions options, double corner = 60)
      : Complex(surface, corner) {
    for (const auto& t : topology.triangles) {
      Box all;
      for (const VertexId v : t) all.extend({points.nearest(v), points.nearest(v)});
      if (chamfered.acute_vertices > 0) options.removed.push_back(all);
    }
    options.apex = chamfered.vertex_is_apex;
    options.validate = true;  // in every build
    result = refine(plc(), topology, points, predicates, options, control);
  }

  std::set<VertexId> vertices() const {
    std::set<VertexId> used;
    for (const auto& t : result.tetrahedra) used.insert(t.begin(), t.end());
    return used;
  }
};

// The faces of the outer box lie in six planes of their own, and its corners say in which: zeros
// follow from that without arithmetic.
TEST(OuterBox, HasSixPlanesOfItsOwn) {
  Complex complex(ell(), 60);
  const std::size_t before = complex.points.size();
  Plc plc;
  add_outer_box(complex.topology, complex.points, plc);
  ASSERT_EQ(complex.points.size(), before + 8);
  const auto planes_of = [&](VertexId v) {
    const auto planes = complex.points.planes(v);
    return std::set<PlaneId>(planes.begin(), planes.end());
  };
  std::set<PlaneId> all;
  for (auto v = static_cast<VertexId>(before); v < before + 8; ++v) {
    const std::set<PlaneId> mine = planes_of(v);
    EXPECT_EQ(mine.size(), 3U);
    all.insert(mine.begin(), mine.end());
    for (auto w = static_cast<VertexId>(before); w < v; ++w) {
      const Vec3 p = complex.points.nearest(v), q = complex.points.nearest(w);
      std::size_t equal = 0, common = 0;
      for (int k = 0; k < 3; ++k) equal += p[k] == q[k] ? 1 : 0;
      for (const PlaneId plane : planes_of(w)) common += mine.count(plane);
      EXPECT_EQ(common, equal);
    }
  }
  EXPECT_EQ(all.size(), 6U);
  EXPECT_GE(*all.begin(), static_cast<PlaneId>(complex.topology.plane_count));
}

// A point inside a triangle of a facet is found there, in facets of few triangles and of many.
TEST(FacetLocator, FindsTheTriangleAroundAPoint) {
  for (const int corners : {5, 7, 60}) {
    std::vector<std::array<double, 2>> outline;
    for (int i = 0; i < corners; ++i) {
      const double angle = 360.0 * i / corners * kDegree;
      outline.push_back({3 + std::cos(angle), 5 + std::sin(angle)});
    }
    const Complex complex(prism(outline, 1), 60);
    FacetLocator locator(complex.topology, complex.points);
    for (std::uint32_t t = 0; t < complex.topology.triangles.size(); ++t) {
      const auto& v = complex.topology.triangles[t];
      for (int near = 0; near < 3; ++near) {  // a point near this corner
        Vec3 p{};
        for (int k = 0; k < 3; ++k) {
          const Vec3 corner = complex.points.nearest(v[k]);
          for (int i = 0; i < 3; ++i) p[i] += (k == near ? 0.8 : 0.1) * corner[i];
        }
        EXPECT_EQ(locator.triangle_at(complex.topology.facet_of[t], p), t) << corners;
      }
    }
  }
}

// Progress and the limit of vertices count no more vertices than there are.
TEST(Refinement, ALimitOfAllVerticesIsEnough) {
  std::vector<std::array<double, 2>> outline;
  for (int i = 0; i < 60; ++i) {
    outline.push_back({std::cos(6 * i * kDegree), std::sin(6 * i * kDegree)});
  }
  Complex complex(prism(outline, 1), 60);
  Limits limits;
  std::size_t asked = 0;
  limits.progress = [&](const Progress& progress) {
    EXPECT_LE(progress.vertices, complex.points.size());
    ++asked;
    return true;
  };
  Control control(limits);
  refine(complex.plc(), complex.topology, complex.points, complex.predicates, {}, control);
  EXPECT_GT(asked, 3U);
}

TEST(Prediction, OfNothingIsNothing) {
  PointStore points;
  const Limits limits;
  Control control(limits);
  for (const Region region : {Region::interior, Region::hull}) {
    PredictionOptions options;
    options.region = region;
    EXPECT_EQ(predict_tetrahedra({}, {}, {}, points, options, control), 0);
  }
}

double smallest_angle(const PointStore& points, const std::array<VertexId, 4>& t) {
  double smallest = 180;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = j + 1; k < 4; ++k) {
        if (i == j || i == k) continue;
        const Vec3 u = subtract(points.nearest(t[j]), points.nearest(t[i]));
        const Vec3 v = subtract(points.nearest(t[k]), points.nearest(t[i]));
        const Vec3 n = cross(u, v);
        smallest = std::min(smallest, std::atan2(std::sqrt(dot(n, n)), dot(u, v)) / kDegree);
      }
    }
  }
  return smallest;
}

double volume(const PointStore& points, const std::array<VertexId, 4>& t) {
  const Vec3 o = points.nearest(t[0]);
  return dot(subtract(points.nearest(t[1]), o),
             cross(subtract(points.nearest(t[2]), o), subtract(points.nearest(t[3]), o))) /
         6;
}

void expect_constraints_present(Refinement& r) {
  ASSERT_FALSE(r.result.runaway);
  ASSERT_GT(r.result.faces.size(), 10U);
  std::set<std::array<VertexId, 2>> edges;
  std::set<std::array<VertexId, 3>> faces;
  for (const auto& t : r.result.tetrahedra) {
    for (const auto& e : kEdge) {
      edges.insert({std::min(t[e[0]], t[e[1]]), std::max(t[e[0]], t[e[1]])});
    }
    for (const auto& f : kFace) {
      std::array<VertexId, 3> face = {t[f[0]], t[f[1]], t[f[2]]};
      std::sort(face.begin(), face.end());
      faces.insert(face);
    }
  }
  for (const auto& chain : r.result.chain) {
    for (std::size_t n = 0; n + 1 < chain.size(); ++n) {
      EXPECT_TRUE(
          edges.contains({std::min(chain[n], chain[n + 1]), std::max(chain[n], chain[n + 1])}));
    }
  }
  for (const RefinedFace& f : r.result.faces) {
    std::array<VertexId, 3> face = f.vertices;
    std::sort(face.begin(), face.end());
    EXPECT_TRUE(faces.contains(face));
    const auto& frame = r.chamfered.plc.facets[f.facet].frame;
    for (const VertexId v : f.vertices) {
      EXPECT_EQ(r.predicates.orient3d(frame[0], frame[1], frame[2], v), 0);
    }
  }
}

class Complexes : public testing::TestWithParam<std::pair<const char*, Surface>> {};

TEST_P(Complexes, NothingIsEncroached) {
  Refinement r(GetParam().second, {});
  ASSERT_FALSE(r.result.runaway);
  const std::set<VertexId> all = r.vertices();
  ASSERT_GT(r.result.faces.size(), 10U);
  for (const auto& chain : r.result.chain) {
    ASSERT_GE(chain.size(), 2U);
    for (std::size_t n = 0; n + 1 < chain.size(); ++n) {
      for (const VertexId v : all) {
        if (v == chain[n] || v == chain[n + 1]) continue;
        EXPECT_GE(r.predicates.dot_sign(chain[n], v, chain[n + 1]), 0);
      }
    }
  }
  for (const RefinedFace& f : r.result.faces) {
    for (const VertexId v : all) {
      if (std::find(f.vertices.begin(), f.vertices.end(), v) != f.vertices.end()) continue;
      EXPECT_LE(r.predicates.in_diametral_ball(f.vertices[0], f.vertices[1], f.vertices[2], v), 0);
    }
  }
}

TEST_P(Complexes, SubsegmentsAndSubfacetsAreInTheMesh) {
  for (const bool gabriel : {true, false}) {
    RefineOptions options;
    options.gabriel = gabriel;
    Refinement r(GetParam().second, options);
    expect_constraints_present(r);
  }
}

TEST_P(Complexes, TheGabrielPropertyTakesMoreVertices) {
  RefineOptions options;
  const Refinement strict(GetParam().second, options);
  options.gabriel = false;
  const Refinement lazy(GetParam().second, options);
  EXPECT_LE(lazy.result.tetrahedra.size(), strict.result.tetrahedra.size());
}

TEST_P(Complexes, AnglesMeetTheBoundWhereItHolds) {
  for (const Region region : {Region::interior, Region::hull}) {
    for (const auto& [delta, gabriel] :
         {std::pair{10.0, true}, std::pair{14.47, true}, std::pair{14.47, false}}) {
      RefineOptions options;
      options.region = region;
      options.delta = delta;
      options.gabriel = gabriel;
      Refinement r(GetParam().second, options);
      ASSERT_FALSE(r.result.runaway);
      std::size_t outside_bad = 0;
      for (std::size_t n = 0; n < r.result.tetrahedra.size(); ++n) {
        const double angle = smallest_angle(r.points, r.result.tetrahedra[n]);
        if (region == Region::interior && r.result.side[n] == Side::outside) {
          outside_bad += angle < delta ? 1 : 0;
        } else {
          EXPECT_GE(angle, delta);
        }
      }
      // Only a complex with small features leaves something bad outside; without it the modes would
      // not differ.
      const bool expected = region == Region::interior && r.chamfered.acute_vertices > 0;
      if (gabriel) {
        EXPECT_EQ(outside_bad > 0, expected);
      }
    }
  }
}

TEST_P(Complexes, InsideVolumesAddUp) {
  Refinement r(GetParam().second, {});
  double inside = 0;
  double straddling = 0;
  for (std::size_t n = 0; n < r.result.tetrahedra.size(); ++n) {
    EXPECT_GT(r.predicates.orient3d(r.result.tetrahedra[n][0], r.result.tetrahedra[n][1],
                                    r.result.tetrahedra[n][2], r.result.tetrahedra[n][3]),
              0);
    if (r.result.side[n] == Side::inside) inside += volume(r.points, r.result.tetrahedra[n]);
    if (r.result.side[n] == Side::straddling) {
      straddling += volume(r.points, r.result.tetrahedra[n]);
    }
  }
  double solid = 0;
  for (const auto& t : r.topology.triangles) {
    solid += dot(r.points.nearest(t[0]), cross(r.points.nearest(t[1]), r.points.nearest(t[2]))) / 6;
  }
  if (r.chamfered.acute_vertices == 0) {
    EXPECT_EQ(straddling, 0);
    EXPECT_NEAR(inside, solid, 1e-12 * solid);
  } else {
    EXPECT_GT(straddling, 0);
    EXPECT_LT(inside, solid);
    EXPECT_GT(inside + straddling, solid);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Complexes,
                         testing::Values(std::pair{"box", box()}, std::pair{"ell", ell()},
                                         std::pair{"wedge", wedge()}),
                         [](const auto& param) { return param.param.first; });

TEST(Refine, SliverTreatmentRaisesTheSmallestDistanceOfOppositeEdges) {
  const auto worst_ratio = [](bool slivers) {
    RefineOptions options;
    options.slivers = slivers;
    options.max_edge = 0.4;
    Refinement r(ell(), options);
    double worst = 0;
    for (std::size_t n = 0; n < r.result.tetrahedra.size(); ++n) {
      if (r.result.side[n] == Side::outside) continue;
      const auto& t = r.result.tetrahedra[n];
      double shortest2 = HUGE_VAL;
      double distance = HUGE_VAL;
      for (int e = 0; e < 6; ++e) {
        const Vec3 u = subtract(r.points.nearest(t[kEdge[e][1]]), r.points.nearest(t[kEdge[e][0]]));
        const Vec3 w =
            subtract(r.points.nearest(t[kEdge[5 - e][1]]), r.points.nearest(t[kEdge[5 - e][0]]));
        const Vec3 n2 = cross(u, w);
        shortest2 = std::min(shortest2, dot(u, u));
        distance = std::min(distance, 6 * volume(r.points, t) / std::sqrt(dot(n2, n2)));
      }
      worst = std::max(worst, std::sqrt(shortest2) / distance);
    }
    return worst;
  };
  EXPECT_LE(worst_ratio(true), 7.2 * (1 + 1e-9));
  EXPECT_GT(worst_ratio(false), 7.2);
}

// Section 5.6: each volume point is the circumcentre of the tetrahedron that it splits, except for
// the grid, which is finer than a thousandth of the shortest edge. By default some are off-centres.
TEST(Refine, CircumcentresIfAskedFor) {
  const auto farthest = [](bool circumcentres) {
    RefineOptions options;
    options.circumcentres = circumcentres;
    options.largest_ratio_first = circumcentres;
    options.region = Region::hull;
    options.want_balls = true;
    options.validate = true;
    Refinement r(prism({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.0625), options);
    EXPECT_GT(r.result.in_volume.size(), 5U);
    double spread = 0;
    for (std::size_t n = 0; n < r.result.in_volume.size(); ++n) {
      const auto& ball = r.result.ball[n];
      double smallest = HUGE_VAL, largest = 0, edge = HUGE_VAL;
      for (const VertexId v : ball) {
        const double d = distance(r.points.nearest(r.result.in_volume[n]), r.points.nearest(v));
        smallest = std::min(smallest, d);
        largest = std::max(largest, d);
      }
      for (const auto& e : kEdge) {
        edge = std::min(edge, distance(r.points.nearest(ball[e[0]]), r.points.nearest(ball[e[1]])));
      }
      spread = std::max(spread, (largest - smallest) / edge);
    }
    return spread;
  };
  EXPECT_LT(farthest(true), 1.0 / 256);
  EXPECT_GT(farthest(false), 1.0 / 16);
}

// At equal distances from the apex, or halves of them, whatever the lengths of the segments.
TEST(Refine, SegmentsAtAnApexAreSplitOnConcentricShells) {
  Surface surface = tent();
  surface.vertices[20] = {0.05, 0.03, 1.25};  // spokes of different lengths
  for (const bool gabriel : {true, false}) {
    RefineOptions options;
    options.gabriel = gabriel;
    options.max_edge = 0.2;
    Refinement r(surface, options, 20);
    ASSERT_FALSE(r.result.runaway);
    ASSERT_EQ(r.chamfered.acute_vertices, 0U);
    ASSERT_EQ(r.chamfered.vertex_is_apex[20], 1);
    expect_constraints_present(r);
    const Vec3 apex = r.points.nearest(20);
    double shell = 0;
    int split = 0;
    for (auto chain : r.result.chain) {
      if (chain.back() == 20) std::reverse(chain.begin(), chain.end());
      if (chain.front() != 20) continue;
      ASSERT_GT(chain.size(), 2U);
      const Vec3 d = subtract(r.points.nearest(chain[1]), apex);
      const double distance = std::sqrt(dot(d, d));
      if (shell == 0) shell = distance;
      const double halvings = std::log2(distance / shell);
      EXPECT_NEAR(halvings, std::round(halvings), 0.02);
      ++split;
    }
    EXPECT_EQ(split, 10);
    for (std::size_t n = 0; n < r.result.tetrahedra.size(); ++n) {
      if (r.result.side[n] == Side::outside) continue;
      EXPECT_GE(smallest_angle(r.points, r.result.tetrahedra[n]), 14.47);
    }
  }
}

// With a source inside, one outside and one on the surface.
TEST(Refine, SizeFieldBoundsEdgesInside) {
  const std::vector<SizeSource> sources = {
      {{0.3, 0.4, 0.5}, 0.02}, {{1.2, 0.5, 0.5}, 0.05}, {{0, 0, 0}, 0.04}};
  const SizeField sizes(sources, 0.4);
  RefineOptions options;
  Refinement coarse(box(), options);
  options.sizes = &sizes;
  Refinement r(box(), options);
  EXPECT_GT(r.result.tetrahedra.size(), 2 * coarse.result.tetrahedra.size());
  std::size_t checked = 0;
  for (std::size_t n = 0; n < r.result.tetrahedra.size(); ++n) {
    if (r.result.side[n] == Side::outside) continue;
    for (const auto& e : kEdge) {
      const Vec3 a = r.points.nearest(r.result.tetrahedra[n][e[0]]);
      const Vec3 b = r.points.nearest(r.result.tetrahedra[n][e[1]]);
      const Vec3 middle = add_scaled(a, 0.5, subtract(b, a));
      for (const Vec3& x : {a, b, middle}) {
        for (const SizeSource& s : sources) {
          EXPECT_LE(distance(a, b), (s.size + 0.4 * distance(x, s.point)) * (1 + 1e-12));
        }
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000U);
}

TEST(Refine, MaxEdgeBoundsEdgesInside) {
  RefineOptions options;
  options.max_edge = 0.3;
  Refinement r(box(), options);
  std::size_t checked = 0;
  for (std::size_t n = 0; n < r.result.tetrahedra.size(); ++n) {
    if (r.result.side[n] == Side::outside) continue;
    for (const auto& e : kEdge) {
      const Vec3 d = subtract(r.points.nearest(r.result.tetrahedra[n][e[1]]),
                              r.points.nearest(r.result.tetrahedra[n][e[0]]));
      EXPECT_LE(std::sqrt(dot(d, d)), 0.3 * (1 + 1e-12));
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000U);
}

// A refinement of the box, with its state.
struct State {
  Complex complex{box()};
  RefineOptions options;
  std::optional<Refiner> refiner;

  explicit State(bool gabriel) {
    options.gabriel = gabriel;
    refiner.emplace(complex.plc(), complex.topology, complex.points, complex.predicates, options,
                    complex.control);
    refiner->run();
  }
};

// Around a solid one rounding high, sums of a coordinate and a margin of less than a rounding can
// be that coordinate: a side of the box would lie on the solid.
TEST(Refine, TheOuterBoxKeepsItsMarginWhereDoublesAreWide) {
  constexpr double kFar = 56419016.86848649;
  for (const double y : {kFar, -kFar}) {
    const double beyond = std::nextafter(y, HUGE_VAL);
    Surface s;
    s.vertices = {{0, y, 0}, {1e-8, y, 0}, {0, y, 1e-8}, {0, beyond, 0}};
    s.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    PointStore points;
    Predicates predicates{points};
    const SurfaceTopology topology = build_topology(s, points, predicates);
    Plc plc;
    add_outer_box(topology, points, plc);
    ASSERT_EQ(plc.facets.size(), 6U);
    for (const PlcFacet& facet : plc.facets) {
      for (const VertexId corner : facet.frame) {
        const Vec3 p = points.nearest(corner);
        EXPECT_TRUE(y - p[1] >= 2.5e-9 || p[1] - beyond >= 2.5e-9) << p[1];
      }
    }
  }
}

TEST(Refine, ValidateAcceptsWhatTheRefinementLeaves) {
  for (const bool gabriel : {true, false}) {
    State state(gabriel);
    EXPECT_NO_THROW(state.refiner->validate());
  }
}

TEST(Refine, ValidateReportsWhatIsBrokenInAnyPartOrBetweenThem) {
  using Breaker = RefinerBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::damage_tetrahedra, "neighbours"},
      {&Breaker::leave_subsegment_queued, "wait to be split"},
      {&Breaker::leave_subfacet_queued, "wait to be split"},
      {&Breaker::lose_side, "lacks a subfacet beside it"},
      {&Breaker::take_side_of_another, "a subsegment and the subfacet beside it disagree"},
      {&Breaker::take_one_side_twice, "a subfacet and its subsegment disagree"},
      {&Breaker::take_dead_side, "a subsegment and the subfacet beside it disagree"},
      {&Breaker::forget_edges, "does not know of its subsegment"},
      {&Breaker::forget_faces, "does not know of its subfacet"},
      {&Breaker::ask_for_side, "asked for its side"},
      {&Breaker::let_wait, "waits at no level"},
      {&Breaker::ask_for_more, "a bad tetrahedron does not wait"},
  };
  expect_complaints(cases, [&](auto damage) {
    State state(true);
    (Breaker{*state.refiner}.*damage)();
    return complaint_of(*state.refiner);
  });
}

TEST(Refine, GuardReportsWhereEdgesGetTooShort) {
  RefineOptions options;
  options.runaway_length = 10;  // longer than everything
  const Refinement r(box(), options);
  ASSERT_TRUE(r.result.runaway);
  EXPECT_TRUE(r.result.tetrahedra.empty());
}

TEST(Refine, AnglesAboveTheBoundAreBestEffort) {
  RefineOptions options;
  options.delta = 25;
  const Refinement r(ell(), options);
  ASSERT_FALSE(r.result.runaway);
  EXPECT_FALSE(r.result.tetrahedra.empty());
  for (std::size_t n = 0; n < r.result.tetrahedra.size(); ++n) {
    if (r.result.side[n] == Side::outside) continue;
    EXPECT_GE(smallest_angle(r.points, r.result.tetrahedra[n]), 14.47);
  }
}

}  // namespace
}  // namespace delmesher::refine
