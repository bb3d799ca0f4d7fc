#include "mesher/geometry/placement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesher/arithmetic/dyadic.h"
#include "mesher/predicates/point_families.h"
#include "mesher/predicates/predicates.h"
#include "mesher/predicates/rational_reference.h"

namespace delmesher::geometry::placement_test {
namespace {

using families::Random;
using reference::dot;
using reference::minus;

int significant_bits(double x) {
  return 64 - std::countl_zero(decompose(x).magnitude);
}

// The largest number of at most `bits` significant bits in (0, x].
double round_down(double x, int bits) {
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  return std::ldexp(std::floor(std::ldexp(fraction, bits)), exponent - bits);
}

TEST(ShortestDyadic, IsShortestAndNearestToZero) {
  Random random(1);
  std::array<int, 54> seen{};
  for (int i = 0; i < 50000; ++i) {
    const double lo = std::fabs(random.exponent_between(-30, 30));
    const double width = std::ldexp(random.unit(), -static_cast<int>(random.below(56)));
    const double hi = lo + lo * width;
    const double x = shortest_dyadic(lo, hi);
    ASSERT_LE(lo, x);
    ASSERT_LE(x, hi);
    const int bits = significant_bits(x);
    ++seen[static_cast<std::size_t>(bits)];
    if (bits > 1) {
      ASSERT_LT(round_down(hi, bits - 1), lo) << "shorter exists";
    }
    if (x > lo) {
      ASSERT_LT(round_down(std::nextafter(x, 0.0), bits), lo);
    }
    ASSERT_EQ(shortest_dyadic(-hi, -lo), -x);
  }
  EXPECT_GT(seen[1], 100);
  EXPECT_GT(seen[10], 100);
  EXPECT_GT(seen[53], 10);
}

TEST(ShortestDyadic, Extremes) {
  EXPECT_EQ(shortest_dyadic(-1, 1), 0);
  EXPECT_EQ(shortest_dyadic(0, 1), 0);
  EXPECT_EQ(shortest_dyadic(0.3, 0.3), 0.3);
  EXPECT_EQ(shortest_dyadic(5e-324, 1), 5e-324);
  EXPECT_EQ(shortest_dyadic(3 * 5e-324, 1), 4 * 5e-324);
  const double largest = std::numeric_limits<double>::max();
  EXPECT_EQ(shortest_dyadic(largest, largest), largest);
}

mpq_class squared_distance(const reference::Point& a, const reference::Point& b) {
  const reference::Point d = minus(a, b);
  return dot(d, d);
}

reference::Point rational(const Vec3& x) {
  return {mpq_class(x[0]), mpq_class(x[1]), mpq_class(x[2])};
}

Vec3 random_point(Random& random, double scale) {
  return {random.unit() * scale, random.unit() * scale, random.unit() * scale};
}

VertexId add(PointStore& store, const Vec3& x) {
  return store.add_explicit(x[0], x[1], x[2]);
}

// Ends at `offset` from the origin, `length` apart in every coordinate; everything times `scale`.
struct SegmentCase {
  double offset, length, scale;
};

class Segments : public ::testing::TestWithParam<SegmentCase> {};

TEST_P(Segments, WithinToleranceAnchoredAndInside) {
  const auto [offset, length, scale] = GetParam();
  Random random(7);
  for (int i = 0; i < 500; ++i) {
    Vec3 a, b, target;
    const double at = i % 5 == 0 ? random.unit() * 4 - 2 : random.unit();
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = offset + random.unit() * length;
      b[k] = offset + random.unit() * length;
      target[k] = (a[k] + at * (b[k] - a[k])) * scale;
      a[k] *= scale;
      b[k] *= scale;
    }
    if (a == b) continue;
    PointStore store;
    const VertexId p = add(store, a), q = add(store, b);
    const double tolerance = std::ldexp(length, -static_cast<int>(random.below(24))) * scale;
    const PointDefinition d = place_on_segment(store, p, q, target, tolerance);
    ASSERT_GT(d.u, 0);
    ASSERT_LT(d.u, 1);
    // Anchored at the nearest end.
    const reference::Point near = rational(store.nearest(d.corner[1]));
    const reference::Point far = rational(store.nearest(d.corner[0]));
    const reference::Point aim = rational(target);
    ASSERT_LE(squared_distance(aim, near), squared_distance(aim, far) * mpq_class(1 + 1e-9));
    // Within the tolerance of the projection, if that is inside.
    const reference::Point edge = minus(far, near);
    const mpq_class t = dot(minus(aim, near), edge) / dot(edge, edge);
    if (t <= 0 || t >= 1) continue;
    const VertexId v = store.add(d);
    const mpq_class off = abs(mpq_class(t - mpq_class(d.u)));
    ASSERT_LE(mpq_class(off * off * dot(edge, edge)),
              mpq_class(tolerance) * mpq_class(tolerance) * mpq_class(1.0001));
    ASSERT_TRUE(reference::collinear(near, far, reference::point(store, v)));
    // A tolerance of 2^-k of the length costs about k bits.
    ASSERT_LE(significant_bits(d.u), 28);
  }
}

INSTANTIATE_TEST_SUITE_P(Scales, Segments,
                         ::testing::Values(SegmentCase{0, 1, 1}, SegmentCase{100, 1e-3, 1},
                                           SegmentCase{1, 1e-12, 1}, SegmentCase{0, 1e-12, 1},
                                           SegmentCase{0, 1, 0x1p-1000},
                                           SegmentCase{0, 1, 0x1p1020},
                                           SegmentCase{1, 1e-12, 0x1p1000}));

TEST(Placement, OutsideIsAllowedOnRequest) {
  PointStore store;
  const VertexId p = store.add_explicit(0, 0, 0), q = store.add_explicit(1, 0, 0);
  const PointDefinition d = place_on_segment(store, p, q, {-0.5, 1, 0}, 1e-3, false);
  EXPECT_EQ(d.corner[1], p);
  EXPECT_EQ(d.u, -0.5);
}

// Where the ends are neighbouring doubles, only the rest says where between them.
TEST(Placement, RestOfTheTarget) {
  PointStore store;
  const double x = 0x1p26, unit = 0x1p-26;
  const VertexId p = store.add_explicit(x, 1, 2), q = store.add_explicit(x + unit, 1, 2);
  const PointDefinition d =
      place_on_segment(store, p, q, {x, 1, 2}, unit * 0x1p-20, true, {0.375 * unit, 0, 0});
  EXPECT_EQ(d.corner[1], p);
  EXPECT_EQ(d.u, 0.375);
}

// However near to the anchor, a tolerance relative to the distance is kept.
TEST(Placement, VeryNearToTheAnchor) {
  PointStore store;
  const VertexId p = store.add_explicit(0, 0, 0), q = store.add_explicit(1, 0, 0);
  for (double x = 0.3; x > 1e-200; x *= 0.7e-3) {
    const PointDefinition d = place_on_segment(store, p, q, {x, 1e-30 * x, 0}, x * 0x1p-20);
    EXPECT_EQ(d.corner[1], p);
    EXPECT_NEAR(d.u / x, 1, 0x1p-20 * 1.0001);
  }
}

TEST(Placement, ZeroToleranceIsAccepted) {
  PointStore store;
  const VertexId p = store.add_explicit(0, 0, 0), q = store.add_explicit(1, 0, 0);
  EXPECT_EQ(place_on_segment(store, p, q, {0.3, 0, 0}, 0).u, 0.3);
  for (const double x : {0.0, 1.0, -7.0, 1e-300}) {
    const double u = place_on_segment(store, p, q, {x, 0, 0}, 0).u;
    EXPECT_GT(u, 0);
    EXPECT_LT(u, 1);
  }
}

struct TriangleCase {
  double flatness;  // height of the triangle relative to its longest edge
  double scale;
};

class Triangles : public ::testing::TestWithParam<TriangleCase> {};

TEST_P(Triangles, WithinToleranceOfTheProjection) {
  const auto [flatness, scale] = GetParam();
  Random random(8);
  for (int i = 0; i < 300; ++i) {
    const Vec3 a = random_point(random, 1), b = random_point(random, 1);
    const Vec3 off = random_point(random, flatness);
    const double along = random.unit();
    Vec3 p[3] = {a, b, a};
    Vec3 target{};
    const double u = random.unit(), v = random.unit() * (1 - u);
    for (std::size_t k = 0; k < 3; ++k) {
      p[2][k] = a[k] + along * (b[k] - a[k]) + off[k];
      target[k] = (a[k] + u * (b[k] - a[k]) + v * (p[2][k] - a[k]) + 1e-3 * flatness) * scale;
    }
    PointStore store;
    for (Vec3& corner : p) add(store, {corner[0] * scale, corner[1] * scale, corner[2] * scale});
    const double tolerance = std::ldexp(flatness * scale, -static_cast<int>(random.below(20)));
    const PointDefinition d = place_on_triangle(store, 0, 1, 2, target, tolerance);
    const reference::Point aim = rational(target);
    for (int k = 0; k < 2; ++k) {
      ASSERT_LE(
          squared_distance(aim, rational(store.nearest(d.corner[2]))),
          squared_distance(aim, rational(store.nearest(d.corner[static_cast<std::size_t>(k)]))) *
              mpq_class(1 + 1e-9));
    }
    const VertexId placed = store.add(d);
    Predicates predicates(store);
    ASSERT_EQ(predicates.orient3d(0, 1, 2, placed), 0);
    // Distance to the projection = component of (placed - target) in the plane.
    const reference::Point r = reference::point(store, 0);
    const reference::Point n = reference::cross(minus(reference::point(store, 1), r),
                                                minus(reference::point(store, 2), r));
    const reference::Point w = minus(reference::point(store, placed), aim);
    const mpq_class nw = dot(n, w);
    const mpq_class in_plane = dot(w, w) - nw * nw / dot(n, n);
    const mpq_class limit = mpq_class(tolerance) * mpq_class(1.001);
    ASSERT_LE(in_plane, mpq_class(limit * limit));
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Triangles,
                         ::testing::Values(TriangleCase{1, 1}, TriangleCase{1e-3, 1},
                                           TriangleCase{1e-6, 1}, TriangleCase{1e-9, 1},
                                           TriangleCase{1, 0x1p-900}, TriangleCase{1e-6, 0x1p900}));

// Far from the origin, where the doubles of a target are coarser than the tolerance.
TEST(Placement, WhatDoublesLeaveOverCounts) {
  Random random(10);
  for (int i = 0; i < 300; ++i) {
    const double far = 0x1p40;
    PointStore store;
    for (const Vec3& x : {Vec3{0, 0, 0}, Vec3{0.5, 0.0625, 0}, Vec3{0.125, 0.375, 0.25}}) {
      store.add_explicit(far + x[0], x[1] - far, x[2] + far);
    }
    const double u = random.unit() / 2, v = random.unit() / 2;
    const VertexId aim = store.add_on_triangle(0, 1, 2, u, v);
    const Approximation rest = store.remainder(aim);
    const PointDefinition d =
        place_on_triangle(store, 0, 1, 2, store.nearest(aim), 0x1p-30, {rest.x, rest.y, rest.z});
    const VertexId placed = store.add(d);
    const reference::Point w = minus(reference::point(store, placed), reference::point(store, aim));
    ASSERT_LE(dot(w, w), mpq_class(0x1.01p-60));
    // A difference has the digits that the doubles do not.
    const Vec3 from_corner = store.difference(0, placed);
    const reference::Point exact =
        minus(reference::point(store, placed), reference::point(store, 0));
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_NEAR(from_corner[k], exact[k].get_d(), 0x1p-48) << k;
    }
  }
}

// So do the remainders of corners that are not doubles themselves: meeting points of planes through
// different points.
TEST(Placement, WhatDoublesOfCornersLeaveOverCounts) {
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    const double far = 0x1p40;
    PointStore store;
    for (const Vec3& x : {Vec3{0, 0, 0}, Vec3{0.5, 0.0625, 0}, Vec3{0.125, 0.375, 0.25}}) {
      std::array<std::uint32_t, 3> planes{};
      for (std::size_t k = 0; k < 3; ++k) {
        Vec3 normal = {random.unit() / 4, random.unit() / 4, random.unit() / 4};
        normal[k] = 1;
        Vec3 through = {far + x[0], x[1] - far, x[2] + far};
        through[(k + 1) % 3] += random.unit() / 64;
        planes[k] = store.add_plane({normal, {through}});
      }
      store.add_on_planes(planes[0], planes[1], planes[2]);
    }
    const auto rest_of = [&](VertexId v) {
      const Approximation rest = store.remainder(v);
      return Vec3{rest.x, rest.y, rest.z};
    };
    const auto squared_error = [&](const PointDefinition& d, VertexId aim) {
      const reference::Point w =
          minus(reference::point(store, store.add(d)), reference::point(store, aim));
      return dot(w, w);
    };
    const double u = random.unit() / 2, v = random.unit() / 2;
    const VertexId on_edge = store.add_on_segment(0, 1, u);
    ASSERT_LE(squared_error(place_on_segment(store, 0, 1, store.nearest(on_edge), 0x1p-30, true,
                                             rest_of(on_edge)),
                            on_edge),
              mpq_class(0x1.01p-60));
    const VertexId inside = store.add_on_triangle(0, 1, 2, u, v);
    ASSERT_LE(squared_error(place_on_triangle(store, 0, 1, 2, store.nearest(inside), 0x1p-30,
                                              rest_of(inside)),
                            inside),
              mpq_class(0x1.01p-60));
  }
}

// Scaling by a power of two changes nothing but the scale.
TEST(Placement, CommutesWithPowersOfTwo) {
  Random random(9);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p[3] = {random_point(random, 1), random_point(random, 1), random_point(random, 1)};
    const Vec3 target = random_point(random, 1);
    const double tolerance = random.unit() * 1e-3;
    PointStore plain;
    for (const Vec3& x : p) add(plain, x);
    const PointDefinition on_segment = place_on_segment(plain, 0, 1, target, tolerance);
    const PointDefinition on_triangle = place_on_triangle(plain, 0, 1, 2, target, tolerance);
    const Vec3 snapped = snap_to_grid(target, tolerance);
    for (const double s : {0x1p-10, 0x1p20, 0x1p-300, 0x1p500}) {
      PointStore store;
      for (const Vec3& x : p) add(store, {x[0] * s, x[1] * s, x[2] * s});
      const Vec3 t = {target[0] * s, target[1] * s, target[2] * s};
      const PointDefinition e = place_on_segment(store, 0, 1, t, tolerance * s);
      ASSERT_EQ(e.corner, on_segment.corner);
      ASSERT_EQ(e.u, on_segment.u);
      const PointDefinition f = place_on_triangle(store, 0, 1, 2, t, tolerance * s);
      ASSERT_EQ(f.corner, on_triangle.corner);
      ASSERT_EQ(f.u, on_triangle.u);
      ASSERT_EQ(f.v, on_triangle.v);
      const Vec3 g = snap_to_grid(t, tolerance * s);
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(g[k], snapped[k] * s);
    }
  }
}

TEST(SnapToGrid, NearestMultipleOfAPowerOfTwo) {
  Random random(10);
  for (int i = 0; i < 5000; ++i) {
    const double tolerance = std::fabs(random.exponent_between(-60, 10));
    const Vec3 x = {random.exponent_between(-20, 20), random.exponent_between(-70, 5), 0};
    const double spacing = std::ldexp(1.0, std::ilogb(tolerance));
    const Vec3 y = snap_to_grid(x, tolerance);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_LE(std::fabs(y[k] - x[k]), spacing / 2);
      if (y[k] != x[k]) {
        ASSERT_EQ(std::fmod(y[k], spacing), 0);
      }
    }
  }
}

// Half of the tolerance is for either parameter: 1 / 2 is the only number of one bit between 0.275
// and 0.525, 1 / 4 that between 0.175 and 0.425.
TEST(PlaceOnTriangle, TakesHalfTheToleranceForEitherParameter) {
  PointStore store;
  const VertexId p = add(store, {1, 0, 0}), q = add(store, {0, 1, 0}), r = add(store, {0, 0, 0});
  const PointDefinition d = place_on_triangle(store, p, q, r, {0.4, 0.3, 0}, 0.25);
  EXPECT_EQ(d.corner, (std::array<VertexId, 3>{p, q, r}));
  EXPECT_EQ(d.u, 0.5);
  EXPECT_EQ(d.v, 0.25);
}

// All corners agree in x, which is far larger than the triangle: products of its edges underflow
// unless they are scaled by the differences of the corners.
TEST(PlaceOnTriangle, ScalesByTheDifferencesOfCorners) {
  constexpr double kEdge = 0x1p-600;
  PointStore store;
  const VertexId p = add(store, {1, kEdge, 0}), q = add(store, {1, 0, kEdge});
  const VertexId r = add(store, {1, 0, 0});
  const PointDefinition d =
      place_on_triangle(store, p, q, r, {1, 0.375 * kEdge, 0.25 * kEdge}, 0x1p-20 * kEdge);
  EXPECT_EQ(d.corner, (std::array<VertexId, 3>{p, q, r}));
  EXPECT_EQ(d.u, 0.375);
  EXPECT_EQ(d.v, 0.25);
}

}  // namespace
}  // namespace delmesher::geometry::placement_test
