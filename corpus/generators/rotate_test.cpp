#include "corpus/generators/rotate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "corpus/generators/certify.h"
#include "corpus/generators/shapes.h"
#include "corpus/generators/test_surfaces.h"

namespace tetproof {
namespace {

using delmesher::Surface;
using test_surfaces::a_box;
using test_surfaces::volume;
using Point = std::array<double, 3>;

double distance2(const Point& p, const Point& q) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (p[i] - q[i]) * (p[i] - q[i]);
  return sum;
}

double largest_coordinate(const Surface& s) {
  double largest = 0;
  for (const Point& p : s.vertices) {
    for (const double x : p) largest = std::max(largest, std::fabs(x));
  }
  return largest;
}

// Width 2^bits roundings of the farthest coordinate, up to the rounding of both ends.
TEST(Coarsened, IsAsManyRoundingsWideAsAskedFor) {
  Random random(5);
  for (int bits = 2; bits <= 30; bits += 4) {
    for (int k = 0; k < 20; ++k) {
      const Surface coarse = coarsened(a_box(), bits, random);
      double widest = 0, unit = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [low, high] =
            std::minmax_element(coarse.vertices.begin(), coarse.vertices.end(),
                                [i](const Point& p, const Point& q) { return p[i] < q[i]; });
        widest = std::max(widest, (*high)[i] - (*low)[i]);
      }
      for (const Point& p : coarse.vertices) {
        for (const double c : p) {
          const double x = std::fabs(c);
          unit = std::max(unit, std::nextafter(x, HUGE_VAL) - x);
        }
      }
      // Half as many where the solid reaches beyond the next power of two.
      EXPECT_LE(widest / unit, std::ldexp(1, bits) + 1);
      EXPECT_GE(widest / unit, std::ldexp(0.5, bits) - 1);
      EXPECT_LE(largest_coordinate(coarse), 0x1p26 + 1);
      EXPECT_TRUE(certified_valid(coarse) || bits < 8) << bits;
    }
  }
}

TEST(Rotated, KeepsDistancesAndOrientation) {
  const Surface given = a_box();
  for (const Quaternion& q : kRotations) {
    const Surface turned = rotated(given, q, Precision::doubles);
    ASSERT_EQ(turned.triangles, given.triangles);
    for (std::size_t v = 0; v < given.vertices.size(); ++v) {
      for (std::size_t w = 0; w < v; ++w) {
        const double before = distance2(given.vertices[v], given.vertices[w]);
        EXPECT_NEAR(distance2(turned.vertices[v], turned.vertices[w]), before, 1e-14 * before);
      }
      EXPECT_NE(turned.vertices[v], given.vertices[v]);
    }
    EXPECT_NEAR(volume(turned), volume(given), 1e-13);
    EXPECT_TRUE(certified_valid(turned));
  }
}

TEST(Rotated, OtherRotationsTurnEveryAxis) {
  Random random(1), same(1);
  const Quaternion first = rotation_from(random);
  EXPECT_EQ(rotation_from(same), first);
  for (int n = 0; n < 50; ++n) {
    const Quaternion q = rotation_from(random);
    EXPECT_NE(q, first);
    const Surface axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}, {}};
    for (const Point& p : rotated(axes, q, Precision::doubles).vertices) {
      EXPECT_LT(*std::max_element(p.begin(), p.end()), 1);
      EXPECT_NEAR(distance2(p, {0, 0, 0}), 1, 1e-14);
    }
  }
}

TEST(Rotated, AQuarterTurnIsExact) {
  const Surface given = a_box();
  const Surface turned = rotated(given, {1, 0, 0, 1}, Precision::doubles);  // about z
  for (std::size_t v = 0; v < given.vertices.size(); ++v) {
    const Point& p = given.vertices[v];
    EXPECT_EQ(turned.vertices[v], (Point{-p[1], p[0], p[2]}));
  }
}

TEST(Rotated, HasTheDigitsOfItsPrecision) {
  const Surface exact = rotated(a_box(), kRotations[0], Precision::doubles);
  const Surface single = rotated(a_box(), kRotations[0], Precision::single);
  const Surface decimals = rotated(a_box(), kRotations[0], Precision::decimals);
  std::size_t more_than_single = 0;
  for (std::size_t v = 0; v < exact.vertices.size(); ++v) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = exact.vertices[v][i];
      const double s = single.vertices[v][i], d = decimals.vertices[v][i];
      EXPECT_EQ(static_cast<double>(static_cast<float>(s)), s);
      EXPECT_NEAR(s, x, std::ldexp(std::fabs(x), -24));
      std::ostringstream text;
      text.precision(6);
      text << d;
      EXPECT_EQ(std::stod(text.str()), d);
      EXPECT_NEAR(d, x, 5e-6 * std::fabs(x));
      if (s != x) ++more_than_single;
    }
  }
  EXPECT_GT(more_than_single, 10U);  // else nothing was rounded
}

TEST(Noise, IsAsLargeAsItIsTold) {
  const Surface given = a_box();
  for (const int bits : {10, 30, 45}) {
    Surface moved = given;
    Random random(static_cast<std::uint64_t>(bits));
    add_noise(moved, std::ldexp(1.0, -bits), random);
    const double bound = std::ldexp(largest_coordinate(given), -bits);
    double largest = 0;
    for (std::size_t v = 0; v < given.vertices.size(); ++v) {
      for (std::size_t i = 0; i < 3; ++i) {
        largest = std::max(largest, std::fabs(moved.vertices[v][i] - given.vertices[v][i]));
      }
    }
    EXPECT_LE(largest, bound * (1 + 0x1p-6));
    EXPECT_GT(largest, bound / 4);
  }
}

TEST(Splits, KeepAClosedSurfaceAndItsLabels) {
  Surface s = a_box();
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    s.labels.push_back(static_cast<std::int32_t>(t));
  }
  Random random(5);
  split_at_rounded_point(s, 3, random);
  EXPECT_EQ(s.triangles.size(), 14U);
  EXPECT_EQ(std::count(s.labels.begin(), s.labels.end(), 3), 3);
  split_at_rounded_point(s, 7, 1, random);
  EXPECT_EQ(s.triangles.size(), 16U);
  EXPECT_EQ(s.vertices.size(), 10U);
  ASSERT_EQ(s.labels.size(), 16U);
  EXPECT_EQ(std::count(s.labels.begin(), s.labels.end(), 7), 2);
  // Only a point beside an edge or a facet may have made it intersect itself, not a missing twin.
  const auto defect = first_defect(s);
  EXPECT_TRUE(!defect || *defect == delmesher::Defect::Kind::self_intersection);
  EXPECT_NEAR(volume(s), volume(a_box()), 1e-14);
}

}  // namespace
}  // namespace tetproof
