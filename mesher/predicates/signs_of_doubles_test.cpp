#include "mesher/predicates/signs_of_doubles.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "mesher/predicates/rational_reference.h"

namespace delmesher::predicates::signs_of_doubles_test {
namespace {

using Vec2 = std::array<double, 2>;

int orient3d_in_rationals(const std::array<Vec3, 4>& x) {
  std::array<reference::Point, 4> p;
  for (std::size_t n = 0; n < 4; ++n) {
    for (std::size_t i = 0; i < 3; ++i) p[n][i] = reference::rational(x[n][i]);
  }
  return reference::orient3d(p.data());
}

int orient2d_in_rationals(const std::array<Vec2, 3>& x) {
  std::array<reference::Point, 3> p;
  for (std::size_t n = 0; n < 3; ++n) {
    p[n] = {reference::rational(x[n][0]), reference::rational(x[n][1]), 0};
  }
  return reference::orient2d(2, p.data());
}

TEST(SignsOfDoubles, DecideWhatRoundingHides) {
  const double tiny = std::ldexp(1.0, -1074), huge = 1e308;
  EXPECT_EQ(orient2d_sign({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orient2d_sign({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(orient2d_sign({0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}), 0);
  EXPECT_EQ(orient2d_sign({0.5, 0.5}, {12, 12}, {24, std::nextafter(24.0, 25)}), 1);
  EXPECT_EQ(orient2d_sign({0, 0}, {tiny, 0}, {0, tiny}), 1);
  EXPECT_EQ(orient2d_sign({-huge, -huge}, {huge, huge}, {huge, -huge}), -1);
  EXPECT_EQ(orient2d_sign({-huge, -huge}, {huge, huge}, {tiny, 0}), -1);
  EXPECT_EQ(orient2d_sign({-huge, -huge}, {huge, huge}, {tiny, tiny}), 0);
  EXPECT_EQ(orient3d_sign({0.1, 0.1, 0.2}, {0.3, 0.7, 1.0}, {0, 0, 0}, {0.1, 0.1, 0.2}), 0);
  EXPECT_NE(orient3d_sign({1, 0, 0}, {0, 1, 0}, {1, 1, tiny}, {0, 0, 0}), 0);
  EXPECT_EQ(orient3d_sign({1, 2, 3}, {2, 4, 6}, {huge, 0, 0}, {0, 0, 0}), 0);
  EXPECT_EQ(orient3d_sign({1, 2, 5}, {2, 4, 5}, {huge, 0, 5}, {0, 7, 5}), 0);
}

TEST(SignsOfDoubles, AntisymmetricOnNearDegenerateTriples) {
  std::mt19937_64 random(3);
  int zeros = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto wiggle = [&](double x) {
      return x + std::ldexp(static_cast<double>(random() % 5) - 2, -52);
    };
    const std::array<double, 2> a = {wiggle(0.5), wiggle(0.5)}, b = {wiggle(0.75), wiggle(0.75)},
                                c = {wiggle(0.9), wiggle(0.9)};
    const int sign = orient2d_sign(a, b, c);
    zeros += sign == 0 ? 1 : 0;
    EXPECT_EQ(sign, -orient2d_sign(b, a, c));
    EXPECT_EQ(sign, orient2d_sign(b, c, a));
  }
  EXPECT_GT(zeros, 10);
  EXPECT_LT(zeros, 2900);
}

TEST(SignsOfDoubles, AgreeWithRationals) {
  std::mt19937_64 random(5);
  int zeros = 0, signs = 0;
  for (int round = 0; round < 4000; ++round) {
    // Small integers times powers of two: often coplanar, now and then far apart in size.
    const int spread = round % 3 == 0 ? 600 : round % 3 == 1 ? 3 : 0;
    std::array<Vec3, 4> x;
    for (Vec3& p : x) {
      for (double& c : p) {
        const int exponent = spread == 0 ? 0 : static_cast<int>(random() % (2 * spread)) - spread;
        c = std::ldexp(static_cast<double>(random() % 7) - 3, exponent);
      }
    }
    const int expected = orient3d_in_rationals(x);
    EXPECT_EQ(orient3d_sign(x[0], x[1], x[2], x[3]), expected);
    ++(expected == 0 ? zeros : signs);
  }
  EXPECT_GT(zeros, 50);
  EXPECT_GT(signs, 1000);
}

// Vertices an ulp or so from a plane, far from and near the origin, whose coordinates need all bits
// and more: flat tetrahedra after rounding.
TEST(SignsOfDoubles, AgreeWithRationalsNearPlanes) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::array<int, 3> seen{};
  for (int round = 0; round < 6000; ++round) {
    const double offset = round % 3 == 0 ? 0 : std::ldexp(1.5, static_cast<int>(random() % 12));
    const double size = std::ldexp(1, -static_cast<int>(random() % 40));
    const double scale = std::ldexp(1, static_cast<int>(random() % 1900) - 950);
    std::array<Vec3, 4> x;
    for (int n = 0; n < 3; ++n) {
      for (double& c : x[n]) c = scale * (offset + size * unit(random));
    }
    const double s = unit(random), t = unit(random);
    for (int i = 0; i < 3; ++i) {
      x[3][i] = x[0][i] + s * (x[1][i] - x[0][i]) + t * (x[2][i] - x[0][i]);
      for (auto steps = random() % 3; steps > 0; --steps) {
        x[3][i] = std::nextafter(x[3][i], random() % 2 == 0 ? HUGE_VAL : -HUGE_VAL);
      }
    }
    if (round % 5 == 0) x[3][2] = x[2][2] = x[1][2] = x[0][2];
    const int expected = orient3d_in_rationals(x);
    EXPECT_EQ(orient3d_sign(x[0], x[1], x[2], x[3]), expected) << round;
    ++seen[static_cast<std::size_t>(expected + 1)];
  }
  for (const int count : seen) EXPECT_GT(count, 500);
}

// Corners an ulp or so from a line, of every size, and small integers times powers of two.
TEST(SignsOfDoubles, AgreeWithRationalsInThePlane) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::array<int, 3> seen{};
  for (int round = 0; round < 6000; ++round) {
    std::array<Vec2, 3> x;
    if (round % 3 == 0) {
      const int spread = round % 2 == 0 ? 600 : 3;
      for (Vec2& p : x) {
        for (double& c : p) {
          const int exponent = static_cast<int>(random() % (2 * spread)) - spread;
          c = std::ldexp(static_cast<double>(random() % 5) - 2, exponent);
        }
      }
    } else {
      const double scale = std::ldexp(1, static_cast<int>(random() % 1900) - 950);
      const double offset = round % 3 == 1 ? 0 : 3;
      const double t = unit(random);
      for (std::size_t i = 0; i < 2; ++i) {
        x[0][i] = scale * (offset + unit(random));
        x[1][i] = scale * (offset + unit(random));
        x[2][i] = x[0][i] + t * (x[1][i] - x[0][i]);
        if (random() % 2 == 0) x[2][i] = std::nextafter(x[2][i], random() % 2 == 0 ? 9 : -9);
      }
      if (round % 5 == 0) x[2] = x[round % 2 == 0 ? 0 : 1];
    }
    const int expected = orient2d_in_rationals(x);
    EXPECT_EQ(orient2d_sign(x[0], x[1], x[2]), expected) << round;
    EXPECT_EQ(orient2d_sign(x[1], x[0], x[2]), -expected) << round;
    ++seen[static_cast<std::size_t>(expected + 1)];
  }
  for (const int count : seen) EXPECT_GT(count, 500);
}

}  // namespace
}  // namespace delmesher::predicates::signs_of_doubles_test
