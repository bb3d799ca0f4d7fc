#include "mesher/surface/feature_size.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mesher/surface/test_surfaces.h"

namespace delmesher::surface {
namespace {

using namespace test_surfaces;

double smallest(const Surface& s) {
  PointStore points;
  Predicates predicates(points);
  const SurfaceTopology topology = build_topology(s, points, predicates);
  const Limits options;
  Control control(options);
  return smallest_local_feature_size(topology, points, control);
}

Vec3 mix(const Vec3& a, const Vec3& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

double distance(const Vec3& a, const Vec3& b) {
  return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                   (a[2] - b[2]) * (a[2] - b[2]));
}

TEST(Distance, NoSampleIsCloserAndSomeSampleIsClose) {
  std::mt19937_64 random(3);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const auto point = [&] { return Vec3{unit(), unit(), unit()}; };
  constexpr int n = 40;
  for (int round = 0; round < 100; ++round) {
    const std::array<Vec3, 3> s{point(), point(), point()}, t{point(), point(), point()};
    double pt = 9, ss = 9;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        const double u = double(i) / n, v = double(j) / n;
        ss = std::min(ss, distance(mix(s[0], s[1], u), mix(t[0], t[1], v)));
        pt = std::min(pt, distance(s[0], mix(t[0], mix(t[1], t[2], u), v)));
      }
    }
    const double exact_ss = segment_segment_distance(s[0], s[1], t[0], t[1]);
    const double exact_pt = point_triangle_distance(s[0], t);
    EXPECT_LE(exact_ss, ss + 1e-12);
    EXPECT_GE(exact_ss, ss - 0.05);
    EXPECT_LE(exact_pt, pt + 1e-12);
    EXPECT_GE(exact_pt, pt - 0.05);
  }
}

TEST(Distance, KnownValues) {
  const std::array<Vec3, 3> t{Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}};
  EXPECT_EQ(point_triangle_distance({1, 1, 3}, t), 3);
  EXPECT_EQ(point_triangle_distance({-3, -4, 0}, t), 5);
  EXPECT_EQ(point_triangle_distance({1, -2, 0}, t), 2);
  EXPECT_EQ(segment_segment_distance({-1, 0, 1}, {1, 0, 1}, {0, -1, 0}, {0, 1, 0}), 1);
  EXPECT_EQ(segment_segment_distance({0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {1, 2, 0}), 2);  // parallel
  EXPECT_EQ(point_segment_distance({5, 5, 5}, {1, 1, 1}, {1, 1, 1}), std::sqrt(48));
}

TEST(Distance, NeedlesAndExtremeScales) {
  // The height of a point above a needle whose normal is poorly defined.
  const std::array<Vec3, 3> needle{Vec3{0.1, 0.7, 0.3}, Vec3{1000.3, 0.7 + 1e-9, 0.3},
                                   Vec3{500.7, 0.7 + 3e-9, 0.3}};
  EXPECT_NEAR(point_triangle_distance({600, 0.7 + 1.2e-9, 0.8}, needle), 0.5, 1e-11);
  // The same in general position: along (2, 3, 6), width along (3, -6, 2).
  const auto at = [](double along, double across) {
    return Vec3{(2 * along + 3 * across) / 7, (3 * along - 6 * across) / 7,
                (6 * along + 2 * across) / 7};
  };
  const std::array<Vec3, 3> oblique{at(0.1, 0), at(1000.3, 0), at(500.7, 1e-6)};
  using Long = std::array<long double, 3>;
  Long u, v, n;
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = static_cast<long double>(oblique[1][i]) - oblique[0][i];
    v[i] = static_cast<long double>(oblique[2][i]) - oblique[0][i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
  }
  const long double norm = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (const double x : {0.2, 0.4, 0.7, 0.9}) {
    Vec3 p = mix(mix(oblique[0], oblique[1], x), oblique[2], 0.25);
    for (std::size_t i = 0; i < 3; ++i) p[i] += static_cast<double>(n[i] / norm / 2);
    EXPECT_NEAR(point_triangle_distance(p, oblique), 0.5, 1e-11);
  }
  const Vec3 a{1, 2, 3}, b{4, 6, 9}, c{3, 1, 2}, d{-2, 0.5, 7};
  const double expected = segment_segment_distance(a, b, c, d);
  const auto times = [](const Vec3& p, double f) { return Vec3{p[0] * f, p[1] * f, p[2] * f}; };
  for (const int k : {-1000, -500, -129, -128, -1, 1, 100, 127, 128, 500, 1018}) {
    const double f = std::ldexp(1.0, k);
    EXPECT_EQ(segment_segment_distance(times(a, f), times(b, f), times(c, f), times(d, f)),
              expected * f)
        << k;
  }
}

TEST(FeatureSize, Boxes) {
  EXPECT_EQ(smallest(box({0, 0, 0}, {1, 2, 3})), 1);
  EXPECT_EQ(smallest(box({0, 0, 0}, {1, 1, 1}, 4)), 0.25);
  // Facet against facet of another component, far from all vertices and edges.
  EXPECT_EQ(smallest(joined(box({0, 0, 0}, {8, 8, 1}), box({3, 3, 1.125}, {5, 5, 2}))), 0.125);
  // A wall: vertices of one facet against the opposite facet.
  EXPECT_EQ(smallest(box({0, 0, 0}, {1, 0x1p-40, 3})), 0x1p-40);
}

TEST(FeatureSize, EdgeAgainstEdge) {
  // Two wedges with crossing ridges at distance 1/4.
  const Surface lower = tetrahedron({-4, 0, 0}, {4, 0, 0}, {0, -4, -3}, {0, 4, -3});
  Surface upper = tetrahedron({0, -4, 0.25}, {0, 4, 0.25}, {4, 0, 3}, {-4, 0, 3});
  EXPECT_EQ(smallest(joined(lower, upper)), 0.25);
}

TEST(FeatureSize, HeightOfATetrahedron) {
  // The apex is closest to the opposite facet, with which it shares no vertex.
  EXPECT_NEAR(smallest(tetrahedron({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0.25})), 0.25, 1e-15);
}

TEST(FeatureSize, ScalesByPowersOfTwo) {
  Surface s = tetrahedron({0.1, 0, 0}, {4, 0.3, 0}, {0, 4, 0.7}, {1, 1.1, 0.25});
  const double expected = smallest(s);
  EXPECT_EQ(smallest(scaled(s, 0x1p20)), expected * 0x1p20);
  EXPECT_EQ(smallest(scaled(s, 0x1p-300)), expected * 0x1p-300);
}

}  // namespace
}  // namespace delmesher::surface
