// The badness of tetrahedra whose angles and edges are known.
#include "mesher/refine/goal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mesher/refine/test_complexes.h"

namespace delmesher::refine {
namespace {

std::uint8_t badness(const Goal& goal, const std::array<Vec3, 4>& p) {
  PointStore points;
  for (const Vec3& x : p) points.add_explicit(x[0], x[1], x[2]);
  const VertexId v[4] = {0, 1, 2, 3};
  return goal.badness(points, v);
}

constexpr std::array<Vec3, 4> kRegular = {Vec3{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};

// A spire of height h over an equilateral triangle with sides of length 1: the angles at its top
// have the cosine 1 - 1 / (2 h^2 + 2 / 3).
std::array<Vec3, 4> spire(double height) {
  const double r = 1 / std::sqrt(3.0);
  return {Vec3{r, 0, 0}, {-r / 2, 0.5, 0}, {-r / 2, -0.5, 0}, {0, 0, height}};
}

TEST(Goal, AFaceAngleBelowTheBoundIsBad) {
  for (const double height : {1.0, 2.0, 4.0, 8.0}) {
    const double angle = std::acos(1 - 1 / (2 * height * height + 2.0 / 3)) / kDegree;
    EXPECT_EQ(badness(Goal(angle - 0.01, false, 0), spire(height)), 0) << height;
    EXPECT_GT(badness(Goal(angle + 0.01, false, 0), spire(height)), 0) << height;
  }
}

// The tetrahedron is so small that the doubles of its vertices do not tell its angles: whatever may
// be below the bound is bad. (Its one implicit point is known in extended precision.)
TEST(Goal, WhatRoundingMayHideIsBad) {
  using Exact = std::array<long double, 3>;
  for (const double u : {0.1, 0.2, 0.3, 0.6, 0.7}) {
    PointStore points;
    const Vec3 a = {1, 0.3, 0.7}, b = {-0.2, 1.1, 0.4};
    const VertexId v = points.add_explicit(a[0], a[1], a[2]),
                   w = points.add_explicit(b[0], b[1], b[2]);
    const VertexId top = points.add_on_segment(v, w, u);
    ASSERT_GT(points.approximation(top).error, 0);
    std::array<VertexId, 4> tet = {0, 0, 0, top};
    std::array<Exact, 4> p;
    const std::array<Vec3, 4> shape = spire(2);
    for (int i = 0; i < 4; ++i) {
      Vec3 x = points.nearest(top);
      for (int k = 0; k < 3; ++k) {
        x[k] += 0x1p-40 * (shape[i][k] - shape[3][k]);
        p[i][k] = i < 3 ? x[k] : a[k] * static_cast<long double>(u) + b[k] * (1.0L - u);
      }
      if (i < 3) tet[i] = points.add_explicit(x[0], x[1], x[2]);
    }
    long double least = 180;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < j; ++k) {
          if (i == j || i == k) continue;
          long double xy = 0, xx = 0, yy = 0;
          for (int c = 0; c < 3; ++c) {
            const long double x = p[j][c] - p[i][c], y = p[k][c] - p[i][c];
            xy += x * y;
            xx += x * x;
            yy += y * y;
          }
          least = std::min(least, std::acos(xy / std::sqrt(xx * yy)) / kDegree);
        }
      }
    }
    const auto angle = static_cast<double>(least);
    EXPECT_GT(Goal(angle * (1 + 1e-5), false, 0).badness(points, tet.data()), 0) << u;
    EXPECT_EQ(Goal(angle * 0.9, false, 0).badness(points, tet.data()), 0) << u;
  }
}

// On explicit points the bound itself is doubtful only in the last digits.
TEST(Goal, AnAngleOfTheBoundIsBadOrJustAboveIt) {
  for (const double height : {1.0, 2.0, 4.0}) {
    const double angle = std::acos(1 - 1 / (2 * height * height + 2.0 / 3)) / kDegree;
    EXPECT_GT(badness(Goal(angle, false, 0), spire(height)), 0) << height;
  }
}

TEST(Goal, WorseRatiosHaveHigherLevels) {
  std::uint8_t last = 0;
  for (const double height : {2.0, 4.0, 8.0, 16.0, 1e3, 1e9}) {
    const std::uint8_t level = badness(Goal(40, false, 0), spire(height));
    EXPECT_GT(level, last);
    last = level;
  }
  // Four points of a line have no circumcentre.
  const std::array<Vec3, 4> flat = {Vec3{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  EXPECT_EQ(badness(Goal(10, false, 0), flat), Goal::kWorst);
}

TEST(Goal, SliversAreBadIfAsked) {
  // A square with its diagonals a little apart: no small face angle.
  const auto sliver = [](double apart) {
    return std::array{Vec3{1, 0, apart}, Vec3{0, 1, 0}, Vec3{-1, 0, apart}, Vec3{0, -1, 0}};
  };
  // Its shortest edge is the root of 2 (with the square of `apart` added), 7.2 times 0.1964.
  EXPECT_EQ(badness(Goal(14, false, 0), sliver(0.01)), 0);
  EXPECT_EQ(badness(Goal(14, true, 0), sliver(0.21)), 0);
  EXPECT_GT(badness(Goal(14, true, 0), sliver(0.19)), 0);
}

TEST(Goal, LongEdgesAreBadIfBounded) {
  const double edge = std::sqrt(8.0);
  EXPECT_EQ(badness(Goal(30, true, 0), kRegular), 0);
  EXPECT_EQ(badness(Goal(30, true, edge * 1.001), kRegular), 0);
  EXPECT_GT(badness(Goal(30, true, edge * 0.999), kRegular), 0);
}

// The source is in the centre, at a distance of 1 from the middle of each edge.
TEST(Goal, EdgesAboveTheSizeFieldAreBad) {
  const double edge = std::sqrt(8.0);
  for (const double growth : {0.1, 0.5, 1.0}) {
    const auto level = [&](double size) {
      const SizeField sizes(std::vector<SizeSource>{{{0, 0, 0}, size}}, growth);
      return badness(Goal(30, true, 0, &sizes), kRegular);
    };
    EXPECT_EQ(level(edge - growth + 0.001), 0) << growth;
    EXPECT_GT(level(edge - growth - 0.001), 0) << growth;
  }
  const SizeField none;
  EXPECT_EQ(badness(Goal(30, true, 0, &none), kRegular), 0);
}

TEST(Goal, TheOffCentreMeetsTheAngle) {
  for (const double delta : {5.0, 14.0, 25.0}) {
    const double height = std::sqrt(Goal(delta, false, 0).offcentre2());
    EXPECT_NEAR(2 * std::atan(0.5 / height) / kDegree, delta, 1e-9);
  }
}

}  // namespace
}  // namespace delmesher::refine
