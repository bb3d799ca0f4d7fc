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
    while (!part.list_[s].alive) ++s;
    return s;
  }
  // One with an edge that is no subsegment.
  SubfacetEdge inner() const {
    SubfacetEdge e(live(), 0);
    while (!part.list_[e.subfacet()].neighbor[e.edge()].exists()) e = {e.subfacet(), e.edge() + 1};
    return e;
  }
  TetId marked() const {
    TetId t = 0;
    while (!parts.dt.alive(t) || !part.any_on(t)) ++t;
    return t;
  }
  void turn() const { std::swap(part.list_[live()].v[0], part.list_[live()].v[1]); }
  void unlink() const { part.list_[inner().subfacet()].neighbor[inner().edge()] = {}; }
  void link_to_no_edge() const {
    part.list_[inner().subfacet()].neighbor[inner().edge()] = {part.size(), 0};
  }
  void link_to_itself() const { part.list_[inner().subfacet()].neighbor[inner().edge()] = inner(); }
  // Seen from below, circles have their inside outside.
  void look_from_below() const {
    const std::uint32_t f = part.list_[inner().subfacet()].facet;
    const auto& frame = parts.plc().facets[f].frame;
    for (const VertexId v : parts.all_vertices()) {
      if (parts.predicates.orient3d(frame[0], frame[1], frame[2], v) < 0)
        part.planes_[f].off_plane = v;
    }
  }
  void kill() const {
    part.list_[live()].alive = false;
    ++part.dead_;
  }
  void kill_uncounted() const { part.list_[live()].alive = false; }
  void forget_face() const { note(parts.dt, marked(), Note::faces) = 0; }
  void misname_face() const {
    for (std::uint32_t& s : part.on_face_[marked()]) ++s;
  }
  void claim_to_wait() const { WorkQueueBreaker{part.queue_}.claim_to_wait(live()); }
  void wait_unknown() const { part.queue_.add(part.size()); }
  void ask_for_empty_balls() const { part.gabriel_ = true; }
};

namespace {

// Brute force: the subfacets of each facet are the Delaunay triangulation of its vertices.
void expect_delaunay(const Parts& parts) {
  for (std::uint32_t f = 0; f < parts.plc().facets.size(); ++f) {
    std::vector<VertexId> vertices;
    for (const std::uint32_t s : parts.live_in(f)) {
      for (const VertexId v : parts.subfacets[s].v) vertices.push_back(v);
    }
    for (const std::uint32_t s : parts.live_in(f)) {
      const auto& [a, b, c] = parts.subfacets[s].v;
      EXPECT_GT(parts.subfacets.orient(f, a, b, c), 0);
      for (const VertexId v : vertices) {
        EXPECT_TRUE(v == a || v == b || v == c || !parts.subfacets.in_circle(s, v));
      }
    }
  }
}

// The area within the boundary as it is given by the complex.
void expect_tiling(const Parts& parts) {
  for (std::uint32_t f = 0; f < parts.plc().facets.size(); ++f) {
    Vec3 expected{}, sum{};
    double total = 0;
    const PlcFacet& facet = parts.plc().facets[f];
    for (const PlcFacet::Side& side : facet.boundary) {
      auto [a, b] = parts.plc().segments[side.segment].vertex;
      if (side.reversed) std::swap(a, b);
      const Vec3 part = parts.area(facet.frame[0], a, b);
      for (int k = 0; k < 3; ++k) expected[k] += part[k];
    }
    for (const std::uint32_t s : parts.live_in(f)) {
      const auto& [a, b, c] = parts.subfacets[s].v;
      const Vec3 part = parts.area(a, b, c);
      for (int k = 0; k < 3; ++k) sum[k] += part[k];
      total += norm(part);
    }
    EXPECT_LT(distance(sum, expected), 1e-12 * norm(expected));
    EXPECT_NEAR(total, norm(expected), 1e-12 * total);  // none upside down, none twice
  }
}

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

TEST(Subfacets, FacetsAreTriangulated) {
  for (const Surface& surface : {box(), ell(), wedge(), tent()}) {
    const Parts parts(false, surface);
    ASSERT_TRUE(parts.subfacets.built());
    expect_tiling(parts);
    expect_delaunay(parts);
  }
  Parts parts;
  EXPECT_EQ(parts.subfacets.size(), 24U);
  ASSERT_TRUE(parts.subfacets.queue_empty());
  expect_known_by_tetrahedra(parts);
  EXPECT_EQ(complaint_of(parts.subfacets, parts.control), "nothing");
}

TEST(Subfacets, PointsAreLocatedFromAnywhereInTheirFacet) {
  Parts parts;
  parts.insert_some();
  const std::uint32_t bottom = parts.facet_through(kBottom);
  const Subfacets& part = parts.subfacets;
  const std::vector<std::uint32_t> live = parts.live_in(bottom);
  ASSERT_GT(live.size(), 6U);
  for (const std::uint32_t start : live) {
    for (const auto& [x, y] :
         {std::array{0.25, 1.875}, std::array{2.75, 0.125}, std::array{1.5, 1.0}}) {
      const VertexId v = parts.points.add_explicit(x, y, 0);
      const auto [s, blocked] = part.locate(v, start);
      ASSERT_NE(s, kNone);
      EXPECT_EQ(blocked, kNone);
      EXPECT_EQ(part[s].facet, bottom);
      for (std::uint32_t i = 0; i < 3; ++i) {
        const auto [from, to] = part.ends({s, i});
        EXPECT_GE(part.orient(bottom, from, to, v), 0);
      }
    }
    // Beyond a side, seen through one of its subsegments, with the point on their other side.
    const VertexId outside = parts.points.add_explicit(1.375, -0.25, 0);
    const auto [s, blocked] = part.locate(outside, start);
    EXPECT_EQ(s, kNone);
    ASSERT_NE(blocked, kNone);
    EXPECT_EQ(parts.subsegments[blocked].segment, parts.segment(0, 1));
  }
}

TEST(Subfacets, PointsAreInsertedInTheirFacetAndOnItsSides) {
  Parts parts;
  const std::uint32_t bottom = parts.facet_through(kBottom);
  const VertexId v = parts.insert_in_facet(bottom, {1.25, 0.75, 0});
  EXPECT_EQ(parts.subfacets.created().size(), 4U);
  for (const std::uint32_t s : parts.subfacets.created()) EXPECT_EQ(parts.subfacets[s].v[0], v);
  EXPECT_EQ(parts.live_in(bottom).size(), 4U);
  const std::uint32_t half = parts.split(parts.segment(0, 1));
  EXPECT_EQ(parts.live_in(bottom).size(), 5U);
  for (const std::uint32_t s : {parts.segment(0, 1), half}) {
    for (const SubfacetEdge side : parts.subsegments[s].side) {
      ASSERT_TRUE(side.exists());
      EXPECT_EQ(parts.subfacets[side.subfacet()].subsegment[side.edge()], s);
      EXPECT_EQ(
          parts.subsegments.find(parts.subfacets.ends(side)[0], parts.subfacets.ends(side)[1]), s);
    }
  }
  parts.insert_in_facet(bottom, {0.125, 1.875, 0});
  parts.split(half);
  parts.split(parts.segment(2, 3));
  parts.insert_in_facet(bottom, {2.875, 0.25, 0});
  ASSERT_TRUE(parts.subfacets.queue_empty());
  expect_tiling(parts);
  expect_delaunay(parts);
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
  for (const Subfacets::Subfacet& f : part) {
    if (f.alive) before.push_back(f.v);
  }
  ASSERT_LT(before.size(), part.size());
  part.queue(part.size() - 1);
  const auto queued = part[part.size() - 1].v;
  SubfacetsBreaker{parts}.renumber();
  for (const Subfacets::Subfacet& f : part) {
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
  parts.subfacets.insert(v, parts.subfacets.locate(v, container).subfacet);
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
  EXPECT_TRUE(std::ranges::all_of(parts.subfacets, [](const auto& f) { return f.alive; }));
  EXPECT_EQ(complaint_of(parts.subfacets, parts.control), "nothing");
}

TEST(Subfacets, ValidateReportsEveryBrokenInvariant) {
  using Breaker = SubfacetsBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::turn, "turned over"},
      {&Breaker::unlink, "has no other side"},
      {&Breaker::link_to_no_edge, "no such neighbour"},
      {&Breaker::link_to_itself, "disagree about their common edge"},
      {&Breaker::look_from_below, "not Delaunay"},
      {&Breaker::kill, "disagree about their common edge"},
      {&Breaker::kill_uncounted, "are not counted"},
      {&Breaker::forget_face, "does not know of its subfacet"},
      {&Breaker::misname_face, "does not know of its subfacet"},
      {&Breaker::claim_to_wait, "waits in no queue"},
      {&Breaker::wait_unknown, "is not queued"},
      {&Breaker::ask_for_empty_balls, "is encroached"},
  };
  for (const auto& [damage, reason] : cases) {
    Parts parts;
    parts.insert_some();
    ASSERT_EQ(complaint_of(parts.subfacets, parts.control), "nothing");
    (Breaker{parts}.*damage)();
    const std::string said = complaint_of(parts.subfacets, parts.control);
    EXPECT_NE(said.find(reason), std::string::npos) << said << ", not " << reason;
  }
}

// A point that the tetrahedrization has and the facet has not.
TEST(Subfacets, ValidateFindsALostFace) {
  Parts parts;
  parts.insert_in_volume({1.25, 0.75, 0});
  EXPECT_FALSE(taken_from(parts.subfacets).empty());
  EXPECT_NE(complaint_of(parts.subfacets, parts.control).find("is no face"), std::string::npos);
}

}  // namespace
}  // namespace delmesher::refine
