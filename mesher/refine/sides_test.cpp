#include "mesher/refine/sides.h"

#include <gtest/gtest.h>

#include <optional>

#include "mesher/refine/test_parts.h"

namespace delmesher::refine {

// Breaks one invariant at a time.
struct SidesBreaker {
  Sides& sides;

  void turn(TetId t) const {
    sides.set(t, sides.known_inside(t) ? Sides::State::outside : Sides::State::inside);
  }
  void straddle(TetId t) const { sides.set(t, Sides::State::straddling); }
  void leave_asked(TetId t) const { sides.set(t, Sides::State::asked); }
  bool unknown(TetId t) const { return sides.state(t) == Sides::State::unknown; }
};

namespace {

constexpr Box kEverything = {{-9, -9, -9}, {9, 9, 9}};

struct Sided : Parts {
  std::vector<Box> removed;
  std::optional<Sides> sides;

  explicit Sided(std::vector<Box> open = {}) : removed(std::move(open)) {
    sides.emplace(plc(), topology, points, dt, subfacets, removed);
  }
  std::vector<TetId> finite() const {
    std::vector<TetId> all = live_tetrahedra();
    std::erase_if(all, [&](TetId t) { return dt.is_ghost(t); });
    return all;
  }
  // The box is convex: a tetrahedron with all corners in it is inside, any other one outside.
  Side expected(TetId t) const {
    const VertexId* v = dt.vertices(t);
    const bool in = std::all_of(v, v + 4, [&](VertexId w) {
      const Vec3 p = points.nearest(w);
      return p[0] >= 0 && p[0] <= 3 && p[1] >= 0 && p[1] <= 2 && p[2] >= 0 && p[2] <= 1;
    });
    return in ? Side::inside : Side::outside;
  }
  bool known(TetId t) const { return sides->known_inside(t) || sides->known_outside(t); }
  std::size_t count_known() const {
    const std::vector<TetId> all = finite();
    return static_cast<std::size_t>(std::ranges::count_if(all, [&](TetId t) { return known(t); }));
  }
};

TEST(Sides, FoundFromOneAndPassedOn) {
  Sided box;
  EXPECT_EQ(box.count_known(), 0U);
  std::size_t inside = 0;
  const std::vector<TetId> all = box.finite();
  EXPECT_EQ(box.sides->of(all.back()), box.expected(all.back()));
  EXPECT_GT(box.count_known(), all.size() / 2);
  for (const TetId t : all) {
    EXPECT_EQ(box.sides->of(t), box.expected(t));
    EXPECT_EQ(box.sides->known_inside(t), box.expected(t) == Side::inside);
    EXPECT_EQ(box.sides->known_outside(t), box.expected(t) == Side::outside);
    inside += box.expected(t) == Side::inside ? 1 : 0;
  }
  EXPECT_GE(inside, 5U);
  EXPECT_LT(inside, all.size());
  EXPECT_EQ(complaint_of(*box.sides), "nothing");
}

// Near the removed part of the surface each tetrahedron must be tested by itself, and no side is
// passed on to it.
TEST(Sides, NearTheRemovedPartEachIsTested) {
  Sided everywhere(std::vector<Box>{kEverything});
  const std::vector<TetId> all = everywhere.finite();
  for (std::size_t n = 0; n < all.size(); ++n) {
    EXPECT_EQ(everywhere.count_known(), n);
    EXPECT_EQ(everywhere.sides->of(all[n]), everywhere.expected(all[n]));
  }
  Sided corner(std::vector<Box>{Box{{-0.125, -0.125, -0.125}, {0.125, 0.125, 0.125}}});
  for (const TetId t : corner.finite()) EXPECT_EQ(corner.sides->of(t), corner.expected(t));
  EXPECT_EQ(complaint_of(*corner.sides), "nothing");
}

TEST(Sides, SharedAmongThreadsOnlyWhereEachIsTested) {
  Sided box(std::vector<Box>{Box{{-9, -9, -9}, {0.5, 9, 9}}});
  Limits limits;
  limits.threads = 2;
  Control two(limits);
  box.sides->classify_near_removed(two);
  const std::vector<TetId> all = box.finite();
  std::size_t here = 0;
  for (const TetId t : all) {
    const VertexId* v = box.dt.vertices(t);
    const bool near =
        std::any_of(v, v + 4, [&](VertexId w) { return box.points.nearest(w)[0] <= 0.5; });
    EXPECT_TRUE(box.known(t) || !near);
    here += box.known(t) ? 1 : 0;
  }
  EXPECT_GT(here, 0U);
  for (const TetId t : all) EXPECT_EQ(box.sides->of(t), box.expected(t));
}

// The tetrahedra that replace a cavity have the side that all of the cavity had; unknown if those
// differ.
TEST(Sides, WhatACavityHasInCommonIsInherited) {
  Sided box;
  const std::vector<TetId> first = box.finite();
  EXPECT_EQ(box.sides->common_of_cavity(), Sides::State::unknown);
  for (const TetId t : first) box.sides->of(t);
  struct Case {
    Vec3 place;
    Sides::State common;
  };
  // The last is in the bottom, which has tetrahedra on both sides.
  for (const auto& [place, common] :
       {Case{{1.5, 1, 0.5}, Sides::State::inside}, Case{{4, 1, 0.5}, Sides::State::outside},
        Case{{1.25, 0.75, 0}, Sides::State::unknown}}) {
    const VertexId v = box.points.add_explicit(place[0], place[1], place[2]);
    box.find_cavity(v);
    const Sides::State found = box.sides->common_of_cavity();
    EXPECT_EQ(found, common);
    box.fill_cavity(v);
    for (const TetId t : box.dt.created()) {
      box.sides->inherit(t, found);
      if (box.dt.is_ghost(t)) continue;
      EXPECT_EQ(SidesBreaker{*box.sides}.unknown(t), common == Sides::State::unknown);
      if (common != Sides::State::unknown) {
        EXPECT_EQ(box.sides->of(t), box.expected(t));
      }
    }
  }
}

// Parts of a tetrahedron that the surface cuts need not be cut.
TEST(Sides, StraddlingIsNotInherited) {
  Sided box;
  for (const TetId t : box.finite()) SidesBreaker{*box.sides}.straddle(t);
  box.find_cavity(box.points.add_explicit(1.5, 1, 0.5));
  ASSERT_FALSE(box.dt.cavity().empty());
  EXPECT_EQ(box.sides->common_of_cavity(), Sides::State::unknown);
}

TEST(Sides, ValidateReportsEveryBrokenInvariant) {
  const auto said_after = [](void (SidesBreaker::*damage)(TetId) const, std::vector<Box> removed) {
    Sided box(std::move(removed));
    for (const TetId t : box.finite()) box.sides->of(t);
    EXPECT_EQ(complaint_of(*box.sides), "nothing");
    (SidesBreaker{*box.sides}.*damage)(box.finite().front());
    return complaint_of(*box.sides);
  };
  EXPECT_NE(said_after(&SidesBreaker::turn, {}).find("disagree"), std::string::npos);
  EXPECT_NE(said_after(&SidesBreaker::leave_asked, {}).find("asked"), std::string::npos);
  // The surface between two may belong to the removed part.
  EXPECT_EQ(said_after(&SidesBreaker::turn, {kEverything}), "nothing");
}

// The sides at the end of a refinement are those of the exact test against the whole surface.
TEST(Sides, ThoseOfARefinementAreExact) {
  for (const Surface& surface : {box(), ell(), wedge(), tent()}) {
    for (const unsigned threads : {1U, 2U}) {
      Complex complex(surface);
      complex.limits.threads = threads;
      Control control(complex.limits);
      RefineOptions options;
      for (const auto& t : complex.topology.triangles) {
        Box all;
        for (const VertexId v : t)
          all.extend({complex.points.nearest(v), complex.points.nearest(v)});
        if (complex.chamfered.acute_vertices > 0) options.removed.push_back(all);
      }
      const RefineResult result = refine(complex.plc(), complex.topology, complex.points,
                                         complex.predicates, options, control);
      ASSERT_FALSE(result.runaway);
      Solid solid(complex.topology, complex.predicates);
      std::size_t of[3] = {};
      for (std::size_t n = 0; n < result.tetrahedra.size(); ++n) {
        EXPECT_EQ(result.side[n], solid.classify(result.tetrahedra[n]));
        ++of[static_cast<std::size_t>(result.side[n])];
      }
      EXPECT_GT(of[static_cast<std::size_t>(Side::inside)], 0U);
      EXPECT_GT(of[static_cast<std::size_t>(Side::outside)], 0U);
      EXPECT_EQ(of[static_cast<std::size_t>(Side::straddling)] > 0,
                complex.chamfered.acute_vertices > 0);
    }
  }
}

}  // namespace
}  // namespace delmesher::refine
