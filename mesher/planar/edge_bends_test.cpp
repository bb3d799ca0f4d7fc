#include "mesher/planar/edge_bends.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesher/surface/test_surfaces.h"

namespace delmesher::planar {
namespace {

using namespace surface::test_surfaces;  // NOLINT(google-build-using-namespace)

constexpr double kRounding = 1e-14, kLeast = 1e-9, kMost = 1e-3;
constexpr std::ptrdiff_t kFewest = 8;

// `n` bends of evenly spread sizes up to `most`, to both sides by turns.
std::vector<double> spread(int n, double most) {
  std::vector<double> bends;
  for (int i = 1; i <= n; ++i) bends.push_back((i % 2 == 0 ? most : -most) * i / n);
  return bends;
}

double noise(std::vector<double> bends, const std::vector<double>& more = {},
             double rounding = kRounding) {
  bends.insert(bends.end(), more.begin(), more.end());
  return noise_of_bends(bends, rounding, kLeast, kMost, kFewest);
}

TEST(EdgeBends, ConvexAndConcaveEdges) {
  const double height = 0.01;
  Surface s = box({0, 0, 0}, {2, 1, 1}, 2);
  for (Point& p : s.vertices) {
    if (p[0] == 1 && p[2] == 1) p[2] += height;
    if (p[0] == 1 && p[2] == 0) p[2] += height / 2;
  }
  const std::vector<double> bends = edge_bends(s);
  const auto like = [&](double x) {
    return std::ranges::count_if(bends, [=](double y) { return std::fabs(x - y) < 1e-4 * height; });
  };
  // Noise of two edges each. The triangles' common centroid is at two thirds of the height: two
  // corners of either triangle are on the edge.
  EXPECT_EQ(like(height / 3 * 2), 2);
  EXPECT_EQ(like(-height / 3), 2);
  EXPECT_GT(std::ranges::count(bends, HUGE_VAL), 0);
}

TEST(EdgeBends, NoiseIsWhereBendsEnd) {
  const double found = noise(spread(40, 1e-5), {2e-4, HUGE_VAL, HUGE_VAL});
  EXPECT_GT(found, 0.8e-5);
  EXPECT_LE(found, 1e-5);
  EXPECT_EQ(noise(spread(40, 1.5 * kMost)), 0);
  EXPECT_EQ(noise(spread(40, 0.9 * kLeast)), 0);
}

TEST(EdgeBends, AFewBendsTellNothing) {
  EXPECT_GT(noise(spread(8, 1e-5)), 0);
  EXPECT_EQ(noise(spread(7, 1e-5)), 0);
}

// Two noises are one that has hardly a large bend, unless it is known up to where the bends are of
// the finer rounding.
TEST(EdgeBends, OfAFinerRoundingHideNoise) {
  const std::vector<double> finer = spread(400, kLeast), own = spread(40, 1e-5);
  EXPECT_EQ(noise(finer, own), 0);
  EXPECT_GT(noise(finer, own, kLeast), 0.8e-5);
}

// So many larger ones that the smaller ones may be the beginning of these.
TEST(EdgeBends, ThatGoOnAreMeant) {
  EXPECT_GT(noise(spread(42, 1e-5), {2e-5, -2e-5, 2.5e-5, -2.5e-5, 3e-5, -3e-5}), 0);
  std::vector<double> going_on;
  for (double x = 1e-8; x < 4 * kMost; x *= 1.02) going_on.insert(going_on.end(), {x, -x});
  EXPECT_EQ(noise(going_on), 0);
}

// Grooves of one depth, to both sides.
TEST(EdgeBends, OfOneSizeAreMeant) {
  std::vector<double> grooves;
  for (int i = 0; i < 100; ++i) grooves.insert(grooves.end(), {1e-5, -1e-5});
  EXPECT_EQ(noise(grooves), 0);
}

// A dome.
TEST(EdgeBends, ToOneSideAreMeant) {
  std::vector<double> dome = spread(40, 1e-5);
  for (double& x : dome) x = std::fabs(x);
  EXPECT_EQ(noise(dome), 0);
  for (double& x : dome) x = -x;
  EXPECT_EQ(noise(dome), 0);
}

// Few bends of one side after the first end, and then none at all: noise is up to there.
TEST(EdgeBends, NoiseMayHaveATail) {
  std::vector<double> tail;
  for (int i = 0; i < 12; ++i) tail.push_back(1e-5 * (1.2 + 0.05 * i));
  EXPECT_GT(noise(spread(60, 1e-5), tail), 1.1e-5);
  for (double& x : tail) x *= 2.5;
  EXPECT_LE(noise(spread(60, 1e-5), tail), 1e-5);
}

// Rounded edges, which begin where the noise ends, and are convex or concave as a rule.
TEST(EdgeBends, FilletsHideNoNoise) {
  std::vector<double> fillet;
  for (double x = 1.2e-5; x < 4 * kMost; x *= 1.1) fillet.push_back(x);
  for (const double side : {-1, 1}) {
    for (double& x : fillet) x *= side;
    const double found = noise(spread(40, 1e-5), fillet);
    EXPECT_GT(found, 0.8e-5);
    EXPECT_LE(found, 1e-5);
  }
  std::vector<double> both = fillet;
  for (const double x : fillet) both.push_back(-x);
  EXPECT_EQ(noise(spread(40, 1e-5), both), 0);
}

// More of the larger ones are to one side than noise would have, though of all they are not.
TEST(EdgeBends, ADomeOnAFlatFaceIsMeant) {
  std::vector<double> dome;
  for (int i = 0; i < 40; ++i) dome.push_back(1e-5 * (0.3 + 0.7 * i / 40));
  const double found = noise(spread(60, 3e-6), dome);
  EXPECT_GT(found, 2e-6);
  EXPECT_LE(found, 3e-6);
}

// Much larger than most are.
TEST(EdgeBends, AboveTheNoiseAreMeant) {
  const std::vector<double> steps = {1e-6, -2e-6, 4e-6, -8e-6, 9e-6, -9e-6};
  EXPECT_EQ(noise(spread(200, kLeast), steps), 0);
}

}  // namespace
}  // namespace delmesher::planar
