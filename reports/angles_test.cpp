#include "reports/angles.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace tetproof {
namespace {

constexpr Corners kRegular = {Point{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
constexpr Corners kCorner = {Point{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

Corners scaled(Corners corners, double factor) {
  for (Point& p : corners) {
    for (double& x : p) x *= factor;
  }
  return corners;
}

TEST(Angles, RegularTetrahedron) {
  for (const double angle : dihedral_angles(kRegular)) {
    EXPECT_NEAR(angle, 70.528779365509308, 1e-12);  // acos(1/3)
  }
  for (const double angle : triangle_angles(kRegular[0], kRegular[1], kRegular[2])) {
    EXPECT_NEAR(angle, 60, 1e-12);
  }
}

TEST(Angles, CornerOfACube) {
  const auto d = dihedral_angles(kCorner);
  for (int e = 0; e < 3; ++e) EXPECT_NEAR(d[e], 90, 1e-12) << e;  // edges at the right angle
  for (int e = 3; e < 6; ++e) EXPECT_NEAR(d[e], 54.735610317245346, 1e-12) << e;  // atan(sqrt 2)
  const auto a = triangle_angles(kCorner[0], kCorner[1], kCorner[2]);
  EXPECT_NEAR(a[0], 90, 1e-12);
  EXPECT_NEAR(a[1], 45, 1e-12);
  EXPECT_NEAR(a[2], 45, 1e-12);
}

// Each dihedral angle stands at its own edge: a wedge of 30 degrees at edge 01 and no other.
TEST(Angles, EdgesAreInOrder) {
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  const Corners at_01 = {Point{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {c, s, 0.5}};
  constexpr int kPairs[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  for (int e = 0; e < 6; ++e) {
    Corners p;
    const auto [i, j] = kPairs[e];
    int next = 2;
    for (int k = 0; k < 4; ++k) p[k] = k == i ? at_01[0] : k == j ? at_01[1] : at_01[next++];
    const auto angles = dihedral_angles(p);
    EXPECT_NEAR(angles[e], 30, 1e-12) << e;
    EXPECT_EQ(
        std::count_if(angles.begin(), angles.end(), [](double x) { return std::fabs(x - 30) < 1; }),
        1);
  }
}

TEST(Angles, AnyScale) {
  for (const double factor : {0x1p-1000, 0x1p-300, 0x1p-70, 1.0, 0x1p70, 0x1p300, 0x1p1000}) {
    const auto d = dihedral_angles(scaled(kCorner, factor));
    const auto expected = dihedral_angles(kCorner);
    for (int e = 0; e < 6; ++e) EXPECT_NEAR(d[e], expected[e], 1e-12) << factor;
    const Corners p = scaled(kRegular, factor);
    EXPECT_NEAR(triangle_angles(p[0], p[1], p[2])[1], 60, 1e-12) << factor;
    EXPECT_EQ(orientation(p), orientation(kRegular));
  }
}

TEST(Angles, FlatAndDegenerate) {
  // A square seen as a tetrahedron: its sides have 180 or 0 degrees.
  const Corners square = {Point{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  auto d = dihedral_angles(square);
  std::sort(d.begin(), d.end());
  EXPECT_EQ(d[0], 0);
  EXPECT_EQ(d[3], 0);
  EXPECT_EQ(d[4], 180);
  EXPECT_EQ(d[5], 180);
  EXPECT_EQ(orientation(square), 0);
  const Corners point = {Point{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  for (const double angle : dihedral_angles(point)) EXPECT_EQ(angle, 0);
  EXPECT_EQ(triangle_angles({0, 0, 0}, {1, 1, 1}, {3, 3, 3}), (std::array<double, 3>{0, 180, 0}));
}

TEST(Angles, TinyAnglesKeepTheirDigits) {
  const auto a = triangle_angles({0, 0, 0}, {1, 0, 0}, {1, 1e-12, 0});
  EXPECT_NEAR(a[0] * M_PI / 180, 1e-12, 1e-24);
  // A sliver of height 1e-9 over a square's diagonal.
  const Corners sliver = {Point{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 1e-9}};
  const auto d = dihedral_angles(sliver);
  EXPECT_NEAR(*std::min_element(d.begin(), d.end()) * M_PI / 180, 1e-9, 1e-10);
}

// A needle whose faces have angles near 1e-9: plain doubles would be wrong here. The exact angle
// at edge 01 between two half-planes that differ by 90 degrees is 90.
TEST(Angles, NeedlesAreMeasuredExactly) {
  const Corners needle = {
      Point{0, 0, 0}, {0x1p30, 0x1p-30, 0x1p-30}, {0x1p29, 0x1p-20, 0}, {0x1p29, 0, 0x1p-20}};
  const double at_01 = dihedral_angles(needle)[0];
  EXPECT_NEAR(at_01, 90, 0.2);  // to first order; the next line is the sharp test
  const auto all = dihedral_angles(needle);
  const auto moved = dihedral_angles({needle[1], needle[0], needle[3], needle[2]});
  EXPECT_NEAR(all[0], moved[0], 1e-9);
}

TEST(Orientation, SignsAndAntisymmetry) {
  EXPECT_EQ(orientation(kCorner), 1);
  Corners swapped = kCorner;
  std::swap(swapped[1], swapped[2]);
  EXPECT_EQ(orientation(swapped), -1);
}

// Near-degenerate points on a grid, against the determinant in rationals written out another way.
TEST(Orientation, AgainstRationals) {
  std::mt19937_64 random(20);
  std::uniform_int_distribution<int> grid(0, 2), ulp(-1, 1), rare(0, 3);
  int zeros = 0, tiny = 0;
  for (int i = 0; i < 20000; ++i) {
    Corners p;
    for (Point& q : p) {
      for (double& x : q) x = 1e3 + grid(random) + (rare(random) == 0 ? ulp(random) * 0x1p-43 : 0);
    }
    mpq_class m[4][3];
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 3; ++c) m[r][c] = p[r][c];
    }
    // Expansion of |p 1| by the last column, whose sign is that of det(d-a, ...) up to order.
    const auto det3 = [&](int a, int b, int c) -> mpq_class {
      return m[a][0] * (m[b][1] * m[c][2] - m[b][2] * m[c][1]) -
             m[a][1] * (m[b][0] * m[c][2] - m[b][2] * m[c][0]) +
             m[a][2] * (m[b][0] * m[c][1] - m[b][1] * m[c][0]);
    };
    const mpq_class volume = det3(1, 2, 3) - det3(0, 2, 3) + det3(0, 1, 3) - det3(0, 1, 2);
    ASSERT_EQ(orientation(p), sgn(volume)) << i;
    zeros += sgn(volume) == 0;
    tiny += sgn(volume) != 0 && abs(volume) < 1e-9;
  }
  EXPECT_GT(zeros, 100);
  EXPECT_GT(tiny, 100);
}

}  // namespace
}  // namespace tetproof
