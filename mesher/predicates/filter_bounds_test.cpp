// How far the double filters reach: they decide determinants above the bound that filter.h derives,
// and none below it. An error on the safe side would only make everything slower, as exact stages
// decide the rest.
//
// The inputs are such that all arithmetic of the filter is exact, so that the determinant is a
// known integer next to the threshold; in every order of points and axes and with every sign.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "mesher/predicates/dihedral_filter.h"
#include "mesher/predicates/filter.h"

namespace delmesher::predicates::filter_bounds_test {
namespace {

using Row = std::array<double, 3>;

// Calls check(rows, base) for rows in every order, with every order of axes and every sign of an
// axis, and for the rows as differences from a point away from the origin.
template <std::size_t N, class Check>
void in_every_position(const std::array<Row, N>& rows, const Check& check) {
  std::array<std::size_t, N> order{};
  for (std::size_t i = 0; i < N; ++i) order[i] = i;
  do {
    std::array<std::size_t, 3> axes = {0, 1, 2};
    do {
      for (unsigned signs = 0; signs < 8; ++signs) {
        std::array<Row, N> moved;
        for (std::size_t i = 0; i < N; ++i) {
          for (std::size_t k = 0; k < 3; ++k) {
            moved[i][k] = rows[order[i]][axes[k]] * ((signs >> k & 1U) != 0 ? -1 : 1);
          }
        }
        check(moved, Row{0, 0, 0});
        check(moved, Row{64, -32, 128});
      }
    } while (std::next_permutation(axes.begin(), axes.end()));
  } while (std::next_permutation(order.begin(), order.end()));
}

Approximation at(const Row& row, const Row& base, double error = 0) {
  return {row[0] + base[0], row[1] + base[1], row[2] + base[2], error};
}

// Rows (1, 0, A), (a, 1, a A), (0, b, n): their determinant is n, the largest components are a, b
// and a A. With a^2 A b = 2^51 the bound of 48 u is 12 and a little.
TEST(FilterBounds, Orient3d) {
  const double a = 0x1p10, b = 0x1p15, A = 0x1p16;
  for (const double n : {12.0, 13.0}) {
    const std::array<Row, 3> rows = {Row{1, 0, A}, Row{a, 1, a * A}, Row{0, b, n}};
    in_every_position(rows, [&](const std::array<Row, 3>& r, const Row& base) {
      const int sign =
          filters::orient3d(at({0, 0, 0}, base), at(r[0], base), at(r[1], base), at(r[2], base));
      ASSERT_EQ(std::abs(sign), n > 12 ? 1 : 0) << n;
    });
  }
}

// Three unit vectors and d = (x, y, z) seen from the origin: the determinant is |d|^2 - x - y - z,
// the bound 384 u x y z |d|^2.
TEST(FilterBounds, Insphere) {
  const double x = 28000, y = 29000;
  const double threshold = 0x1p53 / 384 / (x * y);  // for z, except for 4e-5 of it
  for (const double factor : {0.999, 1.001}) {
    const double z = std::floor(threshold * factor);
    const std::array<Row, 4> rows = {Row{1, 0, 0}, Row{0, 1, 0}, Row{0, 0, 1}, Row{x, y, z}};
    in_every_position(rows, [&](const std::array<Row, 4>& r, const Row& base) {
      const int sign = filters::insphere(at(r[0], base), at(r[1], base), at(r[2], base),
                                         at(r[3], base), at({0, 0, 0}, base));
      ASSERT_EQ(std::abs(sign), factor < 1 ? 1 : 0) << z;
    });
  }
}

// Products 2^52, -2^52 and n: the bound of 5 u times the sum of their sizes is 5 and a little.
TEST(FilterBounds, Dot) {
  for (const double n : {5.0, 6.0}) {
    const Row u = {0x1p26, 0x1p26, 1}, v = {0x1p26, -0x1p26, n};
    std::array<std::size_t, 3> axes = {0, 1, 2};
    do {
      // n last or first, so that the sum is exact
      if (axes[1] == 2) continue;
      const Row p = {u[axes[0]], u[axes[1]], u[axes[2]]};
      const Row r = {v[axes[0]], v[axes[1]], v[axes[2]]};
      for (const Row& base : {Row{0, 0, 0}, Row{16, -4, 8}}) {
        for (const double side : {1.0, -1.0}) {
          const Row s = {side * r[0], side * r[1], side * r[2]};
          const int expected = n > 5 ? static_cast<int>(side) : 0;
          ASSERT_EQ(filters::dot(at(p, base), at({0, 0, 0}, base), at(s, base)), expected) << n;
          ASSERT_EQ(filters::dot(at(s, base), at({0, 0, 0}, base), at(p, base)), expected) << n;
        }
      }
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
}

// A right angle at a with legs X and Y, and p above the opposite corner of their rectangle by 1:
// the value is -X^2 Y^2, F is X^2 Y^2 (4 (X^2 + Y^2) + 3), the bound 19 u F.
TEST(FilterBounds, InDiametralBall) {
  const double X = 0x1p23;
  for (const double Y : {3 * 0x1p21, 7 * 0x1p20}) {
    const bool decided = 4 * (X * X + Y * Y) < 0x1p53 / 19;
    std::array<std::size_t, 3> axes = {0, 1, 2};
    do {
      const auto turned = [&](double x, double y, double z) {
        const Row row = {x, y, z};
        return Row{row[axes[0]], row[axes[1]], row[axes[2]]};
      };
      for (const Row& base : {Row{0, 0, 0}, Row{4, -2, 1}}) {
        const Approximation a = at({0, 0, 0}, base), b = at(turned(X, 0, 0), base);
        const Approximation c = at(turned(0, Y, 0), base), p = at(turned(X, Y, 1), base);
        ASSERT_EQ(filters::in_diametral_ball(a, b, c, p), decided ? -1 : 0) << Y;
        ASSERT_EQ(filters::in_diametral_ball(a, c, b, p), decided ? -1 : 0) << Y;
      }
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
}

// Points known to within E only, and no roundings that count: with D = 2.0625 E the largest change
// of the determinant is the one that filter.h sums up. Just below it nothing is decided, just above
// it is. Any one of the points may be the one that is not exact.
template <std::size_t N, class Filter>
void expect_threshold(const std::array<Row, N>& points, double error, bool decided,
                      const Filter& filter) {
  for (std::size_t inexact = 0; inexact < N; ++inexact) {
    std::array<Approximation, N> a;
    for (std::size_t i = 0; i < N; ++i) a[i] = at(points[i], {0, 0, 0}, i == inexact ? error : 0);
    ASSERT_EQ(filter(a) != 0, decided) << "point " << inexact;
  }
}

// A corner with legs x, y and z: the determinant is x y z.
TEST(FilterBounds, InexactOrient3d) {
  const double x = 1, y = 3, z = 1.0 / 64;
  const std::array<Row, 4> points = {Row{0, 0, 0}, Row{x, 0, 0}, Row{0, y, 0}, Row{0, 0, z}};
  const auto change = [&](double error) {
    const double d = 2.0625 * error, nx = x + d, ny = y + d, nz = z + d;
    return 6 * d * (nx * ny + ny * nz + nz * nx);
  };
  double error = 0x1p-12;
  while (change(error) < x * y * z) error *= 1.001;
  const auto filter = [](const std::array<Approximation, 4>& a) {
    return filters::orient3d(a[0], a[1], a[2], a[3]);
  };
  expect_threshold(points, 0.99 * error, true, filter);
  expect_threshold(points, 1.01 * error, false, filter);
}

// A corner with legs x, y and z, and e the centre of its sphere: the determinant is x y z times the
// squared radius.
TEST(FilterBounds, InexactInsphere) {
  const double x = 1, y = 3, z = 0.25;
  const std::array<Row, 5> points = {Row{0, 0, 0}, Row{x, 0, 0}, Row{0, y, 0}, Row{0, 0, z},
                                     Row{x / 2, y / 2, z / 2}};
  const double value = x * y * z * (x * x + y * y + z * z) / 4;
  const double mx = x / 2, my = y / 2, mz = z / 2;  // seen from e
  const auto change = [&](double error) {
    const double d = 2.0625 * error, nx = mx + d, ny = my + d, nz = mz + d;
    const double pairs = nx * ny + ny * nz + nz * nx;
    const double squares = nx * nx + ny * ny + nz * nz;
    return 24 * d * (pairs * squares + nx * ny * nz * 2 * (nx + ny + nz));
  };
  double error = 0x1p-20;
  while (change(error) < value) error *= 1.001;
  const auto filter = [](const std::array<Approximation, 5>& a) {
    return filters::insphere(a[0], a[1], a[2], a[3], a[4]);
  };
  expect_threshold(points, 0.99 * error, true, filter);
  expect_threshold(points, 1.01 * error, false, filter);
}

TEST(FilterBounds, InexactDot) {
  const Row u = {1, 0.5, -0.25}, v = {0.5, -0.75, 0.25};
  const double value = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const std::array<Row, 3> points = {u, Row{0, 0, 0}, v};
  const double sum = 1 + 0.5 + 0.25 + 0.5 + 0.75 + 0.25;
  double error = 0x1p-20;
  while (2.0625 * error * (sum + 3 * 2.0625 * error) < std::fabs(value)) error *= 1.001;
  const auto filter = [](const std::array<Approximation, 3>& a) {
    return filters::dot(a[0], a[1], a[2]);
  };
  expect_threshold(points, 0.99 * error, true, filter);
  expect_threshold(points, 1.01 * error, false, filter);
}

// A right angle with legs 4 and 1, p in their plane: the value is 16 (w . (u + v) - |w|^2), F is
// 16 (17 + 3 |w|^2), and the change 6.1 rho F with rho = 2 sqrt(3) E / (smallest length) rounded
// up.
TEST(FilterBounds, InexactInDiametralBall) {
  for (const double height : {0.0, 0x1p-7}) {
    const Row w = {4, 1 - height, 0};
    const std::array<Row, 4> points = {Row{0, 0, 0}, Row{4, 0, 0}, Row{0, 1, 0}, w};
    const double ww = w[0] * w[0] + w[1] * w[1];
    const double value = 16 * (4 * w[0] + w[1] - ww), F = 16 * (17 + 3 * ww);
    const auto filter = [](const std::array<Approximation, 4>& a) {
      return filters::in_diametral_ball(a[0], a[1], a[2], a[3]);
    };
    if (height == 0) {
      expect_threshold(points, 1e-12, false, filter);
      continue;
    }
    const double error = value / F / 6.1 / (2 * std::sqrt(3.0));
    expect_threshold(points, 0.98 * error, true, filter);
    expect_threshold(points, 1.03 * error, false, filter);
  }
  // Errors of more than 2^-10 of the smallest length are not estimated at all.
  const std::array<Row, 4> deep = {Row{0, 0, 0}, Row{4, 0, 0}, Row{0, 1, 0}, Row{2, 0.5, 0}};
  const auto filter = [](const std::array<Approximation, 4>& a) {
    return filters::in_diametral_ball(a[0], a[1], a[2], a[3]);
  };
  expect_threshold(deep, 0x1p-10 / 3.6, true, filter);
  expect_threshold(deep, 0x1p-10 / 3.4, false, filter);
}

// An edge of length 1 with wings of lengths 1 and 3, one known up to an error: the change is
// 12 D N_e (N_u N_e + N_v N_e + 2 N_u N_v).
TEST(FilterBounds, InexactDihedral) {
  const std::array<Row, 4> points = {Row{0, 3, 0}, Row{0, 1, 0}, Row{0, 0, 1}, Row{0, 0, 0}};
  const auto change = [&](double error) {
    const double d = 2.0625 * error, u = 1 + d, v = 3 + d, e = 1 + d;
    return 12 * d * e * (u * e + v * e + 2 * u * v);
  };
  double error = 0x1p-12;
  while (change(error) < 3) error *= 1.001;
  const auto filter = [](const std::array<Approximation, 4>& a) {
    return filters::dihedral(a[0], a[1], a[2], a[3]);
  };
  expect_threshold(points, 0.99 * error, true, filter);
  expect_threshold(points, 1.01 * error, false, filter);
}

// One cross overflows, the other one is tiny.
TEST(FilterBounds, OverflowOfDihedral) {
  EXPECT_EQ(filters::dihedral({0, 1e-300, 0, 0}, {0, 1e200, 0, 0}, {0, 0, 1e150, 0}, {0, 0, 0, 0}),
            0);
}

// Products that underflow are not trusted, ordinary small ones are.
TEST(FilterBounds, Underflow) {
  const auto corner = [](double s) {
    return filters::orient3d({0, 0, 0, 0}, {s, 0, 0, 0}, {0, s, 0, 0}, {0, 0, s, 0});
  };
  EXPECT_EQ(corner(0x1p-299), 1);
  EXPECT_EQ(corner(0x1p-301), 0);
  const auto ball = [](double s) {
    return filters::insphere({s, 0, 0, 0}, {0, s, 0, 0}, {0, 0, s, 0}, {0, 0, 0, 0},
                             {s / 4, s / 4, s / 4, 0});
  };
  EXPECT_EQ(std::abs(ball(0x1p-179)), 1);
  EXPECT_EQ(ball(0x1p-181), 0);
  const auto dot = [](double s) { return filters::dot({s, 0, 0, 0}, {0, 0, 0, 0}, {s, 0, 0, 0}); };
  const auto dihedral = [](double s) {
    return filters::dihedral({0, s, s, 0}, {0, s, 0, 0}, {s, 0, 0, 0}, {0, 0, 0, 0});
  };
  EXPECT_EQ(dihedral(0x1p-224), 1);
  EXPECT_EQ(dihedral(0x1p-226), 0);
  EXPECT_EQ(dot(0x1p-449), 1);
  EXPECT_EQ(dot(0x1p-451), 0);
  const auto diametral = [](double s) {
    return filters::in_diametral_ball({0, 0, 0, 0}, {s, 0, 0, 0}, {0, s, 0, 0},
                                      {s / 2, s / 2, 0, 0});
  };
  EXPECT_EQ(diametral(0x1p-149), 1);
  EXPECT_EQ(diametral(0x1p-151), 0);
}

}  // namespace
}  // namespace delmesher::predicates::filter_bounds_test
