#include "mesher/plane/chamfer.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "mesher/plane/test_graphs.h"

namespace delmesher::plane::chamfer_test {
namespace {

using namespace test_graphs;
using Point = std::array<double, 2>;

// Is the angle at the origin between u and w, below 90 degrees, less than the one with that cosine?
bool is_below(const Point& u, const Point& w, double cosine_squared) {
  const mpq_class ux = u[0], uy = u[1], wx = w[0], wy = w[1], dot = ux * wx + uy * wy;
  return dot > 0 &&
         dot * dot > mpq_class(cosine_squared) * (ux * ux + uy * uy) * (wx * wx + wy * wy);
}

bool is_chamfered(const Stages& s, std::uint32_t number) {
  return std::any_of(
      s.chamfered.corners.begin(), s.chamfered.corners.end(),
      [&](const PlaneRecord::Corner& corner) { return corner.vertex == s.vertex(number); });
}

// Angles at the origin: how many are below the threshold, and about how many doubles are wrong.
struct Decided {
  int below = 0, doubles_err = 0;

  void decide(const Point& u, const Point& w, const ChamferOptions& options) {
    const bool expected = is_below(u, w, options.cosine_squared);
    const Stages s(ring({{0, 0}, u, w}), options);
    EXPECT_EQ(is_chamfered(s, 0), expected) << u[0] << " " << u[1] << ", " << w[0] << " " << w[1];
    below += expected;
    const double dot = u[0] * w[0] + u[1] * w[1];
    const double bound =
        options.cosine_squared * (u[0] * u[0] + u[1] * u[1]) * (w[0] * w[0] + w[1] * w[1]);
    doubles_err += (dot * dot > bound) != expected;
  }
};

// Near a right angle, where the products of the dot product cancel: of 500 angles within a few
// millionths of a billionth of the threshold, doubles are wrong about some.
TEST(PlaneChamfer, AnglesAtTheThresholdAreDecidedExactly) {
  ChamferOptions options;
  options.cosine_squared = 1e-18;  // of the driver for 90 degrees
  std::mt19937 random(1);
  const auto fraction = [&] { return static_cast<double>(random()) / 0x1p32; };
  Decided counts;
  for (int i = 0; i < 500; ++i) {
    const Point u = {0.25 + fraction(), 0.25 + fraction()};
    const double cosine = 1e-9 * (1 + 4e-7 * (2 * fraction() - 1));
    const Point w = {cosine * u[0] - u[1], cosine * u[1] + u[0]};
    counts.decide(u, w, options);
  }
  EXPECT_GT(counts.below, 100);
  EXPECT_LT(counts.below, 400);
  EXPECT_GT(counts.doubles_err, 10);  // or this is not a test
}

// Squares of so short a segment are subnormal numbers, which have few digits.
TEST(PlaneChamfer, TinyCornersAreDecidedExactly) {
  ChamferOptions options;
  options.cosine_squared = 0.25;
  std::mt19937 random(1);
  const auto fraction = [&] { return static_cast<double>(random()) / 0x1p32; };
  Decided counts;
  for (int i = 0; i < 200; ++i) {
    const Point u = {0.25 + fraction(), 0.25 + fraction()};
    const double size = 0x1p-534 * (1 + fraction()), sine = 0.75 + fraction() / 4;
    const Point w = {size * (u[0] / 2 - sine * u[1]), size * (u[1] / 2 + sine * u[0])};
    counts.decide(u, w, options);
  }
  EXPECT_GT(counts.below, 50);
  EXPECT_LT(counts.below, 150);
  EXPECT_GT(counts.doubles_err, 5);  // or this is not a test
}

}  // namespace
}  // namespace delmesher::plane::chamfer_test
