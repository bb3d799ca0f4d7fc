// Intervals, exact numbers, sums and points, and the signs that they decide.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "oracles/base/ball_side.h"
#include "oracles/base/distances.h"
#include "oracles/base/exact_points.h"
#include "oracles/base/exact_sum.h"
#include "oracles/base/interval.h"
#include "oracles/base/triangle_sums.h"
#include "property_tests/oracle_units/helpers.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactPoint;
using delmesher::ExactRecord;

TEST(Intervals, HaveTheSignOfAllTheyHold) {
  EXPECT_EQ(Interval(1, 2).sign(), 1);
  EXPECT_EQ(Interval(-2, -1).sign(), -1);
  EXPECT_EQ(Interval(0).sign(), 0);
  EXPECT_EQ(Interval(0, 1).sign(), 2);
  EXPECT_EQ(Interval(-1, 0).sign(), 2);
  EXPECT_EQ(Interval(-1, 1).sign(), 2);
  EXPECT_EQ((Interval(1e308) * Interval(10)).sign(), 2);  // overflow certifies nothing
  EXPECT_EQ((Interval(kInfinity) - Interval(kInfinity)).sign(), 2);
}

// Against rational arithmetic at the ends: no number of the operands may be lost, and at most a few
// roundings are added.
TEST(Intervals, EncloseAndAreTight) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto interval = [&] {
    const double a = unit(random), b = a + std::ldexp(unit(random), -int(random() % 60));
    return Interval(std::min(a, b), std::max(a, b));
  };
  const auto expect = [](const Interval& found, const mpq_class& low, const mpq_class& high) {
    const mpq_class scale = std::max(abs(low), abs(high));
    EXPECT_LE(mpq_class(found.low), low);
    EXPECT_GE(mpq_class(found.high), high);
    EXPECT_LE(low - mpq_class(found.low), scale * mpq_class(0x1p-49));
    EXPECT_LE(mpq_class(found.high) - high, scale * mpq_class(0x1p-49));
  };
  for (int round = 0; round < 500; ++round) {
    const Interval a = interval(), b = interval();
    const mpq_class al = a.low, ah = a.high, bl = b.low, bh = b.high;
    expect(a + b, al + bl, ah + bh);
    expect(a - b, al - bh, ah - bl);
    expect(-a, -ah, -al);
    const std::array<mpq_class, 4> products = {al * bl, al * bh, ah * bl, ah * bh};
    expect(a * b, *std::min_element(products.begin(), products.end()),
           *std::max_element(products.begin(), products.end()));
  }
  const Interval tiny = Interval(0x1p-1070) * Interval(0x1p-10);  // underflows to zero
  EXPECT_GT(tiny.high, 0);
  EXPECT_EQ(tiny.sign(), 2);
  EXPECT_LE(tiny.high, 16 * std::numeric_limits<double>::denorm_min());
}

mpq_class coordinate(const ExactPoints& points, Index v, int axis) {
  mpq_class value = points.exact(v)[axis].rational();
  if (points.exponent() >= 0) return value << static_cast<unsigned long>(points.exponent());
  return value >> static_cast<unsigned long>(-points.exponent());
}

TEST(ExactPoints, AreTheirDefinitions) {
  std::vector<ExactPoint> given =
      explicit_points(std::vector<Position>{{0.1, -3, 7e5}, {1e-7, 0, -2}, {5, 0.3, 0x1p-60}});
  ExactPoint on_segment;
  on_segment.kind = ExactPoint::Kind::on_segment;
  on_segment.i = 0;
  on_segment.j = 2;
  on_segment.x = 0.3;
  given.push_back(on_segment);
  ExactPoint on_triangle;
  on_triangle.kind = ExactPoint::Kind::on_triangle;
  on_triangle.i = 2;
  on_triangle.j = 0;
  on_triangle.k = 1;
  on_triangle.x = 0.7;
  on_triangle.y = 0x1.8p-3;
  given.push_back(on_triangle);
  on_segment.x = 3;  // beyond an end
  given.push_back(on_segment);
  ExactPoints points;
  ASSERT_EQ(points.assign(given), "");
  ASSERT_EQ(points.size(), given.size());
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<mpq_class, 3> c;
    for (int v = 0; v < 3; ++v) {
      const ExactPoint& p = given[v];
      c[v] = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
      EXPECT_EQ(coordinate(points, v, axis), c[v]);
      EXPECT_EQ(points.nearest(v)[axis], c[v].get_d());
      EXPECT_EQ(points.enclosure(v)[axis].low, points.enclosure(v)[axis].high);
    }
    const mpq_class t = 0.3, u = 0.7, w = 0x1.8p-3;
    const std::array<mpq_class, 3> made = {
        t * c[0] + (1 - t) * c[2], u * c[2] + w * c[0] + (1 - u - w) * c[1], 3 * c[0] - 2 * c[2]};
    for (Index i = 0; i < 3; ++i) {
      EXPECT_EQ(coordinate(points, 3 + i, axis), made[i]);
      const Interval around = points.enclosure(3 + i)[axis];
      EXPECT_LE(mpq_class(around.low), made[i]);
      EXPECT_GE(mpq_class(around.high), made[i]);
      EXPECT_LE(around.high - around.low, 0x1p-48 * std::fabs(made[i].get_d()));
      EXPECT_NEAR(points.nearest(3 + i)[axis], made[i].get_d(),
                  0x1p-51 * std::fabs(made[i].get_d()));
    }
    for (Index v = 0; v < points.size(); ++v) {
      for (Index to = 0; to < points.size(); ++to) {
        const mpq_class exact = coordinate(points, to, axis) - coordinate(points, v, axis);
        const Interval rough = points.rough_difference(v, to)[axis];
        EXPECT_LE(mpq_class(rough.low), exact);
        EXPECT_GE(mpq_class(rough.high), exact);
        // A second double per coordinate leaves an error of 2^-105 of it, taken 2^5 times for
        // safety. Rounding outward at zero goes to the next subnormal number, a few times over.
        constexpr double kSubnormals = 16 * std::numeric_limits<double>::denorm_min();
        const double coordinates =
            std::fabs(points.nearest(v)[axis]) + std::fabs(points.nearest(to)[axis]);
        EXPECT_LE(rough.high - rough.low,
                  0x1p-48 * std::fabs(exact.get_d()) + 0x1p-99 * coordinates + kSubnormals);
      }
      largest = std::max(largest, std::fabs(points.nearest(v)[axis]));
    }
  }
  EXPECT_EQ(points.largest_coordinate(), largest);
  EXPECT_GE(points.difference_error(), 0x1p-52 * largest);
  EXPECT_LE(points.difference_error(), 0x1p-48 * largest);
  EXPECT_EQ(points_of({{1, 2, -3}}).difference_error(), 0);  // doubles are exact
  EXPECT_EQ(points_of({{1, 2, -3}}).largest_coordinate(), 3);
  EXPECT_EQ(points_of({{0, 0, 0}}).size(), 1U);
}

TEST(ExactPoints, RefuseWhatIsNoPoint) {
  ExactPoints points;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double bad : {kInfinity, std::nan("")}) {
      Position position = {1, 2, 3};
      position[axis] = bad;
      EXPECT_NE(points.assign(std::vector<Position>{{0, 0, 0}, position}).find("point 1"),
                std::string::npos);
      EXPECT_EQ(points.size(), 0U);
    }
  }
  const std::vector<ExactPoint> three =
      explicit_points(std::vector<Position>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  for (const auto kind : {ExactPoint::Kind::on_segment, ExactPoint::Kind::on_triangle}) {
    const int corners = kind == ExactPoint::Kind::on_segment ? 2 : 3;
    for (int corner = -1; corner < corners; ++corner) {
      for (const Index wrong : {4U, 3U, 5U, 1000U}) {  // itself, another such point, nothing
        std::vector<ExactPoint> given = three;
        ExactPoint p;
        p.kind = kind;
        p.i = 0;
        p.j = 1;
        p.k = corners == 3 ? 2 : 1000;  // not looked at on segments
        given.push_back(p);
        if (corner == 0) p.i = wrong;
        if (corner == 1) p.j = wrong;
        if (corner == 2) p.k = wrong;
        given.push_back(p);
        EXPECT_EQ(points.assign(given).empty(), corner < 0) << corner << " " << wrong;
      }
    }
  }
}

TEST(ExactSigns, OfACornerAndItsMirrorImage) {
  // Unit vectors from a point away from the origin, and points inside and outside.
  const double s = 17;
  const ExactPoints p = points_of({{s, s, s},
                                   {s + 1, s, s},
                                   {s, s + 1, s},
                                   {s, s, s + 1},
                                   {s + 0.5, s + 0.5, s + 0.25},  // in the sphere, not its centre
                                   {s + 1, s + 1, s + 1},         // on it
                                   {s + 2, s + 2, s + 2},
                                   {s + 2, s, s}});
  EXPECT_EQ(exact::orient3d(p, 0, 1, 2, 3), 1);
  EXPECT_EQ(exact::orient3d(p, 0, 2, 1, 3), -1);
  EXPECT_EQ(exact::orient3d(p, 0, 1, 2, 7), 0);
  EXPECT_EQ(to_double(exact::volume6(p, 0, 1, 2, 3), 3 * p.exponent()), 1);
  EXPECT_EQ(to_double(exact::volume6(p, 0, 1, 2, 6), 3 * p.exponent()), 2);
  EXPECT_EQ(exact::insphere(p, 0, 1, 2, 3, 4), 1);
  EXPECT_EQ(exact::insphere(p, 0, 1, 2, 3, 5), 0);
  EXPECT_EQ(exact::insphere(p, 0, 1, 2, 3, 6), -1);
  EXPECT_EQ(exact::insphere(p, 0, 2, 1, 3, 4), -1);  // the other orientation
  EXPECT_EQ(exact::dot_sign(p, 0, 1, 2), 0);
  EXPECT_EQ(exact::dot_sign(p, 0, 1, 5), 1);
  EXPECT_EQ(exact::dot_sign(p, 0, 1, 7), 1);
  EXPECT_EQ(exact::dot_sign(p, 1, 0, 7), -1);
  EXPECT_TRUE(exact::in_diametral_ball(p, 1, 2, 3, 4));
  EXPECT_FALSE(exact::in_diametral_ball(p, 1, 2, 3, 1));
  EXPECT_FALSE(exact::in_diametral_ball(p, 1, 2, 3, 6));
  EXPECT_TRUE(exact::collinear(p, 0, 1, 7));
  EXPECT_TRUE(exact::collinear(p, 0, 5, 6));
  EXPECT_TRUE(exact::collinear(p, 0, 0, 6));
  for (const auto& [a, b] : {std::array<Index, 2>{1, 2}, {2, 3}, {3, 1}}) {
    EXPECT_FALSE(exact::collinear(p, 0, a, b));
  }
  EXPECT_TRUE(exact::equal(p, 3, 3));
  EXPECT_FALSE(exact::equal(p, 1, 7));
  EXPECT_NEAR(exact::distance(p, 0, 6), std::sqrt(12.0), 1e-15);
  EXPECT_NEAR(exact::distance(p, 7, 3), std::sqrt(5.0), 1e-15);
  EXPECT_EQ(length(exact::area2(p, 0, 1, 2), 2 * p.exponent()), 1);
}

// The same signs where intervals cannot tell: on a lattice, against integers of the machine.
TEST(ExactSigns, AgreeWithMachineIntegersOnALattice) {
  std::mt19937_64 random(5);
  std::array<std::array<int, 3>, 4> counts{};  // by predicate and sign
  for (int round = 0; round < 4000; ++round) {
    std::array<std::array<std::int64_t, 3>, 5> x;
    std::vector<Position> positions(5);
    for (int i = 0; i < 5; ++i) {
      for (int k = 0; k < 3; ++k) {
        x[i][k] = static_cast<std::int64_t>(random() % 3);
        // Offset and steps that doubles hold, but not the products of their differences.
        positions[i][k] = 0x1p40 + static_cast<double>(x[i][k]) * 0x1.00001p10;
      }
    }
    const auto minus = [&](int a, int b) {
      return std::array<std::int64_t, 3>{x[a][0] - x[b][0], x[a][1] - x[b][1], x[a][2] - x[b][2]};
    };
    const auto cross = [](const auto& u, const auto& v) {
      return std::array<std::int64_t, 3>{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                         u[0] * v[1] - u[1] * v[0]};
    };
    const auto dot = [](const auto& u, const auto& v) {
      return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    };
    const auto sign = [](std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; };
    const ExactPoints p = points_of(positions);
    const auto u = minus(1, 0), v = minus(2, 0), w = minus(3, 0);
    const auto n = cross(u, v);
    const std::int64_t volume = dot(n, w);
    const int orientation = sign(volume);
    ASSERT_EQ(exact::orient3d(p, 0, 1, 2, 3), orientation);
    const mpq_class step = std::ldexp(0x1.00001p10, static_cast<int>(-p.exponent()));
    const mpq_class expected = step * step * step * static_cast<long>(volume);
    ASSERT_EQ(exact::volume6(p, 0, 1, 2, 3).rational(), expected);
    ++counts[0][orientation + 1];
    const int angle = sign(dot(u, v));
    ASSERT_EQ(exact::dot_sign(p, 0, 1, 2), angle);
    ++counts[1][angle + 1];
    ASSERT_EQ(exact::collinear(p, 0, 1, 2), n == (std::array<std::int64_t, 3>{0, 0, 0}));
    // Lifted to the paraboloid: e is inside the sphere of abcd.
    const auto a = minus(0, 4), b = minus(1, 4), c = minus(2, 4), d = minus(3, 4);
    const std::int64_t lifted = dot(a, a) * dot(b, cross(c, d)) - dot(b, b) * dot(a, cross(c, d)) +
                                dot(c, c) * dot(a, cross(b, d)) - dot(d, d) * dot(a, cross(b, c));
    ASSERT_EQ(exact::insphere(p, 0, 1, 2, 3, 4), sign(lifted));
    ++counts[2][sign(lifted) + 1];
    if (dot(n, n) == 0) continue;
    // |w|^2 < 2 w . (centre - a), the centre as in circumcentre formulas.
    const auto vn = cross(v, n), nu = cross(n, u);
    const std::int64_t power =
        dot(w, w) * dot(n, n) - dot(u, u) * dot(w, vn) - dot(v, v) * dot(w, nu);
    ASSERT_EQ(exact::in_diametral_ball(p, 0, 1, 2, 3), power < 0);
    ++counts[3][sign(power) + 1];
  }
  for (const auto& of_predicate : counts) {
    for (const int count : of_predicate) EXPECT_GT(count, 100);
  }
}

// Of small tetrahedra far from the origin, most of them nearly flat, with corners that doubles do
// not hold: at most one of two volumes of opposite signs fits into a bound.
TEST(ExactSigns, QuickVolumesEncloseTheVolume) {
  std::mt19937_64 random(19);
  std::uniform_real_distribution<double> unit(-1, 1);
  int certain = 0;
  for (int round = 0; round < 3000; ++round) {
    const double size = std::ldexp(1, -int(random() % 40)), far = round % 2 == 0 ? 0 : 1000;
    std::vector<ExactPoint> definitions;
    for (int v = 0; v < 6; ++v) {
      const double height = round % 3 == 0 ? 0x1p-45 : 1;
      definitions.push_back({ExactPoint::Kind::explicit_point, 0, 0, 0, far + size * unit(random),
                             far + size * unit(random), far + height * size * unit(random)});
    }
    definitions.push_back({ExactPoint::Kind::on_segment, 0, 1, 0, 1 / 3.0, 0, 0});
    definitions.push_back({ExactPoint::Kind::on_triangle, 2, 3, 4, 1 / 3.0, 1 / 7.0, 0});
    ExactPoints points;
    ASSERT_EQ(points.assign(definitions), "");
    const std::array<Index, 4> tet = {5, 6, 7, static_cast<Index>(random() % 5)};
    const Interval quick = exact::quick_volume6(points, tet);
    const mpq_class volume = exact::volume6(points, tet[0], tet[1], tet[2], tet[3]).rational();
    const auto scaled = [&](double x) {
      return times_power_of_two(mpq_class(x), -3 * points.exponent());
    };
    ASSERT_LE(scaled(quick.low), volume) << round;
    ASSERT_GE(scaled(quick.high), volume) << round;
    certain += quick.sign() != 2 ? 1 : 0;
  }
  EXPECT_GT(certain, 1000);
  EXPECT_LT(certain, 2900);
}

TEST(ExactSigns, LengthsAndDoubles) {
  EXPECT_EQ(to_double(mpz_class(-5), 3), -40);
  EXPECT_EQ(to_double(mpz_class(3), -2), 0.75);
  EXPECT_EQ(to_double(mpz_class(0), 100), 0);
  EXPECT_EQ(to_double(mpz_class(1), 100000), kInfinity);
  EXPECT_EQ(to_double(mpz_class(1), -100000), 0);
  EXPECT_EQ(to_double(mpz_class(mpz_class(1) << 2000), -2000), 1);
  EXPECT_EQ(length({3, 4, 12}, 1), 26);
}

// Spheres of radius 1 around the origin: through the corners of a tetrahedron, of a triangle and
// the ends of an edge, diametral ones of the latter two.
TEST(BallSide, TellsInsideFromOutside) {
  const ExactPoints p = points_of({{1, 0, 0},
                                   {0, 1, 0},
                                   {0, 0, 1},
                                   {-1, 0, 0},
                                   {0, -1, 0},
                                   {0.5, 0.5, 0.5},
                                   {-0.5, 0.25, -0.75},
                                   {0.75, -0.75, 0.75},
                                   {0, 0, -2},
                                   {0, 0, -1}});
  // Positively oriented, as all tetrahedra of a mesh are.
  const bool positive = exact::orient3d(p, 0, 1, 2, 3) > 0;
  const std::array<Index, 4> tet =
      positive ? std::array<Index, 4>{0, 1, 2, 3} : std::array<Index, 4>{1, 0, 2, 3};
  for (const BallSide& ball :
       {BallSide::circumscribed(p, tet), BallSide::diametral(p, std::array<Index, 3>{0, 1, 3}),
        BallSide::diametral(p, 0, 3)}) {
    EXPECT_EQ(ball.side(5), -1);
    EXPECT_EQ(ball.side(6), -1);
    EXPECT_EQ(ball.side(7), 1);
    EXPECT_EQ(ball.side(8), 1);
    EXPECT_EQ(ball.side(4), 0);  // on the sphere, which rounded numbers cannot tell
    EXPECT_EQ(ball.side(9), 0);
  }
}

TEST(ExactNumber, IsAFieldWithoutDivision) {
  std::mt19937 random(7);
  const auto any = [&] {
    mpq_class q(static_cast<long>(random() % 2001) - 1000, 2 * (random() % 50) + 1);
    q.canonicalize();
    return q;
  };
  for (int round = 0; round < 2000; ++round) {
    const mpq_class p = any(), q = any();
    const ExactNumber a(p), b(q);
    EXPECT_EQ((a + b).rational(), p + q);
    EXPECT_EQ((a - b).rational(), p - q);
    EXPECT_EQ((a * b).rational(), p * q);
    EXPECT_EQ((-a).rational(), -p);
    ExactNumber sum = a;
    sum += b;
    EXPECT_EQ(sum.rational(), p + q);
    sum -= a;
    EXPECT_EQ(sum.rational(), q);
    EXPECT_EQ(sgn(a), sgn(p));
    EXPECT_EQ(cmp(a, b) > 0, p > q);
    EXPECT_EQ(a == b, p == q);
    EXPECT_EQ(a < b, p < q);
    EXPECT_EQ(a.shifted(3).rational(), p * 8);
    EXPECT_EQ((a * ExactNumber(8)).shifted(-3).rational(), p);
    EXPECT_EQ(a.is_integer(), p.get_den() == 1);
    if (q != 0) {
      EXPECT_EQ(ratio(a, b), p / q);
    }
    EXPECT_NEAR(to_double(a, 0), p.get_d(), 1e-15 * std::fabs(p.get_d()));
  }
}

TEST(ExactSum, IsEqualWhereTheNumbersAre) {
  std::mt19937 random(8);
  for (int round = 0; round < 200; ++round) {
    std::vector<mpq_class> terms;
    mpq_class total = 0;
    for (int i = 0; i < 30; ++i) {
      const unsigned long denominator = i % 3 == 0 ? 1 : 2 * (random() % 5000) + 1;
      mpq_class q(static_cast<long>(random() % 20001) - 10000, denominator);
      q.canonicalize();
      terms.push_back(q);
      total += q;
    }
    ExactSum forwards, backwards, other;
    for (const mpq_class& q : terms) forwards += ExactNumber(q);
    std::reverse(terms.begin(), terms.end());
    // In other pieces: two numbers are added as one.
    for (std::size_t i = 0; i < terms.size(); i += 2) {
      backwards += ExactNumber(mpq_class(terms[i] + terms[i + 1]));
    }
    EXPECT_TRUE(forwards == backwards);
    for (const mpq_class& q : terms) other += ExactNumber(q);
    other += ExactNumber(mpq_class(1, 1000003));
    EXPECT_FALSE(forwards == other);
    EXPECT_EQ(forwards.sign(), sgn(total));
    EXPECT_NEAR(forwards.value(0), total.get_d(), 1e-12 * (1 + std::fabs(total.get_d())));
    EXPECT_NEAR(difference(other, forwards, 0), 1e-6, 1e-9);
  }
}

TEST(ExactPoints, OnPlanesAreWhereThesePlanesMeet) {
  std::mt19937 random(9);
  const auto unit = [&] { return static_cast<double>(random()) * 0x1p-31 - 1; };
  for (int round = 0; round < 200; ++round) {
    std::vector<ExactRecord::Plane> planes(3);
    for (auto& plane : planes) {
      plane.spanned = random() % 2 == 0;
      plane.normal = {unit(), unit(), unit()};
      for (auto& p : plane.through) p = {unit(), unit(), unit()};
    }
    std::vector<ExactPoint> list = explicit_points(std::vector<Position>{{1, 2, 3}, {0, 1, 0.5}});
    ExactPoint meeting;
    meeting.kind = ExactPoint::Kind::on_planes;
    meeting.i = 0;
    meeting.j = 1;
    meeting.k = 2;
    list.push_back(meeting);
    ExactPoint middle;
    middle.kind = ExactPoint::Kind::on_segment;
    middle.i = 2;
    middle.j = 0;
    middle.x = 0.375;
    list.push_back(middle);
    ExactPoints points;
    ASSERT_EQ(points.assign(list, planes), "");
    const auto at = [&](Index v, int axis) { return coordinate(points, v, axis); };
    for (const auto& plane : planes) {
      mpq_class height = 0;
      for (int axis = 0; axis < 3; ++axis) {
        mpq_class n = plane.normal[axis];
        if (plane.spanned) {
          const int j = (axis + 1) % 3, k = (axis + 2) % 3;
          const auto side = [&](std::size_t i, int a) {
            return mpq_class(mpq_class(plane.through[i][a]) - mpq_class(plane.through[0][a]));
          };
          n = side(1, j) * side(2, k) - side(1, k) * side(2, j);
        }
        height += n * (at(2, axis) - mpq_class(plane.through[0][axis]));
      }
      EXPECT_EQ(height, 0);
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(at(3, axis), at(2, axis) * mpq_class(0.375) + at(0, axis) * mpq_class(0.625));
      for (const Index v : {2U, 3U}) {
        const Interval box = points.enclosure(v)[axis];
        EXPECT_LE(mpq_class(box.low), at(v, axis));
        EXPECT_GE(mpq_class(box.high), at(v, axis));
        const Interval rough = points.rough_difference(1, v)[axis];
        EXPECT_LE(mpq_class(rough.low), at(v, axis) - at(1, axis));
        EXPECT_GE(mpq_class(rough.high), at(v, axis) - at(1, axis));
      }
    }
  }
}

ExactPoint given(ExactPoint::Kind kind, Index i, Index j, Index k, double x = 0, double y = 0) {
  ExactPoint p;
  p.kind = kind;
  p.i = i;
  p.j = j;
  p.k = k;
  p.x = x;
  p.y = y;
  return p;
}

// normal . (v - p) for a point p of a plane that is not spanned.
mpq_class height_over(const ExactPoints& points, const ExactRecord::Plane& plane, Index v) {
  mpq_class height = 0;
  for (int axis = 0; axis < 3; ++axis) {
    height += mpq_class(plane.normal[axis]) *
              (coordinate(points, v, axis) - mpq_class(plane.through[0][axis]));
  }
  return height;
}

// Many triangles share sides, and sides are on one segment; some are in one plane by definition.
TEST(TriangleSums, AreThoseOfEachTriangleAlone) {
  using Kind = ExactPoint::Kind;
  std::mt19937 random(14);
  const auto unit = [&] { return static_cast<double>(random()) * 0x1p-31 - 1; };
  for (int round = 0; round < 100; ++round) {
    std::vector<ExactRecord::Plane> planes(6);
    for (auto& plane : planes) {
      plane.normal = {unit(), unit(), unit()};
      plane.through[0] = {unit(), unit(), unit()};
    }
    const std::vector<ExactPoint> list = {given(Kind::on_planes, 0, 1, 2),
                                          given(Kind::on_planes, 3, 0, 2),
                                          given(Kind::on_planes, 4, 5, 0),
                                          given(Kind::on_planes, 1, 2, 3),
                                          given(Kind::on_segment, 0, 1, 0, 0.375),
                                          given(Kind::on_segment, 0, 1, 0, 0.75),
                                          given(Kind::on_triangle, 0, 1, 2, unit(), 0.5),
                                          given(Kind::on_segment, 0, 3, 0, 0.5),
                                          given(Kind::explicit_point, 0, 0, 0, unit(), unit())};
    ExactPoints points;
    ASSERT_EQ(points.assign(list, planes), "");
    std::array<std::vector<std::array<Index, 3>>, 2> sets;
    std::array<ExactSum, 3> areas;
    ExactSum volumes;
    for (std::size_t set = 0; set < 2; ++set) {
      for (int n = 0; n < 8; ++n) {
        std::array<Index, 3> corners;
        for (Index& v : corners) v = static_cast<Index>(random() % list.size());
        sets[set].push_back(corners);
        const auto& [a, b, c] = corners;
        const ExactVector area = exact::area2(points, a, b, c);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          areas[axis] += set == 0 ? area[axis] : -area[axis];
        }
        if (set > 0) continue;
        volumes += exact::dot(points.exact(a), exact::cross(points.exact(b), points.exact(c)));
      }
    }
    EXPECT_EQ(sum_of_areas2(points, sets[0], sets[1]), areas);
    EXPECT_EQ(sum_from_origin6(points, sets[0]), volumes);
    // Four faces of two triangles' outline, with a point on the side between 0 and 1.
    const std::vector<std::array<Index, 3>> faces = {{0, 4, 6}, {4, 1, 6}, {1, 2, 6}, {2, 0, 6}};
    const std::vector<std::array<Index, 3>> whole = {{0, 1, 2}};
    EXPECT_EQ(sum_of_areas2(points, faces, whole), (std::array<ExactSum, 3>{}));
    const std::vector<std::array<Index, 3>> less = {{0, 4, 6}, {5, 1, 6}, {1, 2, 6}, {2, 0, 6}};
    EXPECT_NE(sum_of_areas2(points, less, whole), (std::array<ExactSum, 3>{}));
    EXPECT_EQ(sum_from_origin6(points, faces), sum_from_origin6(points, whole));
    EXPECT_NE(sum_from_origin6(points, less), sum_from_origin6(points, whole));
  }
}

// Points 0 to 3 are on plane 0, and so are 5 to 7, which are given by these; 4, 8 and 9 are not.
TEST(ExactPoints, AreInOnePlaneByTheirDefinitionsOnlyWhereTheyAreInOne) {
  using Kind = ExactPoint::Kind;
  std::mt19937 random(12);
  const auto unit = [&] { return static_cast<double>(random()) * 0x1p-31 - 1; };
  for (int round = 0; round < 100; ++round) {
    std::vector<ExactRecord::Plane> planes(7);
    for (auto& plane : planes) {
      plane.normal = {unit(), unit(), unit()};
      plane.through[0] = {unit(), unit(), unit()};
    }
    const std::vector<ExactPoint> list = {given(Kind::on_planes, 0, 1, 2),
                                          given(Kind::on_planes, 3, 0, 2),
                                          given(Kind::on_planes, 4, 5, 0),
                                          given(Kind::on_planes, 0, 6, 1),
                                          given(Kind::on_planes, 1, 2, 3),
                                          given(Kind::on_segment, 0, 1, 0, 0.375),
                                          given(Kind::on_triangle, 1, 2, 3, 0.25, unit()),
                                          given(Kind::on_triangle, 0, 1, 2, unit(), 0.5),
                                          given(Kind::on_segment, 0, 4, 0, 0.5),
                                          given(Kind::explicit_point, 0, 0, 0, unit(), unit())};
    ExactPoints points;
    ASSERT_EQ(points.assign(list, planes), "");
    const Index plane = points.common_plane(std::array<Index, 3>{0, 6, 7});
    ASSERT_NE(plane, kNone);
    const ExactVector normal = points.normal_of(plane);
    const mpq_class scale = normal[0].rational() / mpq_class(planes[0].normal[0]);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(normal[axis].rational(), scale * mpq_class(planes[0].normal[axis]));
    }
    for (Index v = 0; v < list.size(); ++v) {
      const mpq_class height = height_over(points, planes[0], v);
      EXPECT_EQ(points.side_of(plane, v), sgn(height) * sgn(scale)) << v;
      EXPECT_EQ(points.is_defined_on(v, plane), v != 4 && v < 8) << v;
      EXPECT_EQ(height == 0, v != 4 && v < 8) << v;
    }
    const mpq_class s(list[7].x), t(list[7].y);
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = [&](Index corner) { return coordinate(points, corner, axis); };
      EXPECT_EQ(at(7), s * at(0) + t * at(1) + (1 - s - t) * at(2));
    }
    // Planes of two points are of no use.
    EXPECT_EQ(points.common_plane(std::array<Index, 2>{2, 9}), kNone);
    EXPECT_EQ(points.common_plane(std::array<Index, 3>{2, 3, 4}), kNone);
    int flat = 0;
    for (Index v = 0; v < list.size(); ++v) {
      const std::array<Index, 4> all = {v, (v + 1) % 10, (v + 3) % 10, (v + 6) % 10};
      const bool zero = exact::volume6(points, all[0], all[1], all[2], all[3]) == 0;
      const bool surely = points.surely_coplanar(all);
      if (surely) {
        EXPECT_TRUE(zero) << v;
      }
      EXPECT_EQ(exact::orient3d(points, all[0], all[1], all[2], all[3]) == 0, zero) << v;
      flat += surely ? 1 : 0;
    }
    EXPECT_TRUE(points.surely_coplanar(std::array<Index, 4>{0, 5, 6, 7}));
    EXPECT_TRUE(points.surely_coplanar(std::array<Index, 4>{0, 4, 8, 9}));
    EXPECT_FALSE(points.surely_coplanar(std::array<Index, 4>{0, 1, 4, 9}));
    EXPECT_TRUE(points.surely_coplanar(std::array<Index, 3>{0, 4, 9}));
    EXPECT_LT(flat, 10);
  }
}

}  // namespace
}  // namespace tetproof
