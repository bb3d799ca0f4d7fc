// Laws of the refinement, checked by brute force on small complexes: nothing is encroached, angles
// are bounded, the pieces add up.
#include "mesher/refine/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "mesher/base/check.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/predicates/vector.h"
#include "mesher/refine/refiner.h"
#include "mesher/refine/test_complexes.h"

namespace delmesher {

// Breaks the state of a refinement, one invariant at a time.
struct RefinerBreaker {
  Refiner& r;

  std::uint32_t live_subfacet() const {
    std::uint32_t s = 0;
    while (!r.subfacets_[s].alive) ++s;
    return s;
  }
  TetId tetrahedron_with_edge() const {
    TetId t = 0;
    while (!r.dt_.alive(t) || r.dt_.is_ghost(t) || r.note(t, Refiner::kEdges) == 0) ++t;
    return t;
  }
  TetId tetrahedron_with_face() const {
    TetId t = 0;
    while (!r.dt_.alive(t) || r.note(t, Refiner::kFaces) == 0) ++t;
    return t;
  }
  void forget_edge() const { r.note(tetrahedron_with_edge(), Refiner::kEdges) = 0; }
  void forget_face() const { r.note(tetrahedron_with_face(), Refiner::kFaces) = 0; }
  void misname_face() const {
    for (std::uint32_t& s : r.subfacet_[tetrahedron_with_face()]) ++s;
  }
  void turn_subfacet() const {
    auto& v = r.subfacets_[live_subfacet()].v;
    std::swap(v[0], v[1]);
  }
  void unlink_neighbors() const { r.subfacets_[live_subfacet()].neighbor = {kNone, kNone, kNone}; }
  void kill_subfacet() const { r.subfacets_[live_subfacet()].alive = false; }
  void leave_chain() const {
    std::size_t n = 0;
    while (r.subsegments_[r.first_subsegment_[n]].next == kNone) ++n;
    r.subsegments_[r.first_subsegment_[n]].next = kNone;
  }
  void forget_ends() const {
    const auto& s = r.subsegments_[0];
    r.edge_map_.erase(pair_key(s.a, s.b));
  }
  void lose_side() const { r.subsegments_[0].side[0] = kNone; }
  void claim_to_wait() const { r.subsegments_[0].queued = true; }
  void wait_unknown() const { r.subfacet_queue_.push_back(0); }
  // A point in a subfacet that the tetrahedrization has and the facet has not.
  void insert_behind_its_back() const {
    const auto& v = r.subfacets_[live_subfacet()].v;
    Vec3 centre{};
    for (const VertexId w : v) {
      for (std::size_t k = 0; k < 3; ++k) centre[k] += r.points_.nearest(w)[k] / 4;
    }
    for (std::size_t k = 0; k < 3; ++k) centre[k] += r.points_.nearest(v[0])[k] / 4;
    const VertexId p = r.points_.add_explicit(centre[0], centre[1], centre[2]);
    r.dt_.insert(p, r.dt_.incident(v[0]));
    r.subfacet_.resize(r.dt_.capacity());
  }
  std::size_t dead_slots() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(r.subfacets_, [](const auto& s) { return !s.alive; }));
  }
  // As if there were enough dead ones for it to pay.
  void compact() const {
    r.dead_subfacets_ = 1U << 30U;
    r.compact_subfacets();
  }
  void damage_tetrahedra() const {
    TetId t = 0;
    while (!r.dt_.alive(t) || r.dt_.is_ghost(t)) ++t;
    r.dt_.glue(t, 0, t, 1);
  }
};

namespace {

struct Refinement : Complex {
  RefineResult result;

  Refinement(const Surface& surface, RefineOptions options, double corner = 60)
      : Complex(surface, corner) {
    for (const auto& t : topology.triangles) {
      Box all = Box::empty();
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

// Segments are split at equal distances from an apex or at halves of them, whatever their lengths.
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

// Whoever names a subfacet knows its new number: neighbours, subsegments, tetrahedra and queues.
TEST(Refine, RenumberingSubfacetsLeavesEveryInvariant) {
  State state(true);
  const RefinerBreaker inside{*state.refiner};
  EXPECT_GT(inside.dead_slots(), 0U);
  inside.compact();
  EXPECT_EQ(inside.dead_slots(), 0U);
  EXPECT_NO_THROW(state.refiner->validate());
}

std::string complaint(const std::function<void(const RefinerBreaker&)>& damage) {
  State state(true);
  damage({*state.refiner});
  try {
    state.refiner->validate();
  } catch (const InternalError& error) {
    return error.what();
  }
  return "nothing";
}

TEST(Refine, ValidateReportsEveryBrokenInvariant) {
  using Breaker = RefinerBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::forget_edge, "does not know of its subsegment"},
      {&Breaker::forget_face, "does not know of its subfacet"},
      {&Breaker::misname_face, "does not know of its subfacet"},
      {&Breaker::turn_subfacet, "turned over"},
      {&Breaker::unlink_neighbors, "has no other side"},
      {&Breaker::kill_subfacet, "disagree"},
      {&Breaker::leave_chain, "ends too soon"},
      {&Breaker::forget_ends, "not found by its ends"},
      {&Breaker::lose_side, "lacks a subfacet beside it"},
      {&Breaker::claim_to_wait, "waits in no queue"},
      {&Breaker::wait_unknown, "waits in no queue"},
      {&Breaker::insert_behind_its_back, "sub"},
      {&Breaker::damage_tetrahedra, "neighbours"},
  };
  for (const auto& [damage, reason] : cases) {
    const std::string said = complaint([broken = damage](const Breaker& b) { (b.*broken)(); });
    EXPECT_NE(said.find(reason), std::string::npos) << said << ", not " << reason;
  }
}

// What is refined without the Gabriel property does not have it.
TEST(Refine, ValidateAsksForEmptyBallsWithGabrielOnly) {
  std::string said = "nothing";
  State state(false);
  state.options.gabriel = true;
  try {
    state.refiner->validate();
  } catch (const InternalError& error) {
    said = error.what();
  }
  EXPECT_NE(said.find("is encroached"), std::string::npos) << said;
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
}  // namespace delmesher
