// Searches that pass over most of a surface: do they find what all of it has, and how fast?
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "oracles/base/exact_points.h"
#include "oracles/base/steps.h"
#include "oracles/cgal/near_triangles.h"
#include "oracles/mesh/solids.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::searches_test {
namespace {

using namespace oracles;  // NOLINT
using Triangle = std::array<Index, 3>;
using Pair = std::pair<Index, Index>;

std::uint64_t steps_of(const auto& work) {
  const std::uint64_t before = steps;
  work();
  return steps - before;
}

// ----------------------------------------------------------------------- triangles that are near

// Turned, so that nothing lies along an axis.
Position turned(const Position& p) {
  const double x = 0.8 * p[0] - 0.6 * p[1], y = 0.6 * p[0] + 0.8 * p[1];
  return {x, 0.28 * y - 0.96 * p[2], 0.96 * y + 0.28 * p[2]};
}

// Two hubs with n triangles each, around a circle whose radius is 1 to 1 + uneven.
Polyhedron two_hubs(Index n, double uneven, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(0, 1);
  Polyhedron surface;
  surface.vertices = {turned({0, 0, 1}), turned({0, 0, -1})};
  for (Index i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n, radius = 1 + uneven * any(random);
    surface.vertices.push_back(
        turned({radius * std::cos(angle), radius * std::sin(angle), uneven * any(random)}));
    const Index a = 2 + i, b = 2 + (i + 1) % n;
    surface.triangles.push_back({0, a, b});
    surface.triangles.push_back({1, b, a});
  }
  return surface;
}

// A prism with n sides, 20 times as long as wide.
Polyhedron rod(Index n) {
  Polyhedron surface;
  for (Index i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    for (const double z : {0.0, 20.0}) {
      surface.vertices.push_back(turned({std::cos(angle), std::sin(angle), z}));
    }
    const Index a = 2 * i, b = 2 * ((i + 1) % n);
    surface.triangles.push_back({a, b, b + 1});
    surface.triangles.push_back({a, b + 1, a + 1});
    if (i > 0 && i + 1 < n) {
      surface.triangles.push_back({0, b, a});
      surface.triangles.push_back({1, a + 1, b + 1});
    }
  }
  return surface;
}

class Crossings {
 public:
  explicit Crossings(const Polyhedron& surface) : triangles_(surface.triangles) {
    EXPECT_EQ(points_.assign(surface.vertices), "");
  }

  // All pairs, each decided exactly, of points no four of which are in one plane.
  std::set<Pair> all() const {
    std::set<Pair> found;
    for (Index u = 0; u < triangles_.size(); ++u) {
      for (Index t = 0; t < u; ++t) {
        if (cross(triangles_[t], triangles_[u]) || cross(triangles_[u], triangles_[t])) {
          found.emplace(t, u);
        }
      }
    }
    return found;
  }

 private:
  int side(Index a, Index b, Index c, Index d) const {
    return exact::orient3d(points_, a, b, c, d);
  }
  // Does an edge of one, with no corner in common, go through the other?
  bool cross(const Triangle& edges, const Triangle& other) const {
    const auto& [a, b, c] = other;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index p = edges[k], q = edges[(k + 1) % 3];
      if (std::ranges::count(other, p) + std::ranges::count(other, q) > 0) continue;
      if (side(a, b, c, p) == side(a, b, c, q)) continue;
      const int s = side(p, q, a, b);
      if (side(p, q, b, c) == s && side(p, q, c, a) == s) return true;
    }
    return false;
  }

  ExactPoints points_;
  const std::vector<Triangle>& triangles_;
};

TEST(NearTriangles, AreAllThatMeet) {
  std::mt19937_64 random(20261130);
  std::uniform_real_distribution<double> any(-1, 1);
  std::size_t crossings = 0, without = 0;
  for (int n = 0; n < 12; ++n) {
    Polyhedron surface = n % 3 == 0   ? two_hubs(150, 0.001, random)
                         : n % 3 == 1 ? two_hubs(150, 0.5, random)
                                      : rod(200);
    for (Position& p : surface.vertices) {
      for (double& x : p) x += 1e-9 * any(random);
    }
    for (int moved = 0; moved < n / 3; ++moved) {
      for (double& x : surface.vertices[random() % surface.vertices.size()]) x += any(random);
    }
    // Those that are visited after boxes had too many.
    std::set<Pair> near;
    std::size_t calls = 0;
    for_each_near_pair(surface.vertices, surface.triangles, [&](Index t, Index u) {
      EXPECT_LT(t, u);
      if (++calls > kMostBoxPairs * surface.triangles.size()) near.emplace(t, u);
    });
    const std::set<Pair> crossing = Crossings(surface).all();
    EXPECT_FALSE(near.empty()) << n;
    EXPECT_TRUE(std::ranges::includes(near, crossing)) << n;
    crossings += crossing.size();
    without += crossing.empty();
  }
  EXPECT_GT(crossings, 100U);
  EXPECT_GT(without, 1U);
}

// Four times as many took 16 times as long.
TEST(NearTriangles, TakeFarLessThanQuadraticTimeAroundAVertexAndSideBySide) {
  std::mt19937_64 random(1);
  const auto cost = [](const Polyhedron& surface) {
    return steps_of(
        [&] { for_each_near_pair(surface.vertices, surface.triangles, [](Index, Index) {}); });
  };
  const auto growth = [&](double uneven) {
    return static_cast<double>(cost(two_hubs(4000, uneven, random))) /
           static_cast<double>(cost(two_hubs(1000, uneven, random)));
  };
  EXPECT_LT(growth(0), 8);
  EXPECT_LT(growth(0.001), 8);
  EXPECT_LT(growth(0.5), 11);
  EXPECT_LT(cost(rod(4000)), 8 * cost(rod(1000)));
}

// ------------------------------------------------------------------------------- rays and parts

void add_box(Polyhedron& surface, const Position& low, const Position& high) {
  const auto first = static_cast<Index>(surface.vertices.size());
  for (std::size_t k = 0; k < 8; ++k) {
    surface.vertices.push_back(
        {k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]});
  }
  constexpr Triangle kTriangles[] = {{3, 1, 0}, {2, 3, 0}, {5, 7, 4}, {7, 6, 4},
                                     {1, 5, 0}, {5, 4, 0}, {7, 3, 2}, {6, 7, 2},
                                     {6, 2, 0}, {4, 6, 0}, {7, 5, 1}, {3, 7, 1}};
  for (const auto& [a, b, c] : kTriangles) {
    surface.triangles.push_back({a + first, b + first, c + first});
  }
}

// Of each point: 1 inside, 0 outside, -1 on the surface.
std::vector<int> insides(const Polyhedron& surface, const std::vector<Position>& asked) {
  std::vector<Position> positions = surface.vertices;
  positions.insert(positions.end(), asked.begin(), asked.end());
  ExactPoints points;
  EXPECT_EQ(points.assign(positions), "");
  InputSurface input;
  EXPECT_EQ(input.assign(surface, points), "");
  std::vector<int> found;
  for (std::size_t n = 0; n < asked.size(); ++n) {
    const auto v = static_cast<Index>(surface.vertices.size() + n);
    found.push_back(input.inside(points, {&v, 1}));
  }
  return found;
}

// Boxes on each other, within each other and beside each other; what is inside is known by heart.
TEST(RayParts, ArePassedOverWhereTheyCountForNothing) {
  Polyhedron surface;
  for (int i = 0; i < 5; ++i) add_box(surface, {0, 0, 10.0 * i}, {9, 9, 10.0 * i + 9});
  add_box(surface, {1, 1, 11}, {8, 8, 18});   // a hollow
  add_box(surface, {2, 2, 12}, {7, 7, 17});   // with something in it
  add_box(surface, {20, 0, 0}, {29, 9, 49});  // beside them all
  const std::vector<std::pair<Position, int>> known = {
      {{4, 5, 4.5}, 1}, {{4, 5, 9.5}, 0},  {{4, 5, 10.5}, 1}, {{4, 5, 11.5}, 0},
      {{4, 5, 14}, 1},  {{4, 5, 17.5}, 0}, {{4, 5, 18.5}, 1}, {{4, 5, 19.5}, 0},
      {{4, 5, 48}, 1},  {{4, 5, 49.5}, 0}, {{4, 5, -1}, 0},   {{12, 5, 14}, 0},
      {{25, 5, 14}, 1}, {{4, 5, 9}, -1},   {{4, 5, 10}, -1},  {{4, 5, 17}, -1},
      {{4, 5, 49}, -1}, {{0.5, 1, 12}, 1}, {{8.5, 1, 12}, 1}, {{7.5, 5, 12}, 0}};
  std::vector<Position> asked;
  for (const auto& [p, inside] : known) asked.push_back(p);
  const std::vector<int> found = insides(surface, asked);
  for (std::size_t n = 0; n < known.size(); ++n) {
    EXPECT_EQ(found[n], known[n].second) << known[n].first[0] << " " << known[n].first[2];
  }
}

TEST(RayParts, CountIfTheyAreOpen) {
  ExactPoints points;
  ASSERT_EQ(points.assign(std::vector<Position>{
                {0, 0, 5}, {4, 0, 5}, {0, 4, 5}, {0, 0, 7}, {4, 0, 7}, {0, 4, 7}, {1, 1, 0}}),
            "");
  const Index v = 6;
  const RayCrossings one = RayTarget(points, {{0, 1, 2}}).above({&v, 1});
  EXPECT_EQ(one.count, 1U);
  EXPECT_EQ(one.winding, 1);
  const RayCrossings two = RayTarget(points, {{0, 1, 2}, {3, 5, 4}}).above({&v, 1});
  EXPECT_EQ(two.count, 2U);
  EXPECT_EQ(two.winding, 0);
  // Closed, but not turned consistently: the same triangle twice.
  const RayCrossings twice = RayTarget(points, {{0, 1, 2}, {0, 1, 2}}).above({&v, 1});
  EXPECT_EQ(twice.count, 2U);
  EXPECT_EQ(twice.winding, 2);
}

// Four times as many took 16 times as long.
TEST(RayParts, TakeNearlyLinearTimeInAStack) {
  const auto cost = [](int n) {
    Polyhedron surface;
    std::vector<Position> asked;
    for (int i = 0; i < n; ++i) {
      add_box(surface, {0, 0, 10.0 * i}, {9, 9, 10.0 * i + 9});
      asked.push_back({4, 5, 10.0 * i + 4.5});
    }
    return steps_of([&] {
      for (const int inside : insides(surface, asked)) EXPECT_EQ(inside, 1);
    });
  };
  EXPECT_LT(cost(1000), 8 * cost(250));
}

}  // namespace
}  // namespace tetproof::searches_test
