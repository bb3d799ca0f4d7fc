#include "mesher/planar/resolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "mesher/surface/test_surfaces.h"

namespace delmesher::planar {
namespace {

using namespace surface::test_surfaces;  // NOLINT(google-build-using-namespace)

constexpr double kAnything = 1e6;
// Half a unit on each of three axes.
double half(double unit) {
  return unit * std::sqrt(3) / 2;
}

Surface part() {
  return rotated(box({0, 0, 0}, {50, 70, 90}, 5));
}

Surface moved(Surface s, double by) {
  for (Point& p : s.vertices) {
    for (double& x : p) x += by;
  }
  return s;
}

TEST(Resolution, OfDecimalsIsTheLastPlaceThatAnyNeeds) {
  for (const double unit : {0.1, 1e-3, 1e-6}) {
    EXPECT_NEAR(rounding_of_coordinates(in_decimals(part(), unit), kAnything), half(unit),
                1e-9 * unit);
  }
  Surface s = in_decimals(scaled(part(), 0.3), 1e-3);  // no number has six digits
  s.vertices.front()[0] = 0.1234;
  EXPECT_NEAR(rounding_of_coordinates(s, kAnything), half(1e-4), 1e-13);
  EXPECT_NEAR(rounding_of_coordinates(s, kAnything), half(1e-3), half(9.1e-4));
}

// Six digits of numbers up to 99.9999, some of which begin far behind the point.
TEST(Resolution, OfPrintedDigitsIsThatOfTheLargestNumber) {
  Surface s = part();
  for (Point& p : s.vertices) {
    for (double& x : p) {
      char text[32];
      std::snprintf(text, sizeof text, "%.6g", x);
      x = std::strtod(text, nullptr);
    }
  }
  s.vertices.front() = {0.00123456, 0.000123456, 1.23456e-7};
  double squares = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double largest = 0;
    for (const Point& p : s.vertices) largest = std::max(largest, std::fabs(p[i]));
    squares += std::pow(10, 2 * (std::floor(std::log10(largest)) - 5));
  }
  EXPECT_NEAR(rounding_of_coordinates(s, kAnything), std::sqrt(squares) / 2, 1e-9);
}

TEST(Resolution, OfSinglePrecisionIsThatOfTheLargestNumber) {
  const Surface s = in_single_precision(moved(part(), 5000));  // up to 8191
  EXPECT_EQ(rounding_of_coordinates(s, kAnything), half(0x1p-11));
  // Decimals that were rounded once more.
  EXPECT_NEAR(rounding_of_coordinates(in_single_precision(in_decimals(part(), 1e-2)), kAnything),
              half(1e-2), 1e-9);
}

TEST(Resolution, DoublesAndIntegersHaveNone) {
  EXPECT_EQ(rounding_of_coordinates(part(), kAnything), 0);
  Surface integers = in_decimals(rotated(box({0, 0, 0}, {4e7, 5e7, 6e7}, 3)), 1);
  integers.vertices.front()[0] = 16777217;  // no float
  EXPECT_EQ(rounding_of_coordinates(integers, kAnything), 0);
}

TEST(Resolution, APlaceTooCoarseIsMeant) {
  const Surface tenths = box({0, 0, 0}, {0.1, 0.2, 0.3});
  EXPECT_EQ(rounding_of_coordinates(tenths, 1e-3), 0);
  const Surface halves = box({0, 0, 0}, {0.5, 0.5, 0.5});  // of single precision
  EXPECT_EQ(rounding_of_coordinates(halves, 1e-3), half(0x1p-24));
  EXPECT_EQ(rounding_of_coordinates(halves, 1e-9), 0);
}

}  // namespace
}  // namespace delmesher::planar
