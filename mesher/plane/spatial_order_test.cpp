#include "mesher/plane/spatial_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "mesher/plane/bad_triangles.h"

namespace delmesher::plane {
namespace {

std::vector<std::array<double, 2>> random_points(std::size_t n) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> coordinate(-3, 5);
  std::vector<std::array<double, 2>> points(n);
  for (auto& p : points) p = {coordinate(random), coordinate(random)};
  return points;
}

bool is_permutation(std::vector<std::uint32_t> order) {
  std::sort(order.begin(), order.end());
  for (std::uint32_t n = 0; n < order.size(); ++n) {
    if (order[n] != n) return false;
  }
  return true;
}

TEST(SpatialOrder, NeighboursOnTheCurveAreClose) {
  auto points = random_points(4000);
  const auto order = order_along_curve(points);
  ASSERT_EQ(order.size(), points.size());
  EXPECT_TRUE(is_permutation(order));
  double length = 0;
  for (std::size_t n = 1; n < order.size(); ++n) {
    const auto &p = points[order[n - 1]], &q = points[order[n]];
    length += std::hypot(q[0] - p[0], q[1] - p[1]);
  }
  // A point has a neighbour at half of this distance; in no order it is 16700.
  EXPECT_LT(length, 4000 * 1.2 * std::sqrt(64.0 / 4000));
  for (const int k : {-1000, 40, 1000}) {
    auto scaled = points;
    for (auto& p : scaled) p = {std::ldexp(p[0], k), std::ldexp(p[1], k)};
    EXPECT_EQ(order_along_curve(scaled), order);
  }
}

TEST(SpatialOrder, OddSetsOfPoints) {
  EXPECT_TRUE(order_along_curve({}).empty());
  const std::vector<std::array<double, 2>> same(3, {0.5, -7});
  EXPECT_EQ(order_along_curve(same), (std::vector<std::uint32_t>{0, 1, 2}));
  const std::vector<std::array<double, 2>> far = {{1.7e308, -1.7e308}, {-1.7e308, 1.7e308}, {0, 0}};
  EXPECT_TRUE(is_permutation(order_along_curve(far)));
}

TEST(SpatialOrder, RoundsKeepTheOrder) {
  std::vector<VertexId> order(5000);
  std::iota(order.begin(), order.end(), 0U);
  arrange_in_rounds(order);
  EXPECT_TRUE(is_permutation(order));
  std::vector<std::size_t> rounds(1, 1);
  for (std::size_t n = 1; n < order.size(); ++n) {
    if (order[n] < order[n - 1]) rounds.push_back(0);
    ++rounds.back();
  }
  EXPECT_GT(rounds.size(), 5U);
  EXPECT_LT(rounds.size(), 12U);
  EXPECT_GT(rounds.back(), 2000U);  // half of them
  std::vector<VertexId> few = {4, 2, 9};
  arrange_in_rounds(few);
  EXPECT_EQ(few, (std::vector<VertexId>{4, 2, 9}));
}

TEST(BadTriangles, EveryOneOnceTheWorstFirst) {
  PointStore points;
  for (const auto& p : random_points(20000)) points.add_explicit(p[0], p[1], 0);
  BadTriangles bad(points, SpatialKey({-3, -3}, {5, 5}));
  std::mt19937_64 random(3);
  std::vector<double> badness(20000);
  for (double& x : badness) x = std::ldexp(1.0, -static_cast<int>(random() % 60));
  bad.gather();
  for (VertexId v = 0; v < 10000; ++v) bad.push(badness[v], {v, {v, v, v}});
  bad.sort();
  std::set<TriangleId> seen;
  BadTriangles::Entry entry;
  double last = 0;
  std::size_t worse = 0;
  while (bad.pop(entry)) {
    EXPECT_TRUE(seen.insert(entry.triangle).second);
    worse += badness[entry.triangle] < last;
    last = badness[entry.triangle];
    if (seen.size() == 100) {  // more of them arrive
      for (VertexId v = 10000; v < 20000; ++v) bad.push(badness[v], {v, {v, v, v}});
    }
  }
  EXPECT_EQ(seen.size(), 20000U);
  EXPECT_LT(worse, 40U);  // once for each neighbourhood
  bad.push(0.5, {1, {1, 1, 1}});
  bad.clear();
  EXPECT_FALSE(bad.pop(entry));
}

}  // namespace
}  // namespace delmesher::plane
