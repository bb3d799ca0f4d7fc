#include "mesher/refine/bad_tetrahedra.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "mesher/geometry/vector.h"
#include "mesher/refine/test_complexes.h"
#include "mesher/refine/tetrahedron_shape.h"

namespace delmesher::refine {

// Breaks one invariant at a time.
struct BadTetrahedraBreaker {
  BadTetrahedra& bad;

  void lose_entries() const {
    for (std::vector<TetId>& level : bad.level_) level.clear();
  }
  void lower_the_worst() const { bad.worst_ = 6; }
  void name_an_unknown() const { bad.level_[7].push_back(~TetId{0}); }
  void lose_fresh() const { bad.fresh_.pop_back(); }
  void repeat_fresh() const { bad.fresh_.push_back(bad.fresh_.front()); }
};

namespace {

struct Cube {
  PointStore points;
  Predicates predicates{points};
  Limits limits;
  Control control{limits};
  Tetrahedrization dt{predicates};
  BadTetrahedra bad;
  std::vector<TetId> finite;

  explicit Cube(bool largest_ratio_first = false) : bad(dt, points, largest_ratio_first) {
    std::vector<VertexId> vertices;
    for (int n = 0; n < 64; ++n) {
      vertices.push_back(points.add_explicit(n / 16, n / 4 % 4, n % 4));
    }
    dt.build(vertices, control);
    for (TetId t = 0; t < dt.capacity(); ++t) {
      if (dt.alive(t) && !dt.is_ghost(t)) finite.push_back(t);
    }
    bad.start();
  }
};

TEST(BadTetrahedra, WorstFirst) {
  Cube cube;
  ASSERT_GT(cube.finite.size(), 100U);
  for (std::size_t n = 0; n < cube.finite.size(); ++n) {
    cube.bad.add(cube.finite[n], static_cast<std::uint8_t>(1 + n * 37 % Goal::kWorst));
  }
  EXPECT_NO_THROW(cube.bad.validate());
  std::vector<TetId> seen;
  std::uint8_t last = Goal::kWorst;
  for (TetId t = cube.bad.next(); t != kNone; t = cube.bad.next()) {
    const std::uint8_t level = note(cube.dt, t, Note::waiting);
    EXPECT_LE(level, last);
    last = level;
    EXPECT_EQ(cube.bad.next(), t);  // it waits on
    cube.bad.dismiss(t);
    seen.push_back(t);
    EXPECT_NO_THROW(cube.bad.validate());
  }
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(seen, cube.finite);
}

// The squared radius-edge ratio, of a circumcentre that solves its three equations.
double squared_ratio(const Cube& cube, TetId t) {
  TetrahedronShape s = shape_of(cube.points, cube.dt.vertices(t));
  add_circumsphere(s);
  for (const Vec3& p : s.p) {
    const Vec3 d = subtract(p, s.center);
    EXPECT_NEAR(dot(d, d), s.radius2, 1e-9 * s.radius2);
  }
  return s.radius2 / s.shortest2();
}

TEST(BadTetrahedra, LargestRatioFirstWhateverTheLevel) {
  Cube cube(true);
  // New vertices at irregular places give tetrahedra of many ratios, and leave dead ones.
  for (const TetId t : cube.finite) cube.bad.add(t, 5);
  for (const Vec3& at : {Vec3{1.25, 1.375, 1.4375}, Vec3{0.3125, 2.75, 1.0625}}) {
    const VertexId p = cube.points.add_explicit(at[0], at[1], at[2]);
    TetId start = 0;
    while (!cube.dt.alive(start) || cube.dt.is_ghost(start)) ++start;
    ASSERT_TRUE(cube.dt.insert(p, start));
    cube.bad.add_fresh(cube.dt.created());
  }
  cube.bad.judge_fresh([&](TetId t) { return std::uint8_t(cube.dt.is_ghost(t) ? 0 : 1 + t % 9); });
  EXPECT_NO_THROW(cube.bad.validate());
  std::vector<double> ratios;
  std::vector<TetId> seen, expected;
  for (TetId t = cube.bad.next(); t != kNone; t = cube.bad.next()) {
    ratios.push_back(squared_ratio(cube, t));
    seen.push_back(t);
    cube.bad.dismiss(t);
  }
  EXPECT_TRUE(std::is_sorted(ratios.rbegin(), ratios.rend()));
  EXPECT_GT(ratios.front(), 2 * ratios.back());
  for (TetId t = 0; t < cube.dt.capacity(); ++t) {
    if (cube.dt.alive(t) && !cube.dt.is_ghost(t)) expected.push_back(t);
  }
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(seen, expected);
}

// A level that is used for the first time is in an order in which neighbours are near each other;
// tetrahedra that are added later are taken first.
TEST(BadTetrahedra, ALevelIsSortedInSpaceAndThenAStack) {
  Cube cube;
  std::vector<TetId> shuffled(cube.finite.size());
  for (std::size_t n = 0; n < shuffled.size(); ++n) {
    shuffled[n] = cube.finite[n * 101 % cube.finite.size()];
  }
  ASSERT_EQ(std::gcd(std::size_t{101}, shuffled.size()), 1U);
  const auto way = [&](const std::vector<TetId>& order) {
    double sum = 0;
    for (std::size_t n = 1; n < order.size(); ++n) {
      sum += distance(cube.points.nearest(cube.dt.vertex(order[n - 1], 0)),
                      cube.points.nearest(cube.dt.vertex(order[n], 0)));
    }
    return sum;
  };
  for (const TetId t : shuffled) cube.bad.add(t, 9);
  std::vector<TetId> taken;
  for (TetId t = cube.bad.next(); t != kNone; t = cube.bad.next()) {
    taken.push_back(t);
    cube.bad.dismiss(t);
  }
  EXPECT_LT(way(taken), way(shuffled) / 3);
  cube.bad.add(cube.finite[3], 9);
  cube.bad.add(cube.finite[8], 9);
  EXPECT_EQ(cube.bad.next(), cube.finite[8]);
}

TEST(BadTetrahedra, TheDeadAreForgotten) {
  Cube cube;
  for (const TetId t : cube.finite) cube.bad.add(t, 5);
  const VertexId p = cube.points.add_explicit(1.25, 1.375, 1.4375);
  ASSERT_TRUE(cube.dt.insert(p, 0));
  cube.bad.add_fresh(cube.dt.created());
  cube.bad.add_fresh(cube.dt.created());  // no matter how often
  EXPECT_NO_THROW(cube.bad.validate());
  std::size_t judged = 0;
  cube.bad.judge_fresh([&](TetId t) {
    EXPECT_GE(cube.dt.index_of(t, p), 0);
    ++judged;
    return std::uint8_t{0};
  });
  EXPECT_EQ(judged, cube.dt.created().size());
  EXPECT_NO_THROW(cube.bad.validate());
  for (TetId t = cube.bad.next(); t != kNone; t = cube.bad.next()) {
    EXPECT_TRUE(cube.dt.alive(t));
    EXPECT_LT(cube.dt.index_of(t, p), 0);
    cube.bad.dismiss(t);
  }
}

TEST(BadTetrahedra, ValidateReportsEveryBrokenInvariant) {
  using Breaker = BadTetrahedraBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::lose_entries, "waits at no level"},
      {&Breaker::lower_the_worst, "above the worst level"},
      {&Breaker::name_an_unknown, "waits that does not exist"},
      {&Breaker::lose_fresh, "fresh tetrahedron"},
      {&Breaker::repeat_fresh, "judged twice"},
  };
  expect_complaints(cases, [&](auto damage) {
    Cube cube;
    cube.bad.add(cube.finite[0], 7);
    cube.bad.add_fresh(std::array{cube.finite[1], cube.finite[2]});
    EXPECT_EQ(complaint_of(cube.bad), "nothing");
    (Breaker{cube.bad}.*damage)();
    return complaint_of(cube.bad);
  });
}

}  // namespace
}  // namespace delmesher::refine
