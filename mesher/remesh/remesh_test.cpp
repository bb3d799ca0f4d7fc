// Laws of remesh(), on surfaces that are made here. Distances are measured by brute force, on
// samples.
#include "mesher/remesh/remesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "mesher/delmesher.h"
#include "mesher/remesh/coverage.h"
#include "mesher/remesh/shape.h"
#include "mesher/remesh/triangle_mesh.h"
#include "mesher/surface/validity.h"

namespace delmesher::remesh {
namespace {

// A box of n x n squares a side, with a label for each side.
Surface box(int n, const Vec3& low = {0, 0, 0}, const Vec3& high = {1, 1, 1}) {
  Surface surface;
  std::map<std::array<int, 3>, VertexId> number;
  const auto vertex = [&](const std::array<int, 3>& p) {
    const auto [at, fresh] = number.try_emplace(p, static_cast<VertexId>(surface.vertices.size()));
    if (fresh) {
      Vec3 x{};
      for (std::size_t i = 0; i < 3; ++i) x[i] = low[i] + (high[i] - low[i]) * p[i] / n;
      surface.vertices.push_back(x);
    }
    return at->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> p{};
            p[axis] = side;
            p[(axis + 1) % 3] = i + di;
            p[(axis + 2) % 3] = j + dj;
            return vertex(p);
          };
          const VertexId a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          for (Triangle t : {Triangle{a, b, c}, Triangle{a, c, d}}) {
            if (side == 0) std::swap(t[1], t[2]);
            surface.triangles.push_back(t);
            surface.labels.push_back(static_cast<std::int32_t>(2 * axis + (side > 0 ? 1 : 0)));
          }
        }
      }
    }
  }
  return surface;
}

// The box drawn onto a sphere around the origin.
Surface ball(int n, double radius) {
  Surface surface = box(n, {-1, -1, -1}, {1, 1, 1});
  for (Vec3& p : surface.vertices) p = add_scaled({}, radius / norm(p), p);
  surface.labels.clear();
  return surface;
}

Surface both(Surface a, const Surface& b) {
  const auto first = static_cast<VertexId>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  a.labels.clear();
  return a;
}

Remeshed remeshed(const Surface& surface, const RemeshGoals& goals) {
  Limits limits;
  Control control(limits);
  return remesh(surface, goals, {}, control);
}

// The largest distance of samples of a surface from another one.
double sampled_distance(const Surface& from, const Surface& to) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  double most = 0;
  for (const Triangle& t : from.triangles) {
    for (int k = 0; k < 5; ++k) {
      const double v = share(random), w = (1 - v) * share(random);
      const Vec3& a = from.vertices[t[0]];
      const Vec3 p = add_scaled(add_scaled(a, v, subtract(from.vertices[t[1]], a)), w,
                                subtract(from.vertices[t[2]], a));
      double least = HUGE_VAL;
      for (const Triangle& s : to.triangles) {
        const Simplex simplex({to.vertices[s[0]], to.vertices[s[1]], to.vertices[s[2]]});
        least = std::min(least, squared_distance(p, simplex));
      }
      most = std::max(most, least);
    }
  }
  return std::sqrt(most);
}

void expect_laws(const Surface& given, const RemeshGoals& goals, const Remeshed& result) {
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const SurfaceReport before = check_surface(given), after = check_surface(result.surface);
  EXPECT_TRUE(after.status.ok()) << after.status.message;
  EXPECT_EQ(before.components, after.components);
  const auto euler = [](const Surface& s) {
    return static_cast<std::int64_t>(s.vertices.size()) -
           static_cast<std::int64_t>(s.triangles.size()) / 2;
  };
  EXPECT_EQ(euler(given), euler(result.surface));
  EXPECT_LE(sampled_distance(given, result.surface), goals.tolerance);
  EXPECT_LE(sampled_distance(result.surface, given), goals.tolerance);
}

TEST(Remesh, ABallNeedsFewTriangles) {
  const Surface given = ball(12, 1);  // 1728 triangles
  std::size_t last = given.triangles.size();
  for (const double tolerance : {0.01, 0.03}) {
    const RemeshGoals goals{.tolerance = tolerance};
    const Remeshed result = remeshed(given, goals);
    expect_laws(given, goals, result);
    // Equilateral triangles with edges e are e^2 / 6 deep, which may be twice the tolerance, and
    // there are 16 pi / (sqrt(3) e^2) of them: 2.4 / tolerance. Others are up to twice as many.
    EXPECT_LT(static_cast<double>(result.surface.triangles.size()), 2 * 2.5 / tolerance);
    EXPECT_LT(result.surface.triangles.size(), last);
    last = result.surface.triangles.size();
  }
}

// Flat faces become as coarse as they can, and keep their edges, corners and labels.
TEST(Remesh, ABoxIsTwelveTriangles) {
  const Surface given = box(6);
  const RemeshGoals goals{.tolerance = 1e-3};
  const Remeshed result = remeshed(given, goals);
  expect_laws(given, goals, result);
  EXPECT_EQ(result.surface.vertices.size(), 8U);
  std::map<std::int32_t, int> triangles;
  for (const std::int32_t label : result.surface.labels) ++triangles[label];
  EXPECT_EQ(triangles.size(), 6U);
  for (const auto& [label, count] : triangles) EXPECT_EQ(count, 2) << label;
}

double least_angle(const Surface& surface) {  // degrees
  double least = 1;
  for (const auto& [a, b, c] : surface.triangles) {
    least = std::min(least,
                     least_sine({surface.vertices[a], surface.vertices[b], surface.vertices[c]}));
  }
  return std::asin(least) * 180 / M_PI;
}

// Points come along narrow strips, and stay.
TEST(Remesh, APlateHasRoundTriangles) {
  const Surface given = box(1, {0, 0, 0}, {150, 150, 3});
  const RemeshGoals goals{.tolerance = 0.2};
  const Remeshed result = remeshed(given, goals);
  expect_laws(given, goals, result);
  EXPECT_LT(least_angle(given), 2);
  EXPECT_GT(least_angle(result.surface), 14.47);
  EXPECT_LT(result.surface.triangles.size(), 1000U);
}

// A box with a step across its top.
Surface stepped_box(double height) {
  const std::array<std::array<double, 2>, 6> outline = {
      {{0, 0}, {1, 0}, {1, 1}, {0.4, 1}, {0.4, 1 + height}, {0, 1 + height}}};
  Surface surface;
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : outline) surface.vertices.push_back({x, y, z});
  }
  const std::array<Triangle, 4> front = {{{0, 1, 3}, {1, 2, 3}, {0, 3, 4}, {0, 4, 5}}};
  for (const auto& [a, b, c] : front) {
    surface.triangles.push_back({a, c, b});
    surface.triangles.push_back({a + 6, b + 6, c + 6});
  }
  for (VertexId i = 0; i < 6; ++i) {
    const VertexId j = (i + 1) % 6;
    surface.triangles.push_back({i, j, j + 6});
    surface.triangles.push_back({i, j + 6, i + 6});
  }
  return surface;
}

// What low triangles bend by is no line; a step that is higher than the tolerance stays.
TEST(Remesh, LowStepsGoAndHighOnesStay) {
  const RemeshGoals goals{.tolerance = 0.01};
  for (const double high : {0.05, 0.8, 2.0}) {
    const Surface given = stepped_box(high * goals.tolerance);
    const Remeshed result = remeshed(given, goals);
    expect_laws(given, goals, result);
    EXPECT_GT(least_angle(result.surface), 14.47) << high;
    if (high < 0.1) {
      EXPECT_EQ(result.surface.vertices.size(), 8U);
    } else if (high > 1) {
      EXPECT_GE(result.surface.vertices.size(), 12U);
    }
  }
}

// A wedge whose sharp edge has a flat triangle on it, as unions leave them: the edge goes over that
// triangle's vertex, though both bend by more than lines may elsewhere.
TEST(Remesh, FlatTrianglesOnSharpEdgesGo) {
  const double half = std::tan(M_PI / 12);
  const Surface given{.vertices = {{0, 0, 0},
                                   {0, 1, 0},
                                   {0, 0.4, -2e-4},
                                   {1, 0, half},
                                   {1, 1, half},
                                   {1, 0, -half},
                                   {1, 1, -half}},
                      .triangles = {{0, 3, 1},
                                    {3, 4, 1},
                                    {0, 1, 2},
                                    {0, 2, 5},
                                    {2, 1, 6},
                                    {2, 6, 5},
                                    {0, 5, 3},
                                    {1, 4, 6},
                                    {3, 5, 4},
                                    {5, 6, 4}},
                      .labels = {}};
  const RemeshGoals goals{.tolerance = 0.01};
  const Remeshed result = remeshed(given, goals);
  expect_laws(given, goals, result);
  EXPECT_LT(least_angle(given), 0.1);
  EXPECT_GT(least_angle(result.surface), 14.47);
}

// Labels are within the tolerance of where they were, too.
TEST(Remesh, LabelsStay) {
  Surface given = ball(10, 1);
  for (const Triangle& t : given.triangles) {
    given.labels.push_back(given.vertices[t[0]][2] + given.vertices[t[1]][2] > 0.1 ? 1 : 2);
  }
  const RemeshGoals goals{.tolerance = 0.02};
  const Remeshed result = remeshed(given, goals);
  expect_laws(given, goals, result);
  EXPECT_LT(result.surface.triangles.size(), given.triangles.size() / 2);
  for (const std::int32_t label : {1, 2}) {
    const auto part = [&](const Surface& s) {
      Surface only{.vertices = s.vertices, .triangles = {}, .labels = {}};
      for (std::size_t i = 0; i < s.triangles.size(); ++i) {
        if (s.labels[i] == label) only.triangles.push_back(s.triangles[i]);
      }
      return only;
    };
    EXPECT_LE(sampled_distance(part(given), part(result.surface)), goals.tolerance);
    EXPECT_LE(sampled_distance(part(result.surface), part(given)), goals.tolerance);
  }
}

// Shells that are nearer to each other than the tolerance do not meet or change places.
TEST(Remesh, NearShellsStayApart) {
  const Surface given = both(ball(10, 1), ball(8, 0.985));
  const RemeshGoals goals{.tolerance = 0.05};
  const Remeshed result = remeshed(given, goals);
  expect_laws(given, goals, result);
  EXPECT_LT(result.surface.triangles.size(), given.triangles.size());
  const SurfaceReport before = check_surface(given), after = check_surface(result.surface);
  EXPECT_NEAR(after.volume, before.volume, 0.5 * before.volume);
}

// A box in a box, smaller than the tolerance, beside a plate thinner than it.
TEST(Remesh, WhatIsSmallStays) {
  const Surface given = both(both(box(4), box(3, {0.4, 0.4, 0.4}, {0.41, 0.41, 0.41})),
                             box(1, {0, 0, 1.001}, {1, 1, 1.002}));
  const RemeshGoals goals{.tolerance = 0.05};
  const Remeshed result = remeshed(given, goals);
  expect_laws(given, goals, result);
  EXPECT_GE(result.surface.vertices.size(), 24U - 8U + 4U);
}

TEST(Remesh, SplitsLongEdges) {
  const Surface given = box(1);
  const RemeshGoals goals{.tolerance = 1e-3, .max_edge = 0.2};
  const Remeshed result = remeshed(given, goals);
  expect_laws(given, goals, result);
  for (const Triangle& t : result.surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(distance(result.surface.vertices[t[i]], result.surface.vertices[t[(i + 1) % 3]]),
                0.2);
    }
  }
}

// Few triangles cannot become fewer.
TEST(Remesh, OfATetrahedron) {
  const Surface given{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e-3}},
                      .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                      .labels = {}};
  for (const double feature : {0.0, 40.0, 90.0}) {
    const Remeshed result = remeshed(given, {.tolerance = 0.1, .feature = feature});
    ASSERT_TRUE(result.status.ok());
    EXPECT_GE(result.surface.triangles.size(), 4U);
  }
}

TEST(Remesh, RejectsWhatIsNotValid) {
  Surface open = box(2);
  open.triangles.pop_back();
  open.labels.pop_back();
  EXPECT_EQ(remeshed(open, {.tolerance = 0.1}).status.code, StatusCode::invalid_surface);
  EXPECT_EQ(remeshed(box(2), {.tolerance = 1e-9}).status.code, StatusCode::invalid_options);
}

// Far from the origin doubles are too coarse for any tolerance.
TEST(Remesh, RejectsWhatRoundingsExceed) {
  EXPECT_TRUE(remeshed(box(2, {1e6, 0, 0}, {1e6 + 1, 1, 1}), {.tolerance = 0.01}).status.ok());
  EXPECT_EQ(remeshed(box(2, {1e12, 0, 0}, {1e12 + 2, 2, 2}), {.tolerance = 0.01}).status.code,
            StatusCode::invalid_options);
}

// The fraction of the diagonal that a negative tolerance is.
TEST(Remesh, ToleranceMayBeAFraction) {
  const Remeshed share = remeshed(ball(6, 1), {.tolerance = -0.01}),
                 length = remeshed(ball(6, 1), {.tolerance = share.tolerance});
  EXPECT_NEAR(share.tolerance, 0.01 * share.diagonal, 1e-15);
  EXPECT_EQ(share.surface.triangles, length.surface.triangles);
}

}  // namespace
}  // namespace delmesher::remesh
