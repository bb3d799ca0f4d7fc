// Distances from segments, against rational arithmetic.
#include "mesher/plane/line.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace delmesher::plane {
namespace {

mpq_class exact_square(const Line& l, const Point& p) {
  const mpq_class ux = mpq_class(l.b[0]) - l.a[0], uy = mpq_class(l.b[1]) - l.a[1];
  const mpq_class wx = mpq_class(p[0]) - l.a[0], wy = mpq_class(p[1]) - l.a[1];
  const mpq_class all = ux * ux + uy * uy;
  mpq_class along = all == 0 ? mpq_class(0) : mpq_class((ux * wx + uy * wy) / all);
  if (along < 0) along = 0;
  if (along > 1) along = 1;
  const mpq_class dx = wx - along * ux, dy = wy - along * uy;
  return dx * dx + dy * dy;
}

// Is d the distance except for a relative error of 2^-25?
testing::AssertionResult is_distance(const Line& l, const Point& p, double d) {
  const mpq_class square = exact_square(l, p), low = mpq_class(d) * (1 - 0x1p-25),
                  high = mpq_class(d) * (1 + 0x1p-25);
  if (low * low <= square && square <= high * high) return testing::AssertionSuccess();
  return testing::AssertionFailure() << d << " for the square root of " << square.get_d();
}

TEST(Line, DistanceWithBothEndsFarAway) {
  const Line l = {{-1e24, -3e23}, {7e23, 2.1e23}};
  for (const Point& p : {Point{0, 0}, Point{4e-5, 0}, Point{0, -4e-5}, Point{1e3, 300}}) {
    EXPECT_TRUE(is_distance(l, p, l.distance_to(p)));
  }
  const Line level = {{-1e24, 4e-5}, {2e24, 4e-5}};
  EXPECT_EQ(level.distance_to({3, 0}), 4e-5);
  EXPECT_EQ(level.distance_to({3, 4e-5}), 0);
}

TEST(Line, DistanceInAllScales) {
  std::mt19937_64 random(1);
  const auto coordinate = [&](int low, int high) {
    const int exponent = low + static_cast<int>(random() % static_cast<unsigned>(high - low));
    return std::ldexp(static_cast<double>(random() >> 11) * 0x1p-52 - 1, exponent);
  };
  for (int i = 0; i < 20000; ++i) {
    const int low = i % 3 == 0 ? -480 : -100, high = i % 3 == 0 ? -400 : 100;
    const auto point = [&] { return Point{coordinate(low, high), coordinate(low, high)}; };
    const Line l = {point(), point()};
    // Anywhere, or as near to the segment as doubles allow.
    const Point p = i % 2 == 0 ? point() : l.at(static_cast<double>(random() >> 11) * 0x1p-53);
    ASSERT_TRUE(is_distance(l, p, l.distance_to(p))) << i;
  }
}

TEST(Line, DistanceFromAPointAndOfASegmentWithoutLength) {
  const Line l = {{1, 2}, {1, 2}};
  EXPECT_EQ(l.distance_to({4, 6}), 5);
  EXPECT_EQ(l.distance_to({1, 2}), 0);
}

}  // namespace
}  // namespace delmesher::plane
