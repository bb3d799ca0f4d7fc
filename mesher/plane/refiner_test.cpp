#include "mesher/plane/refiner.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "mesher/base/test_complaints.h"
#include "mesher/plane/test_graphs.h"

namespace delmesher::plane {

// Goes through the refinement one point at a time, and breaks one invariant at a time.
struct RefinerBreaker {
  Refiner& r;

  void start() const {
    r.triangulate_graph();
    r.sides_.start();
    r.subsegments_.queue_all();
  }
  bool split_next_subsegment() const {
    const EdgeId e = r.subsegments_.take();
    if (e == kNone) return false;
    r.split_subsegment(e);
    return true;
  }
  void judge_all(double degrees) const {
    r.goal_ = Goal(degrees, r.options_.max_edge);
    r.judging_ = true;
    for (TriangleId t = 0; t < r.mesh_.size(); ++t) r.judge(t);
  }
  // False if none is left.
  bool split_next_triangle() const {
    BadTriangles::Entry entry;
    while (r.bad_.pop(entry)) {
      if (r.mesh_[entry.triangle].vertex != entry.vertex) continue;
      r.split_triangle(entry.triangle);
      return true;
    }
    return false;
  }
  bool crowded() const { return r.crowding_.any(); }
  std::uint64_t inserted() const { return r.result_.on_segments + r.result_.in_faces; }
  bool has_vertex(VertexId v) const { return r.mesh_.has_vertex(v); }

  void forget_subsegments() const { r.subsegments_.clear(); }
  void forget_triangles() const { r.bad_.clear(); }
  Sides& sides() const { return r.sides_; }
  Crowding& crowding() const { return r.crowding_; }
};

// Breaks one invariant at a time.
struct SidesBreaker {
  Sides& sides;

  TriangleId some(bool with_gaps) const {
    TriangleId t = 0;
    while (sides.gaps_at(t).empty() == with_gaps || (!with_gaps && sides.of(t) == Side::mixed)) ++t;
    return t;
  }
  std::vector<std::uint32_t>& list() const { return sides.lists_[sides.list_of_[some(true)]]; }

  void lose_one() const { sides.side_.pop_back(); }
  void forget() const { sides.side_[some(false)] = 3; }
  void turn() const { sides.side_[some(false)] ^= 1; }
  void decide() const { sides.side_[some(true)] = 0; }
  void empty_a_list() const { list().clear(); }
  void list_another() const {
    // One that is not at the same corner.
    std::uint32_t g = 0;
    while (sides.contact(some(true), sides.gaps_[g]) == Sides::Contact::proper) ++g;
    list().push_back(g);
  }
  void lose_a_list() const { sides.list_of_[some(true)] = kNone; }
  void free_a_list() const { sides.free_lists_.push_back(sides.list_of_[some(true)]); }
};

struct CrowdingBreaker {
  Crowding& crowding;

  void note_silently() const { crowding.vertices_.push_back(0); }
  void note_another_vertex() const {
    crowding.at(0);
    crowding.vertices_.push_back(~VertexId{0});
  }
  void note_another_piece() const {
    crowding.at(0);
    crowding.pieces_.push_back(~PieceId{0});
  }
  void count_the_box() const { ++crowding.splits_[0]; }
  void despair() const { crowding.any_ = crowding.hopeless_ = true; }
};

// Breaks one invariant at a time.
struct BadTrianglesBreaker {
  BadTriangles& bad;

  void raise_the_lowest() const { bad.lowest_ = BadTriangles::kBuckets; }
  void miscount() const { ++bad.count_; }
  void take_too_many() const { bad.queue_[bad.lowest_].head = 1000; }
  void wait_for_no_bucket() const { bad.later_.push_back({0, 0, 1000, {0, {0, 1, 2}}}); }
};

namespace {

using namespace test_graphs;

struct Refinement : Stages {
  explicit Refinement(PlanarGraph given, const RefineOptions& how = {})
      : Stages(std::move(given)),
        options(how),
        refiner(graph, chamfered, points, predicates, options, control) {}

  RefineOptions options;
  Refiner refiner;
  RefinerBreaker step{refiner};
};

std::vector<PlanarGraph> graphs() {
  std::vector<PlanarGraph> all = {square(), arrow()};
  for (unsigned seed = 0; seed < 6; ++seed) all.push_back(star(12 + 7 * seed, seed));
  return all;
}

TEST(PlaneRefiner, EveryInsertionKeepsTheInvariants) {
  std::uint64_t insertions = 0;
  for (const PlanarGraph& graph : graphs()) {
    Refinement r(graph);
    r.step.start();
    ASSERT_EQ(complaint_of(r.refiner), "nothing");
    while (r.step.split_next_subsegment()) ASSERT_EQ(complaint_of(r.refiner), "nothing");
    r.step.judge_all(kProvenDelta);
    ASSERT_EQ(complaint_of(r.refiner), "nothing");
    while (r.step.split_next_triangle()) {
      ASSERT_EQ(complaint_of(r.refiner), "nothing");
      while (r.step.split_next_subsegment()) ASSERT_EQ(complaint_of(r.refiner), "nothing");
    }
    EXPECT_FALSE(r.step.crowded());
    insertions += r.step.inserted();
  }
  EXPECT_GT(insertions, 200U);
}

// By the definitions, on the result, without using the parts.
TEST(PlaneRefiner, WhatIsInsideKeepsTheBoundInTheEnd) {
  for (const PlanarGraph& graph : graphs()) {
    Stages s(graph);
    RefineOptions options;
    options.validate = true;
    options.max_edge = 0.25;
    const RefinedMesh result =
        refine(s.graph, s.chamfered, s.points, s.predicates, options, s.control);
    EXPECT_FALSE(result.crowded);
    EXPECT_EQ(result.delta, kProvenDelta);
    EXPECT_EQ(result.carrier.size(), s.points.size());
    for (TriangleId t = 0; t < result.mesh.size(); ++t) {
      if (result.side[t] == Side::outside) continue;
      const auto& v = result.mesh[t].vertex;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 a = s.points.nearest(v[i]), b = s.points.nearest(v[(i + 1) % 3]),
                   c = s.points.nearest(v[(i + 2) % 3]);
        const double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - a[0], vy = c[1] - a[1];
        const double angle = std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
        EXPECT_GE(angle * 57.29577951308232, kProvenDelta - 1e-9);
        EXPECT_LE(std::hypot(ux, uy), options.max_edge);
        const EdgeId e = edge_of(t, static_cast<int>(i));
        if (result.mesh.piece(e) == kNone) continue;
        EXPECT_GE(
            s.predicates.dot(result.mesh.origin(e), result.mesh.opposite(e), result.mesh.target(e)),
            0);
      }
    }
  }
}

TEST(PlaneRefiner, EveryPointOfAPieceHasItAsItsCarrier) {
  Stages s(arrow());
  const RefinedMesh result = refine(s.graph, s.chamfered, s.points, s.predicates, {}, s.control);
  std::size_t carried = 0;
  for (VertexId v = 0; v < s.points.size(); ++v) {
    if (!result.mesh.has_vertex(v)) continue;
    std::vector<EdgeId> star;
    result.mesh.star(v, star);
    PieceId piece = kNone;  // of an edge at v
    for (const EdgeId e : star) {
      for (const EdgeId f : {edge_of(triangle_of(e), next(index_of(e))),
                             edge_of(triangle_of(e), previous(index_of(e)))}) {
        if (result.mesh.piece(f) != kNone) piece = result.mesh.piece(f);
      }
    }
    const bool put_there = v >= s.graph.vertices + 4 && piece != kNone && piece >= kBoxPieces;
    EXPECT_EQ(result.carrier[v], put_there ? piece : kNone) << v;
    carried += put_there;
  }
  EXPECT_GT(carried, 3U);
}

TEST(PlaneRefiner, ValidateReportsEveryBrokenInvariant) {
  // A vertex is in the disc of the long segment.
  Refinement segments(ring({{0, 0}, {4, 0}, {4, 1}, {2, 0.25}, {0, 1}}));
  segments.step.start();
  ASSERT_EQ(complaint_of(segments.refiner), "nothing");
  segments.step.forget_subsegments();
  expect_complaint(complaint_of(segments.refiner), "an encroached subsegment does not wait");

  Refinement triangles(star(19, 1));
  triangles.step.start();
  while (triangles.step.split_next_subsegment()) {
  }
  triangles.step.judge_all(kProvenDelta);
  ASSERT_EQ(complaint_of(triangles.refiner), "nothing");
  triangles.step.forget_triangles();
  expect_complaint(complaint_of(triangles.refiner), "a bad triangle does not wait");
}

TEST(PlaneRefiner, ValidateReportsWhatIsBrokenOfTheSides) {
  using Breaker = SidesBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::lose_one, "not every triangle has a side"},
      {&Breaker::forget, "has no side"},
      {&Breaker::turn, "disagree"},
      {&Breaker::decide, "a triangle with gaps is not mixed"},
      {&Breaker::empty_a_list, "a list of gaps without any"},
      {&Breaker::list_another, "not where it is listed"},
      {&Breaker::lose_a_list, "a gap is not listed"},
      {&Breaker::free_a_list, "a free list has gaps"},
  };
  expect_complaints(cases, [](auto damage) {
    Refinement r(arrow());
    r.step.start();
    while (r.step.split_next_subsegment()) {
    }
    EXPECT_EQ(complaint_of(r.refiner), "nothing");
    (Breaker{r.step.sides()}.*damage)();
    return complaint_of(r.refiner);
  });
}

TEST(PlaneRefiner, ValidateReportsWhatIsBrokenOfTheCrowding) {
  using Breaker = CrowdingBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::note_silently, "denies it"},
      {&Breaker::note_another_vertex, "not of the input"},
      {&Breaker::note_another_piece, "does not exist"},
      {&Breaker::count_the_box, "side of the box"},
      {&Breaker::despair, "hopeless"},
  };
  expect_complaints(cases, [](auto damage) {
    Refinement r(arrow());
    r.step.start();
    EXPECT_EQ(complaint_of(r.refiner), "nothing");
    (Breaker{r.step.crowding()}.*damage)();
    return complaint_of(r.refiner);
  });
}

TEST(PlaneRefiner, ValidateCountsNoPredicates) {
  Refinement r(star(19, 1));
  r.step.start();
  const PlaneCounters before = r.predicates.counters;
  r.refiner.validate();
  EXPECT_EQ(r.predicates.counters.filter, before.filter);
  EXPECT_EQ(r.predicates.counters.exact, before.exact);
  EXPECT_EQ(r.predicates.counters.symbolic, before.symbolic);
}

TEST(BadTriangles, WorstFirstAndValidateReportsWhatIsBroken) {
  PointStore points;
  points.add_explicit(0, 0, 0);
  const SpatialKey unit({0, 0}, {1, 1});
  using Breaker = BadTrianglesBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::raise_the_lowest, "below the lowest bucket"},
      {&Breaker::miscount, "count of entries"},
      {&Breaker::take_too_many, "more was taken"},
      {&Breaker::wait_for_no_bucket, "no bucket"},
  };
  for (const auto& [damage, reason] : cases) {
    BadTriangles bad(points, unit);
    bad.push(0.01, {7, {0, 0, 0}});
    bad.push(1, {8, {0, 0, 0}});
    bad.push(0.0001, {9, {0, 0, 0}});
    BadTriangles::Entry entry;
    ASSERT_TRUE(bad.pop(entry));
    EXPECT_EQ(entry.triangle, 9U);
    std::vector<TriangleId> left;
    bad.for_each([&](const BadTriangles::Entry& e) { left.push_back(e.triangle); });
    EXPECT_EQ(left, (std::vector<TriangleId>{7, 8}));
    ASSERT_EQ(complaint_of(bad), "nothing");
    ASSERT_TRUE(bad.pop(entry));
    bad.push(0.01, entry);
    (Breaker{bad}.*damage)();
    expect_complaint(complaint_of(bad), reason);
  }
}

TEST(PlaneGoal, JudgesAnglesThenEdges) {
  PointStore points;
  const auto add = [&](double x, double y) { return points.add_explicit(x, y, 0); };
  const VertexId a = add(0, 0), b = add(1, 0), even = add(0.5, 0.875), low = add(0.5, 0.125);
  const Shape good = shape_of(points, a, b, even), flat = shape_of(points, a, b, low);
  EXPECT_EQ(Goal(20, 0).badness(good), std::nullopt);
  EXPECT_EQ(Goal(20, 2).badness(good), std::nullopt);
  EXPECT_EQ(Goal(20, 0.5).badness(good), 1.0);
  // atan(1/4) is 14.04 degrees.
  EXPECT_EQ(Goal(14, 0).badness(flat), std::nullopt);
  ASSERT_NE(Goal(14.1, 0).badness(flat), std::nullopt);
  EXPECT_NEAR(*Goal(14.1, 0.1).badness(flat), 1.0 / 17, 1e-12);
  // An angle that is too small asks for the off-centre, an edge for the circumcentre.
  EXPECT_EQ(Goal(20, 0.5).reach(good), good.circumcentre);
  const VertexId far = add(0.5, 8);
  const Shape thin = shape_of(points, a, b, far);
  const double half = 10 * 0.017453292519943295;  // half of 20 degrees
  EXPECT_NEAR(Goal(20, 0).reach(thin), 0.475 / std::tan(half), 1e-9);
  EXPECT_LT(Goal(20, 0).reach(thin), thin.circumcentre);
  EXPECT_EQ(Goal(1, 0).reach(thin), thin.circumcentre);
}

// A far vertex takes nothing from what doubles can hold of the near ones (fourth powers of the
// longest side stay finite, squares of the shortest one do not vanish).
TEST(PlaneShape, HoldsAcrossTheRangeOfDoubles) {
  for (const double far : {0x1p0, 0x1p50, 0x1p300, 0x1p700, 0x1p768, 0x1p1000}) {
    PointStore points;
    const auto add = [&](double x, double y) { return points.add_explicit(x / far, y / far, 0); };
    const VertexId a = add(0, 0), b = add(1, 0), c = add(0.5, 4 * far);
    for (const std::array<VertexId, 3>& v : {std::array{a, b, c}, {b, c, a}, {c, a, b}}) {
      SCOPED_TRACE(testing::Message() << far << ' ' << v[0]);
      const Shape shape = shape_of(points, v[0], v[1], v[2]);
      EXPECT_EQ(v[static_cast<std::size_t>(shape.sharpest)], c);
      EXPECT_GT(shape.shortest_squared, 0x1p-1022);
      EXPECT_EQ(shape.shortest_squared, (shape.scale / far) * (shape.scale / far));
      EXPECT_LE(shape.sine_squared, 1 / 16.0);
      EXPECT_TRUE(std::isfinite(shape.longest_squared));
      EXPECT_NE(Goal(20, 0).badness(shape), std::nullopt);
      const Vec3 place = shape.place(points, v, 1);
      EXPECT_NEAR(place[0] * far, 0.5, 1e-5);
      EXPECT_NEAR(place[1] * far, 1, 1e-5);
    }
  }
}

TEST(PlaneCrowding, NamesWhatCanBeSpared) {
  const Stages s(square());
  const std::vector<PieceId> carrier(s.points.size() + 2, kNone);
  std::vector<PieceId> carried = carrier;
  const auto on_piece = static_cast<VertexId>(s.points.size());
  carried[on_piece] = kBoxPieces + 1;
  Crowding crowding(s.graph, carried, 2);
  EXPECT_FALSE(crowding.any());
  crowding.at(on_piece + 1);  // on nothing
  EXPECT_TRUE(crowding.any());
  EXPECT_TRUE(crowding.pieces().empty() && crowding.vertices().empty());
  crowding.at(2);
  crowding.at(on_piece);
  crowding.at(on_piece + 1000);
  EXPECT_EQ(crowding.vertices(), std::vector<VertexId>({2}));
  EXPECT_EQ(crowding.pieces(), std::vector<PieceId>({kBoxPieces + 1}));
  EXPECT_FALSE(crowding.hopeless());
}

TEST(PlaneCrowding, APieceThatIsSplitTooOftenIsHopeless) {
  const Stages s(square());
  const std::vector<PieceId> carrier;
  Crowding crowding(s.graph, carrier, 2);
  for (int i = 0; i < 5; ++i) crowding.count_split(0);  // a side of the box
  crowding.count_split(kBoxPieces);
  crowding.count_split(kBoxPieces + 1);
  EXPECT_FALSE(crowding.any());
  crowding.count_split(kBoxPieces);
  EXPECT_TRUE(crowding.any() && crowding.hopeless());
  EXPECT_EQ(crowding.pieces(), std::vector<PieceId>({kBoxPieces}));
  Crowding unbounded(s.graph, carrier, 0);
  for (int i = 0; i < 100; ++i) unbounded.count_split(kBoxPieces);
  EXPECT_FALSE(unbounded.any());
}

// The edge of a triangulation between two vertices, seen from either side.
EdgeId edge_between(const Triangulation& mesh, VertexId a, VertexId b) {
  return mesh.find_edge(a, b);
}

TEST(PlaneSteinerPoints, OnASubsegmentStrictlyInsideAndExactlyOnItsPiece) {
  Stages s(star(12, 3));
  SteinerPoints steiner(s.graph, s.chamfered, s.graph.base, s.points, s.predicates);
  for (std::uint32_t i = 0; i < 12; ++i) {
    const VertexId a = s.vertex(i), b = s.vertex((i + 1) % 12);
    const EdgeId e = edge_between(s.graph.base, a, b);
    ASSERT_NE(e, kNone);
    const VertexId p = steiner.on_subsegment(e);
    ASSERT_NE(p, kNone);
    EXPECT_EQ(s.predicates.orient(a, b, p), 0);
    EXPECT_LT(s.predicates.dot(a, p, b), 0);
    EXPECT_EQ(steiner.carrier()[p], s.graph.base.piece(e));
  }
}

TEST(PlaneSteinerPoints, NoneWhereDoublesLeaveNoRoom) {
  // A side of a few ulps, far from the origin.
  constexpr double kUlp = 0x1p-52;
  Stages s(ring({{1, 1}, {1 + 8 * kUlp, 1}, {1, 2}}));
  SteinerPoints steiner(s.graph, s.chamfered, s.graph.base, s.points, s.predicates);
  const std::size_t before = s.points.size();
  const EdgeId tiny = edge_between(s.graph.base, s.vertex(0), s.vertex(1));
  ASSERT_NE(tiny, kNone);
  EXPECT_EQ(steiner.on_subsegment(tiny), kNone);
  const auto candidate =
      steiner.in_triangle({s.vertex(0), s.vertex(1), s.vertex(2)}, Goal(kProvenDelta, 0));
  EXPECT_EQ(candidate.vertex, kNone);
  EXPECT_EQ(s.points.size(), before);
}

TEST(PlaneSteinerPoints, InsideTheCircleOfTheTriangle) {
  Stages s(ring({{0, 0}, {1, 0}, {0.5, 4}}));
  const std::array<VertexId, 3> v = {s.vertex(0), s.vertex(1), s.vertex(2)};
  SteinerPoints steiner(s.graph, s.chamfered, s.graph.base, s.points, s.predicates);
  const std::size_t before = s.points.size();
  const auto candidate = steiner.in_triangle(v, Goal(kProvenDelta, 0));
  ASSERT_EQ(candidate.vertex, before);
  EXPECT_FALSE(candidate.restored);
  EXPECT_GT(s.predicates.in_circle(v[0], v[1], v[2], candidate.vertex), 0);
  steiner.take_back(candidate);
  EXPECT_EQ(s.points.size(), before);
}

// As far from the three corners as from each other, on a grid of a millionth of the shortest edge.
TEST(PlaneSteinerPoints, AtTheCircumcentre) {
  for (const double height : {0.3, 4.0, 700.0}) {
    Stages s(ring({{0, 0}, {1, 0}, {0.4, height}}));
    const std::array<VertexId, 3> v = {s.vertex(0), s.vertex(1), s.vertex(2)};
    SteinerPoints steiner(s.graph, s.chamfered, s.graph.base, s.points, s.predicates, true);
    const auto candidate = steiner.in_triangle(v, Goal(kProvenDelta, 0));
    ASSERT_NE(candidate.vertex, kNone);
    const auto distance = [&](VertexId u) {
      const Approximation &p = s.points.approximation(u),
                          &q = s.points.approximation(candidate.vertex);
      return norm(p.x - q.x, p.y - q.y);
    };
    const double edge = norm(s.points.approximation(v[1]).x - s.points.approximation(v[0]).x, 0);
    EXPECT_NEAR(distance(v[0]), distance(v[1]), edge * 0x1p-18);
    EXPECT_NEAR(distance(v[0]), distance(v[2]), edge * 0x1p-18) << height;
  }
}

TEST(PlaneSteinerPoints, WithCircumcentresNoChamferedCornerComesBack) {
  RefineOptions options;
  options.circumcentres = true;
  for (unsigned seed = 0; seed < 6; ++seed) {
    Refinement r(star(24, seed), options);
    const std::vector<PlaneRecord::Corner> corners = r.chamfered.corners;
    ASSERT_FALSE(corners.empty());
    r.refiner.run();
    for (const PlaneRecord::Corner& corner : corners) {
      EXPECT_FALSE(r.step.has_vertex(corner.vertex));
    }
  }
}

// Beside the cut points of a chamfered corner the corner itself comes back, and is not taken out of
// the store.
TEST(PlaneSteinerPoints, ChamferedCornersComeBack) {
  std::size_t restored = 0;
  for (unsigned seed = 0; seed < 6; ++seed) {
    Refinement r(star(24, seed));
    const std::vector<PlaneRecord::Corner> corners = r.chamfered.corners;
    ASSERT_FALSE(corners.empty());
    r.refiner.run();
    for (const PlaneRecord::Corner& corner : corners) {
      EXPECT_LT(corner.vertex, r.graph.vertices);
      restored += r.step.has_vertex(corner.vertex);
    }
  }
  EXPECT_GT(restored, 0U);
}

}  // namespace
}  // namespace delmesher::plane
