#include "mesher/remesh/coverage.h"

#include <gtest/gtest.h>

#include <random>

namespace delmesher::remesh {
namespace {

Vec3 random_point(std::mt19937_64& random, double low, double high) {
  std::uniform_real_distribution<double> place(low, high);
  return {place(random), place(random), place(random)};
}

const auto kNoMore = [](const Vec3&) {};

Simplex triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return Simplex({a, b, c});
}

// A grid of squares, each two triangles, in the plane z = 0.
std::vector<Simplex> flat_grid(int n) {
  std::vector<Simplex> triangles;
  const auto at = [&](int i, int j) { return Vec3{1.0 * i / n, 1.0 * j / n, 0}; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      triangles.push_back(triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1)));
      triangles.push_back(triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1)));
    }
  }
  return triangles;
}

bool covers(double distance, const std::vector<Simplex>& candidates, const Simplex& simplex) {
  Coverage coverage(distance * (1 - 0x1p-20));
  for (std::uint32_t i = 0; i < candidates.size(); ++i) coverage.add(i, candidates[i]);
  return coverage.covers(simplex, candidates.size(), kNoMore);
}

// The nearest point is in the triangle, and no point of a fine grid of it is nearer.
TEST(Coverage, NearestPoint) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 200; ++k) {
    const Simplex s = triangle(random_point(random, 0, 1), random_point(random, 0, 1),
                               random_point(random, 0, 1));
    const Vec3 p = random_point(random, -1, 2);
    const double found = distance(p, nearest_point(p, s));
    double least = HUGE_VAL;
    constexpr int kSteps = 60;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const Vec3 q = add_scaled(
            add_scaled(s.corner[0], 1.0 * i / kSteps, subtract(s.corner[1], s.corner[0])),
            1.0 * j / kSteps, subtract(s.corner[2], s.corner[0]));
        least = std::min(least, distance(p, q));
      }
    }
    EXPECT_LE(found, least + 1e-12);
    EXPECT_GE(found, least - 2.0 / kSteps);
  }
}

// A large triangle just above many small ones, however small the distance is.
TEST(Coverage, CutsAlongSides) {
  for (const double distance : {1e-2, 1e-6, 1e-9}) {
    const double height = distance * 0.9;
    const Simplex above = triangle({0.05, 0.1, height}, {0.95, 0.2, height}, {0.3, 0.9, height});
    EXPECT_TRUE(covers(distance, flat_grid(10), above)) << distance;
    const Simplex beyond =
        triangle({0.05, 0.1, height}, {0.95, 0.2, height}, {0.3, 0.9, 1.2 * distance});
    EXPECT_FALSE(covers(distance, flat_grid(10), beyond)) << distance;
  }
}

// What a hole leaves bare is seen if it is wider than the distance allows.
TEST(Coverage, SeesAHole) {
  std::vector<Simplex> grid = flat_grid(10);
  grid.erase(grid.begin() + 110);
  const Simplex above = triangle({0.05, 0.1, 0}, {0.95, 0.2, 0}, {0.3, 0.9, 0});
  EXPECT_FALSE(covers(1e-3, grid, above));
  EXPECT_TRUE(covers(0.05, grid, above));
  Coverage coverage(1e-3);
  for (std::uint32_t i = 0; i < grid.size(); ++i) coverage.add(i, grid[i]);
  const Simplex missing = flat_grid(10)[110];
  EXPECT_TRUE(
      coverage.covers(above, grid.size(), [&](const Vec3&) { coverage.add(1000, missing); }));
  EXPECT_NE(std::ranges::find(coverage.used(), 1000U), coverage.used().end());
}

// Many candidates are asked for piece by piece.
TEST(Coverage, OfMany) {
  const std::vector<Simplex> grid = flat_grid(30);
  const Simplex above = triangle({0.05, 0.1, 0}, {0.95, 0.2, 0}, {0.3, 0.9, 0});
  constexpr std::uint32_t kUnder = 2 * (12 * 30 + 12);  // its corner nearest to 0 is at 0.4
  for (const bool hole : {false, true}) {
    Coverage coverage(1e-3);
    coverage.clear(true);
    EXPECT_EQ(coverage.covers(above, grid.size(),
                              [&](const Vec3& p) {
                                for (std::uint32_t i = 0; i < grid.size(); ++i) {
                                  const bool near = squared_distance(p, grid[i]) <= 1e-6;
                                  if (near && !(hole && i == kUnder)) coverage.add(i, grid[i]);
                                }
                              }),
              !hole);
  }
}

// Whatever is said to be covered is: points of the triangle are near one of the candidates.
TEST(Coverage, IsNeverWrong) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> share(0, 1);
  int yes = 0;
  for (int k = 0; k < 400; ++k) {
    std::vector<Simplex> grid = flat_grid(4);
    for (Simplex& s : grid) {
      for (Vec3& p : s.corner) p[2] = 0.1 * std::sin(7 * p[0]) * std::cos(5 * p[1]);
      s = Simplex(s.corner);
    }
    const double distance = 0.02 + 0.1 * share(random);
    std::array<Vec3, 3> corners = {random_point(random, 0, 1), random_point(random, 0, 1),
                                   random_point(random, 0, 1)};
    for (Vec3& p : corners) p[2] = 0.15 * (p[2] - 0.5);
    const Simplex s(corners);
    if (!covers(distance, grid, s)) continue;
    ++yes;
    for (int i = 0; i < 200; ++i) {
      const double v = share(random), w = (1 - v) * share(random);
      const Vec3 p = add_scaled(add_scaled(s.corner[0], v, subtract(s.corner[1], s.corner[0])), w,
                                subtract(s.corner[2], s.corner[0]));
      double least = HUGE_VAL;
      for (const Simplex& t : grid) least = std::min(least, std::sqrt(squared_distance(p, t)));
      EXPECT_LE(least, distance);
    }
  }
  EXPECT_GT(yes, 100);
}

TEST(Coverage, OfSegments) {
  const auto segment = [](Vec3 a, Vec3 b) { return Simplex(a, b); };
  const std::vector<Simplex> chain = {segment({0, 0, 0}, {1, 0, 0}),
                                      segment({1, 0, 0}, {2, 0.1, 0}),
                                      segment({2, 0.1, 0}, {3, 0, 0})};
  EXPECT_TRUE(covers(0.11, chain, segment({0, 0, 0}, {3, 0, 0})));
  EXPECT_FALSE(covers(0.05, chain, segment({0, 0, 0}, {3, 0, 0})));
  EXPECT_FALSE(covers(0.11, chain, segment({0, 0, 0}, {3.2, 0, 0})));
}

}  // namespace
}  // namespace delmesher::remesh
