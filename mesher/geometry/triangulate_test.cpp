#include "mesher/geometry/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace delmesher::geometry {
namespace {

double doubled_area(const Point3& a, const Point3& b, const Point3& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double loop_area(const std::vector<Point3>& p, const Loop& loop) {
  double area = 0;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    area += doubled_area(p[loop[0]], p[loop[i]], p[loop[i + 1]]);
  }
  return area;
}

FaceTriangulation triangulated(const std::vector<Point3>& p, const std::vector<Loop>& loops) {
  Polling polling;
  return triangulate_face(p, loops, polling);
}

// All triangles turn like the outer loop, their areas add up, and their outer edges are the loops'.
void expect_tiling(const std::vector<Point3>& p, const std::vector<Loop>& loops) {
  const FaceTriangulation result = triangulated(p, loops);
  EXPECT_TRUE(result.simple);
  EXPECT_TRUE(result.planar);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  const double outer = loop_area(p, loops[0]);
  double expected = std::fabs(outer), area = 0;
  std::size_t corners = loops[0].size();
  for (std::size_t i = 1; i < loops.size(); ++i) {
    expected -= std::fabs(loop_area(p, loops[i]));
    corners += loops[i].size();
  }
  ASSERT_EQ(result.triangles.size(), corners + 2 * loops.size() - 4);
  for (const auto& t : result.triangles) {
    const double part = doubled_area(p[t[0]], p[t[1]], p[t[2]]);
    EXPECT_GT(part * outer, 0);
    area += std::fabs(part);
    for (std::size_t k = 0; k < 3; ++k) {
      // An edge cancels with its reverse.
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (edges[{b, a}] > 0) {
        --edges[{b, a}];
      } else {
        ++edges[{a, b}];
      }
    }
  }
  EXPECT_NEAR(area, expected, 1e-9 * std::fabs(expected));
  std::size_t boundary = 0;
  for (const auto& [edge, count] : edges) {
    EXPECT_GE(count, 0);
    boundary += static_cast<std::size_t>(count);
  }
  EXPECT_EQ(boundary, corners);
  for (std::size_t i = 0; i < loops[0].size(); ++i) {
    EXPECT_EQ((edges[{loops[0][i], loops[0][(i + 1) % loops[0].size()]}]), 1);
  }
}

Loop iota_loop(std::uint32_t begin, std::uint32_t end) {
  Loop loop;
  for (std::uint32_t i = begin; i < end; ++i) loop.push_back(i);
  return loop;
}

TEST(Triangulate, CollinearCornersGiveNoFlatTriangles) {
  const std::vector<Point3> p = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                 {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
  expect_tiling(p, {iota_loop(0, 8)});
}

TEST(Triangulate, CombInBothDirections) {
  std::vector<Point3> p;
  for (int i = 0; i < 30; ++i) {
    p.push_back({2.0 * i, 0, 0});
    p.push_back({2.0 * i + 1, 5, 0});
  }
  p.push_back({60, 0, 0});
  p.push_back({60, -1, 0});
  p.push_back({0, -1, 0});
  Loop teeth = iota_loop(0, static_cast<std::uint32_t>(p.size()));
  std::reverse(teeth.begin(), teeth.end());
  expect_tiling(p, {teeth});
  std::reverse(teeth.begin(), teeth.end());
  expect_tiling(p, {teeth});
}

TEST(Triangulate, RandomStarPolygons) {
  std::mt19937_64 random(4);
  for (int n = 4; n < 60; ++n) {
    std::vector<Point3> p;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979 * i / n;
      const double radius = 1 + static_cast<double>(random() % 100);
      p.push_back({radius * std::cos(angle), radius * std::sin(angle), 7});
    }
    expect_tiling(p, {iota_loop(0, static_cast<std::uint32_t>(n))});
  }
}

TEST(Triangulate, HolesInEitherDirection) {
  std::vector<Point3> p = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}};
  std::vector<Loop> loops = {{0, 1, 2, 3}};
  std::mt19937_64 random(5);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      const double x = 20 * i + 5, y = 20 * j + 5;
      const auto first = static_cast<std::uint32_t>(p.size());
      // Axis-aligned squares, so that many bridges would run through other corners.
      p.insert(p.end(), {{x, y, 0}, {x + 10, y, 0}, {x + 10, y + 10, 0}, {x, y + 10, 0}});
      Loop hole = iota_loop(first, first + 4);
      if (random() % 2 == 0) std::reverse(hole.begin(), hole.end());
      loops.push_back(hole);
    }
  }
  expect_tiling(p, loops);
  std::reverse(loops[0].begin(), loops[0].end());
  expect_tiling(p, loops);
}

TEST(Triangulate, NonPlanarIsReported) {
  const std::vector<Point3> p = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.25}, {0, 1, 0}};
  const FaceTriangulation result = triangulated(p, {{0, 1, 2, 3}});
  EXPECT_TRUE(result.simple);
  EXPECT_FALSE(result.planar);
  EXPECT_GT(result.deviation, 0.1);
  EXPECT_EQ(result.triangles.size(), 2U);
}

TEST(Triangulate, DegenerateAndCrossingPolygonsEnd) {
  const std::vector<Point3> p = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {2, 2, 0}, {3, 3, 0}};
  for (const Loop& loop : {Loop{0, 1, 2, 3}, Loop{0, 1, 4, 5}, Loop{0, 0, 0, 0}, Loop{0, 1, 0, 1},
                           Loop{0, 1, 2, 2, 1}}) {
    const FaceTriangulation result = triangulated(p, {loop});
    EXPECT_EQ(result.triangles.size(), loop.size() - 2);
    EXPECT_FALSE(result.simple);
  }
}

// Deep notches from above: as many corners that may block an ear as there can be.
std::vector<Point3> comb() {
  std::vector<Point3> p;
  for (std::uint32_t i = 0; i < kMaxPolygonCorners / 2; ++i) {
    p.push_back({static_cast<double>(i), i % 2 == 0 ? 0.0 : 1e4, 0});
  }
  p.push_back({static_cast<double>(p.size()), -1, 0});
  p.push_back({-1, -1, 0});
  return p;
}

TEST(Triangulate, LargePolygonEndsSoon) {
  const std::vector<Point3> p = comb();
  const auto n = static_cast<std::uint32_t>(p.size());
  expect_tiling(p, {iota_loop(0, n)});
}

TEST(Triangulate, AsksWhetherToGoOnWithinOnePolygon) {
  const std::vector<Point3> p = comb();
  const std::vector<Loop> loops = {iota_loop(0, static_cast<std::uint32_t>(p.size()))};
  int asked = 0;
  Polling polling([&] { return ++asked < 3; });
  EXPECT_THROW(triangulate_face(p, loops, polling), ReadingStopped);
  EXPECT_EQ(asked, 3);
}

TEST(StrictlyInside, BoundaryIsOutside) {
  const std::vector<Point3> p = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};
  const Loop loop = iota_loop(0, 5);
  EXPECT_TRUE(strictly_inside(p, loop, 2, {2, 0.5}));
  EXPECT_FALSE(strictly_inside(p, loop, 2, {2, 1}));
  EXPECT_FALSE(strictly_inside(p, loop, 2, {2, 2}));
  EXPECT_FALSE(strictly_inside(p, loop, 2, {0, 2}));
  EXPECT_FALSE(strictly_inside(p, loop, 2, {5, 0}));
  EXPECT_TRUE(strictly_inside(p, loop, 2, {0.1, 1}));
}

}  // namespace
}  // namespace delmesher::geometry
