#include "mesher/refine/subsegments.h"

#include <gtest/gtest.h>

#include <set>

#include "mesher/refine/test_parts.h"

namespace delmesher::refine {

// Breaks one invariant at a time.
struct SubsegmentsBreaker {
  Parts& parts;
  Subsegments& part = parts.subsegments;

  TetId marked() const {
    TetId t = 0;
    while (!parts.dt.alive(t) || note(parts.dt, t, Note::edges) == 0) ++t;
    return t;
  }
  void forget_edge() const { note(parts.dt, marked(), Note::edges) = 0; }
  void end_chain() const { part.list_[0].next = kNone; }
  void lead_nowhere() const { part.list_[0].next = part.size(); }
  void go_round() const { part.list_[part.list_[0].next].next = 0; }
  void move_to_another_segment() const { part.list_[part.list_[0].next].segment = 1; }
  void forget_ends() const { part.by_ends_.erase(pair_key(part.list_[0].a, part.list_[0].b)); }
  void remember_the_split() const {
    part.by_ends_.set(
        pair_key(parts.plc().segments[0].vertex[0], parts.plc().segments[0].vertex[1]), 0);
  }
  void add_to_no_chain() const { part.add(0, 6, 0); }
  void claim_to_wait() const { WorkQueueBreaker{part.queue_}.claim_to_wait(0); }
  void wait_unknown() const { part.queue_.add(part.size()); }
  void ask_for_empty_balls() const { part.gabriel_ = true; }
};

namespace {

TEST(Subsegments, AtFirstTheSegmentsWithTheirNumbers) {
  const Parts parts;
  const auto& segments = parts.plc().segments;
  ASSERT_EQ(parts.subsegments.size(), segments.size());
  ASSERT_EQ(segments.size(), 24U);
  for (std::uint32_t s = 0; s < segments.size(); ++s) {
    const auto [a, b] = segments[s].vertex;
    EXPECT_EQ(parts.subsegments.find(a, b), s);
    EXPECT_EQ(parts.subsegments.find(b, a), s);
    EXPECT_EQ(parts.subsegments[s].segment, s);
    EXPECT_EQ(parts.subsegments.chain(s), (std::vector<VertexId>{a, b}));
  }
  EXPECT_EQ(parts.subsegments.find(0, 2), kNone);  // a diagonal
}

TEST(Subsegments, SplittingKeepsTheirOrder) {
  Parts parts;
  const std::uint32_t s = parts.segment(0, 1);
  const auto [first, last] = parts.plc().segments[s].vertex;
  std::vector<std::uint32_t> all = {s};
  for (const std::size_t n : {0U, 0U, 1U, 3U, 2U, 0U}) all.push_back(parts.split(all[n]));
  const std::vector<VertexId> chain = parts.subsegments.chain(s);
  ASSERT_EQ(chain.size(), all.size() + 1);
  EXPECT_EQ(chain.front(), first);
  EXPECT_EQ(chain.back(), last);
  const Vec3 from = parts.points.nearest(first);
  for (std::size_t n = 0; n + 1 < chain.size(); ++n) {
    EXPECT_LT(distance(from, parts.points.nearest(chain[n])),
              distance(from, parts.points.nearest(chain[n + 1])));
    const std::uint32_t here = parts.subsegments.find(chain[n], chain[n + 1]);
    ASSERT_NE(here, kNone);
    EXPECT_EQ(parts.subsegments[here].a, chain[n]);
    EXPECT_EQ(parts.subsegments[here].b, chain[n + 1]);
    EXPECT_EQ(parts.subsegments[here].segment, s);
    EXPECT_EQ(parts.subsegments.find(chain[n], chain[(n + 2) % chain.size()]), kNone);
  }
  EXPECT_EQ(parts.subsegments.find(first, last), kNone);
  EXPECT_EQ(complaint_of(parts.subsegments, parts.control), "nothing");
}

// Bits survive changes of the tetrahedra by other points, and bits of edges that were split say
// nothing.
TEST(Subsegments, TetrahedraKnowThoseThatAreTheirEdges) {
  Parts parts;
  parts.insert_some();
  std::size_t found = 0;
  for (const TetId t : parts.live_tetrahedra()) {
    std::multiset<std::uint32_t> expected, seen;
    for (const auto& e : kEdge) {
      const std::uint32_t s =
          parts.subsegments.find(parts.dt.vertex(t, e[0]), parts.dt.vertex(t, e[1]));
      if (s != kNone) expected.insert(s);
    }
    parts.subsegments.for_each_on(t, [&](std::uint32_t s) { seen.insert(s); });
    EXPECT_EQ(seen, expected);
    found += seen.size();
  }
  EXPECT_GT(found, 3 * parts.subsegments.size());
}

TEST(Subsegments, TheQueueIsServedInItsOrder) {
  Parts parts;
  Subsegments& part = parts.subsegments;
  ASSERT_TRUE(part.queue_empty());
  for (const std::uint32_t s : {5U, 2U, 5U, 7U, 2U}) part.queue(s);
  EXPECT_EQ(complaint_of(part, parts.control), "nothing");
  EXPECT_EQ(part.take_queued(), 5U);
  part.queue(5);
  for (const std::uint32_t s : {2U, 7U, 5U, kNone, kNone}) EXPECT_EQ(part.take_queued(), s);
  EXPECT_TRUE(part.queue_empty());
}

TEST(Subsegments, TheMissingAreQueued) {
  Parts parts;
  parts.subsegments.settle(3, kNone);
  EXPECT_EQ(taken_from(parts.subsegments), std::vector<std::uint32_t>{3});
}

// With the Gabriel property, also those with any vertex in their diametral ball.
TEST(Subsegments, TheEncroachedAreQueuedIfTheirBallsAreToBeEmpty) {
  Parts strict(true), lazy(false);
  const std::vector<VertexId> vertices = strict.all_vertices();
  std::vector<std::uint32_t> encroached;
  for (std::uint32_t s = 0; s < strict.subsegments.size(); ++s) {
    const Vec3 p = strict.points.nearest(strict.subsegments[s].a);
    const Vec3 q = strict.points.nearest(strict.subsegments[s].b);
    if (std::ranges::any_of(vertices, [&](VertexId v) {
          const Vec3 x = strict.points.nearest(v);
          return dot(subtract(p, x), subtract(q, x)) < 0;
        })) {
      encroached.push_back(s);
    }
  }
  EXPECT_GT(encroached.size(), 3U);
  EXPECT_LT(encroached.size(), 21U);
  EXPECT_EQ(taken_from(strict.subsegments), encroached);
  EXPECT_TRUE(lazy.subsegments.queue_empty());
}

TEST(Subsegments, TwoSidesAtMost) {
  Parts parts;
  Subsegments& part = parts.subsegments;
  const SubfacetEdge side = part[0].side[1];
  EXPECT_THROW(part.attach(0, {9, 1}), InternalError);
  part.replace_side(0, side, {});
  EXPECT_FALSE(part[0].side[1].exists());
  part.attach(0, {9, 1});
  EXPECT_EQ(part[0].side[1], SubfacetEdge(9, 1));
  part.renumber_sides([](SubfacetEdge e) { return SubfacetEdge(e.subfacet() + 1, e.edge()); });
  EXPECT_EQ(part[0].side[1], SubfacetEdge(10, 1));
}

TEST(Subsegments, ValidateReportsEveryBrokenInvariant) {
  using Breaker = SubsegmentsBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::forget_edge, "does not know of its subsegment"},
      {&Breaker::end_chain, "ends too soon"},
      {&Breaker::lead_nowhere, "leads nowhere"},
      {&Breaker::go_round, "begins elsewhere than the last one ends"},
      {&Breaker::move_to_another_segment, "begins elsewhere than the last one ends"},
      {&Breaker::forget_ends, "not found by its ends"},
      {&Breaker::remember_the_split, "no subsegment"},
      {&Breaker::add_to_no_chain, "in no chain"},
      {&Breaker::claim_to_wait, "waits in no queue"},
      {&Breaker::wait_unknown, "not marked as waiting"},
      {&Breaker::ask_for_empty_balls, "is encroached"},
  };
  expect_complaints(cases, [&](auto damage) {
    Parts parts;
    parts.split(0);
    EXPECT_EQ(complaint_of(parts.subsegments, parts.control), "nothing");
    (Breaker{parts}.*damage)();
    return complaint_of(parts.subsegments, parts.control);
  });
}

// A point beside a subsegment may take its edge away.
TEST(Subsegments, ValidateFindsALostEdge) {
  Parts parts;
  parts.insert_in_volume({1.5, 0.0625, 0.0625});
  ASSERT_EQ(taken_from(parts.subsegments), std::vector<std::uint32_t>{parts.segment(0, 1)});
  EXPECT_NE(complaint_of(parts.subsegments, parts.control).find("is not an edge"),
            std::string::npos);
}

}  // namespace
}  // namespace delmesher::refine
