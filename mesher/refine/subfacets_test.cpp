#include "mesher/refine/subfacets.h"

#include <gtest/gtest.h>

#include <map>

#include "mesher/refine/test_parts.h"

namespace delmesher::refine {

// Breaks one invariant at a time.
struct SubfacetsBreaker {
  Parts& parts;
  Subfacets& part = parts.subfacets;

  void renumber() const { part.renumber(); }

  std::uint32_t live() const {
    std::uint32_t s = 0;
    while (!part[s].alive) ++s;
    return s;
  }
  // A face of the tetrahedrization that is the subfacet.
  FaceHandle face() const {
    const auto& v = part[live()].v;
    return parts.dt.find_face(v[0], v[1], v[2]);
  }
  void forget_face() const { note(parts.dt, face().tet(), Note::faces) = 0; }
  void misname_face() const { part.marks_.set(face(), live() + 1); }
  void keep_a_mark_on_one_side() const { part.marks_.set(unmarked(), 0); }
  void name_no_subfacet() const {
    for (const FaceHandle side : {unmarked(), parts.dt.across(unmarked())}) {
      part.marks_.set(side, part.size());
    }
  }
  FaceHandle unmarked() const {
    TetId t = 0;
    while (!parts.dt.alive(t) || part.marks_.of(t, 0) != kNone) ++t;
    return {t, 0};
  }
  void claim_to_wait() const { WorkQueueBreaker{part.queue_}.claim_to_wait(live()); }
  void wait_unknown() const { part.queue_.add(part.size()); }
  void ask_for_empty_balls() const { part.gabriel_ = true; }
};

namespace {

// Brute force over all faces of all tetrahedra.
void expect_known_by_tetrahedra(const Parts& parts) {
  std::map<std::array<VertexId, 3>, std::uint32_t> live;
  for (std::uint32_t s = 0; s < parts.subfacets.size(); ++s) {
    auto v = parts.subfacets[s].v;
    std::ranges::sort(v);
    if (parts.subfacets[s].alive) live[v] = s;
  }
  std::size_t found = 0;
  for (const TetId t : parts.live_tetrahedra()) {
    for (int i = 0; i < 4; ++i) {
      const VertexId* v = parts.dt.vertices(t);
      std::array<VertexId, 3> face = {v[kFace[i][0]], v[kFace[i][1]], v[kFace[i][2]]};
      std::ranges::sort(face);
      const auto expected = live.find(face);
      EXPECT_EQ(parts.subfacets.on_face(t, i), expected != live.end() ? expected->second : kNone);
      EXPECT_TRUE(expected == live.end() || parts.subfacets.any_on(t));
      found += expected != live.end() ? 1 : 0;
    }
  }
  EXPECT_EQ(found, 2 * live.size());
}

constexpr std::array<Vec3, 3> kBottom = {{{0, 0, 0}, {3, 0, 0}, {3, 2, 0}}};

TEST(Subfacets, TetrahedraKnowThemAfterEveryInsertion) {
  Parts parts;
  EXPECT_EQ(parts.subfacets.size(), 24U);
  ASSERT_TRUE(parts.subfacets.queue_empty());
  expect_known_by_tetrahedra(parts);
  EXPECT_EQ(complaint_of(parts.subfacets, parts.control), "nothing");
  const std::uint32_t bottom = parts.facet_through(kBottom);
  parts.insert_in_facet(bottom, {1.25, 0.75, 0});
  expect_known_by_tetrahedra(parts);
  const std::uint32_t half = parts.split(parts.segment(0, 1));
  expect_known_by_tetrahedra(parts);
  parts.insert_in_facet(bottom, {0.125, 1.875, 0});
  parts.split(half);
  parts.split(parts.segment(2, 3));
  parts.insert_in_facet(bottom, {2.875, 0.25, 0});
  ASSERT_TRUE(parts.subfacets.queue_empty());
  expect_known_by_tetrahedra(parts);
  EXPECT_EQ(complaint_of(parts.subfacets, parts.control), "nothing");
}

TEST(Subfacets, TheQueueIsServedInItsOrderWithoutTheDead) {
  Parts parts;
  Subfacets& part = parts.subfacets;
  const std::vector<std::uint32_t> bottom = parts.live_in(parts.facet_through(kBottom));
  const std::vector<std::uint32_t> top =
      parts.live_in(parts.facet_through({{{0, 0, 1}, {3, 0, 1}, {3, 2, 1}}}));
  for (const std::uint32_t s : {top[1], bottom[0], top[0], top[1]}) part.queue(s);
  EXPECT_EQ(complaint_of(part, parts.control), "nothing");
  parts.insert_in_facet(part[bottom[0]].facet, {1.25, 0.75, 0});
  ASSERT_FALSE(part[bottom[0]].alive);
  part.queue(bottom[0]);
  EXPECT_EQ(complaint_of(part, parts.control), "nothing");
  for (const std::uint32_t s : {top[1], top[0], kNone}) EXPECT_EQ(part.take_queued(), s);
  EXPECT_TRUE(part.queue_empty());
}

TEST(Subfacets, TheMissingAreQueued) {
  Parts parts;
  parts.subfacets.settle(3, {});
  EXPECT_EQ(taken_from(parts.subfacets), std::vector<std::uint32_t>{3});
}

// With the Gabriel property, also those with any vertex in their diametral ball.
TEST(Subfacets, TheEncroachedAreQueuedIfTheirBallsAreToBeEmpty) {
  for (const Surface& surface : {box(), prism({{0, 0}, {3, 0}, {3, 2}, {0, 2}}, 0.25)}) {
    Parts strict(true, surface), lazy(false, surface);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t s = 0; s < strict.subfacets.size(); ++s) {
      // Two of its edges are perpendicular: the third one is a diameter.
      const auto& v = strict.subfacets[s].v;
      int right = 0;
      const auto corner = [&](int i) {
        return strict.points.nearest(v[static_cast<std::size_t>(i % 3)]);
      };
      while (dot(subtract(corner(right + 1), corner(right)),
                 subtract(corner(right + 2), corner(right))) != 0) {
        ASSERT_LT(++right, 3);
      }
      if (std::ranges::any_of(strict.all_vertices(), [&](VertexId w) {
            const Vec3 x = strict.points.nearest(w);
            return dot(subtract(corner(right + 1), x), subtract(corner(right + 2), x)) < 0;
          })) {
        expected.push_back(s);
      }
    }
    EXPECT_GT(expected.size(), 0U);
    EXPECT_LT(expected.size(), 24U);
    EXPECT_EQ(taken_from(strict.subfacets), expected);
    EXPECT_TRUE(lazy.subfacets.queue_empty());
  }
}

// Whoever names a subfacet knows its new number: neighbours, subsegments, tetrahedra and the queue.
TEST(Subfacets, RenumberingKeepsOrderAndInvariants) {
  Parts parts;
  parts.insert_some();
  Subfacets& part = parts.subfacets;
  std::vector<std::array<VertexId, 3>> before, after;
  for (const Subfacet& f : part.planar()) {
    if (f.alive) before.push_back(f.v);
  }
  ASSERT_LT(before.size(), part.size());
  part.queue(part.size() - 1);
  const auto queued = part[part.size() - 1].v;
  SubfacetsBreaker{parts}.renumber();
  for (const Subfacet& f : part.planar()) {
    EXPECT_TRUE(f.alive);
    after.push_back(f.v);
  }
  EXPECT_EQ(after, before);
  EXPECT_EQ(complaint_of(part, parts.control), "nothing");
  expect_known_by_tetrahedra(parts);
  EXPECT_EQ(part[part.take_queued()].v, queued);
  for (std::uint32_t s = 0; s < parts.subsegments.size(); ++s) {
    for (const SubfacetEdge side : parts.subsegments[s].side) {
      EXPECT_EQ(part[side.subfacet()].subsegment[side.edge()], s);
    }
  }
  parts.insert_in_facet(parts.facet_through(kBottom), {0.125, 1.875, 0});
  EXPECT_EQ(complaint_of(part, parts.control), "nothing");
}

// A face of the tetrahedrization may outlive its subfacet, and forgets it when all are renumbered.
TEST(Subfacets, TetrahedraDoNotNameTheDead) {
  Parts parts;
  const std::uint32_t bottom = parts.facet_through(kBottom);
  const std::uint32_t container = parts.live_in(bottom).front();
  const VertexId v = parts.points.add_explicit(1.25, 0.75, 0);
  const auto& c = parts.subfacets[container].v;
  const FaceHandle face = parts.dt.find_face(c[0], c[1], c[2]);
  const TetId t = face.tet();
  const int i = face.face();
  ASSERT_EQ(parts.subfacets.on_face(t, i), container);
  parts.planar.insert(v, parts.planar.locate(v, container).subfacet);
  ASSERT_FALSE(parts.subfacets[container].alive);
  EXPECT_EQ(parts.subfacets.on_face(t, i), kNone);
  SubfacetsBreaker{parts}.renumber();
  EXPECT_EQ(note(parts.dt, t, Note::faces) >> i & 1, 0);
  EXPECT_EQ(parts.subfacets.on_face(t, i), kNone);
}

TEST(Subfacets, TheyAreRenumberedOnlyWhereManyAreDead) {
  Parts parts;
  parts.insert_some();
  const std::uint32_t few = parts.subfacets.size();
  parts.subfacets.renumber_if_sparse();
  EXPECT_EQ(parts.subfacets.size(), few);
  const std::uint32_t bottom = parts.facet_through(kBottom);
  std::uint32_t most = 0;
  // Each point kills about as many as it leaves.
  for (int n = 0; n < 2000 && parts.subfacets.size() >= most; ++n) {
    most = parts.subfacets.size();
    parts.insert_in_facet(bottom, {0.03125 + n % 45 * 0.0625, 0.03125 + n / 45 * 0.03125, 0});
    parts.subfacets.renumber_if_sparse();
  }
  EXPECT_GT(most - parts.subfacets.size(), 4000U);
  EXPECT_LT(parts.subfacets.size(), most / 2);
  EXPECT_TRUE(std::ranges::all_of(parts.planar, [](const auto& f) { return f.alive; }));
  EXPECT_EQ(complaint_of(parts.subfacets, parts.control), "nothing");
}

TEST(Subfacets, ValidateReportsEveryBrokenInvariant) {
  using Breaker = SubfacetsBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::forget_face, "does not know of its subfacet"},
      {&Breaker::misname_face, "does not know of its subfacet"},
      {&Breaker::keep_a_mark_on_one_side, "have different marks"},
      {&Breaker::name_no_subfacet, "a subfacet that does not exist"},
      {&Breaker::claim_to_wait, "waits in no queue"},
      {&Breaker::wait_unknown, "not marked as waiting"},
      {&Breaker::ask_for_empty_balls, "is encroached"},
  };
  expect_complaints(cases, [&](auto damage) {
    Parts parts;
    parts.insert_some();
    EXPECT_EQ(complaint_of(parts.subfacets, parts.control), "nothing");
    (Breaker{parts}.*damage)();
    return complaint_of(parts.subfacets, parts.control);
  });
}

// A point that the tetrahedrization has and the facet has not.
TEST(Subfacets, ValidateFindsALostFace) {
  Parts parts;
  parts.insert_in_volume({1.25, 0.75, 0});
  EXPECT_FALSE(taken_from(parts.subfacets).empty());
  EXPECT_NE(complaint_of(parts.subfacets, parts.control).find("is not a face"), std::string::npos);
}

}  // namespace
}  // namespace delmesher::refine
