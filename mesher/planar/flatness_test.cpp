#include "mesher/planar/flatness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesher/planar/edge_bends.h"
#include "mesher/surface/test_surfaces.h"

namespace delmesher::planar {
namespace {

using namespace surface::test_surfaces;  // NOLINT(google-build-using-namespace)

double flatness(const Surface& s) {
  Limits limits;
  Control control{limits};
  return planar::flatness(s, control);
}

// Every coordinate off by up to `noise`, as of a hash of its number.
Surface jittered(Surface s, double noise) {
  std::uint32_t n = 0;
  for (Point& p : s.vertices) {
    for (double& x : p) x += noise * (static_cast<double>(++n * 2654435761U) * 0x1p-31 - 1);
  }
  return s;
}

TEST(Flatness, IsAsCoarseAsTheCoordinates) {
  const Surface s = rotated(box({0, 0, 0}, {1, 2, 3}, 5));
  EXPECT_LE(flatness(s), 0x1p-42);
  EXPECT_GE(flatness(s), 0x1p-46);
  const double single = flatness(in_single_precision(s));
  EXPECT_GE(single, 0x1p-24);
  EXPECT_LE(single, 0x1p-19);
  for (const double noise : {1e-7, 1e-10}) {
    EXPECT_GE(flatness(jittered(s, noise)), noise);
    EXPECT_LE(flatness(jittered(s, noise)), 8 * noise);
  }
}

TEST(Flatness, NeverMoreThanAMillionthOfTheSize) {
  const Surface s = rotated(box({0, 0, 0}, {1, 2, 3}, 5));
  const double most = 0x1p-20 * std::sqrt(3 * 14.0);  // of a box around all of its rotations
  EXPECT_LE(flatness(jittered(s, 1e-6)), most * (1 + 1e-9));
  // Bends of a tenth of a degree are meant.
  Surface bent = box({0, 0, 0}, {1, 2, 3}, 2);
  for (Point& p : bent.vertices) {
    if (p[0] == 0.5) p[0] += std::tan(0.1 / 180 * std::acos(-1.0));
  }
  EXPECT_LE(flatness(rotated(bent)), 0x1p-42);
}

// Half a unit on each axis.
double rounding(double unit) {
  return unit * std::sqrt(3) / 2;
}

TEST(Flatness, IsWhatFewDigitsExplain) {
  const Surface s = scaled(rotated(box({0, 0, 0}, {1, 2, 3}, 5)), 30);
  const double decimals = flatness(in_decimals(s, 1e-3));
  EXPECT_GE(decimals, rounding(1e-3));
  EXPECT_LE(decimals, 2 * rounding(1e-3));
  Surface far = s;
  for (Point& p : far.vertices) p = {p[0] + 5000, p[1] + 6000, p[2] + 7000};  // up to 8191
  const double single = flatness(in_single_precision(far));
  EXPECT_GE(single, rounding(0x1p-11));
  EXPECT_LE(single, 2 * rounding(0x1p-11));
}

double diagonal(const Surface& s) {
  Point low = s.vertices[0], high = low;
  for (const Point& p : s.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

// A torus of radii 40 and 20 has edges of all small bends. With `winding` its quadrangles are not
// flat.
Surface torus(std::uint32_t around, std::uint32_t across, double winding = 0) {
  const double turn = 2 * std::acos(-1.0);
  Surface torus;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = turn * i / around, v = turn * j / across + winding * u,
                   r = 40 + 20 * std::cos(v);
      torus.vertices.push_back({r * std::cos(u), r * std::sin(u), 20 * std::sin(v)});
      const std::uint32_t k = (i + 1) % around, l = (j + 1) % across;
      const std::uint32_t c = k * across + l, a = i * across + j;
      torus.triangles.push_back({a, k * across + j, c});
      torus.triangles.push_back({a, c, i * across + l});
    }
  }
  return torus;
}

TEST(Flatness, FewDigitsDoNotFlattenWhatIsCurved) {
  for (const double unit : {1e-3, 5e-4}) {
    const Surface curved = in_decimals(torus(300, 150, 1), unit);
    EXPECT_LE(flatness(curved), 0x1p-20 * diagonal(curved));
    // Its quadrangles are flat except for half a unit, and no more is.
    EXPECT_LE(flatness(in_decimals(torus(300, 150), unit)), 4 * rounding(unit));
  }
}

TEST(Flatness, FewDigitsFlattenFlatFacesBesideCurvedOnes) {
  const Surface flat = scaled(rotated(box({0, 0, 0}, {1, 2, 3}, 5)), 30);
  for (const std::uint32_t across : {20U, 90U, 100U}) {
    const Surface both = joined(flat, torus(2 * across, across));
    EXPECT_GE(flatness(in_decimals(both, 1e-3)), rounding(1e-3)) << across;
  }
}

// The digits tell of the last rounding alone, and those of integers tell nothing.
TEST(Flatness, IsWhatBendsTellOfCoarserRoundings) {
  const Surface s = rotated(scaled(box({0, 0, 0}, {1, 2, 3}, 5), 30));
  const Surface coarse = in_decimals(s, 1e-3);
  for (const Surface& twice :
       {rotated(coarse), in_single_precision(rotated(coarse)), in_decimals(rotated(coarse), 1e-5),
        scaled(in_decimals(scaled(s, 1e3), 1), 1e-3), scaled(in_decimals(scaled(s, 1e3), 1), 1)}) {
    const double unit = std::fabs(twice.vertices.back()[0]) > 1e3 ? 1 : 1e-3;
    EXPECT_GE(flatness(twice), rounding(unit));
    EXPECT_LE(flatness(twice), 4 * rounding(unit));
  }
}

// A few faces have a noise of their own, and all have that of single precision, which hides it if
// all bends are counted. Where those few are curved instead, or grooves of one depth, there is
// nothing to be found.
TEST(Flatness, IsWhatBendsTellOfNoiseBelowAFinerRounding) {
  const double noise = 1e-5;
  const Surface many = rotated(box({0, 0, 0}, {1, 2, 3}, 8)), few = box({4, 0, 0}, {5, 1, 1}, 3);
  Surface grooved = box({4, 0, 0}, {5, 1, 1}, 6);
  for (Point& p : grooved.vertices) {
    if (p[0] == 5 && std::fmod(std::round(6 * p[1]), 2) == 1) p[0] -= noise;
  }
  const Surface noisy = joined(many, jittered(rotated(few), noise));
  for (const Surface& s :
       {noisy, in_single_precision(noisy), rotated(in_single_precision(noisy))}) {
    EXPECT_GE(flatness(s), noise);
    EXPECT_LE(flatness(s), 8 * noise);
  }
  const Surface ring = rotated(prism(ellipse(400), 1));
  const Surface curved = scaled(torus(120, 60), 1.0 / 60);
  for (const Surface& meant : {ring, curved, rotated(grooved)}) {
    const Surface both = in_single_precision(joined(many, meant));
    EXPECT_LE(flatness(both), 0x1p-20 * diagonal(both));
    EXPECT_LE(flatness(rotated(both)), 0x1p-20 * diagonal(rotated(both)));
  }
}

// Facets and curves that are hardly larger than the noise, and cannot be distinguished from it by
// the sizes of the bends.
TEST(Flatness, CoarserRoundingsDoNotFlattenWhatIsCurved) {
  for (const Surface& curved :
       {rotated(in_decimals(torus(300, 150, 1), 1e-3)), torus(1000, 500, 1),
        in_decimals(scaled(rotated(prism(ellipse(1000), 1)), 1e5 / 3), 1)}) {
    EXPECT_LE(flatness(curved), 0x1p-20 * diagonal(curved));
  }
}

// A tube along a knot on a torus, whose sections turn as little as they can. Its edges are bent by
// all small sizes, to both sides.
Surface knot_tube(double p, double q, std::uint32_t along, std::uint32_t around) {
  const double turn = 2 * std::acos(-1.0), radius = 0.08;
  const auto centre = [&](double t) -> Point {
    const double r = 2 + std::cos(q * t);
    return {r * std::cos(p * t), r * std::sin(p * t), std::sin(q * t)};
  };
  const auto unit = [](Point v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    return Point{v[0] / length, v[1] / length, v[2] / length};
  };
  const auto less = [](const Point& a, double x, const Point& b) {
    return Point{a[0] - x * b[0], a[1] - x * b[1], a[2] - x * b[2]};
  };
  const auto dot = [](const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  const auto cross = [](const Point& a, const Point& b) {
    return Point{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  std::vector<Point> tangent, side;
  for (std::uint32_t i = 0; i <= along; ++i) {
    const double t = turn * i / along, h = 1e-4;
    tangent.push_back(unit(less(centre(t + h), 1, centre(t - h))));
    const Point before = i == 0 ? centre(t) : side.back();
    side.push_back(unit(less(before, dot(before, tangent[i]), tangent[i])));
  }
  // Once around, a section has turned by this much.
  const double twist =
      std::atan2(dot(cross(side[along], side[0]), tangent[0]), dot(side[along], side[0]));
  Surface tube;
  for (std::uint32_t i = 0; i < along; ++i) {
    const Point c = centre(turn * i / along), u = side[i], w = cross(tangent[i], u);
    for (std::uint32_t j = 0; j < around; ++j) {
      const double a = turn * j / around + twist * i / along;
      tube.vertices.push_back(less(less(c, -radius * std::cos(a), u), -radius * std::sin(a), w));
      const std::uint32_t k = (i + 1) % along, l = (j + 1) % around;
      tube.triangles.push_back({i * around + j, k * around + l, k * around + j});
      tube.triangles.push_back({i * around + j, i * around + l, k * around + l});
    }
  }
  return tube;
}

// Bends of a smooth surface are like their neighbours', those of noise are not, even of the same
// sizes.
TEST(Flatness, ShapeIsNoNoise) {
  for (const auto& [p, q, along, around] : {std::array<std::uint32_t, 4>{7, 5, 360, 4},
                                            {7, 5, 180, 8},
                                            {7, 5, 360, 6},
                                            {5, 7, 360, 3},
                                            {5, 7, 480, 4},
                                            {5, 7, 300, 5}}) {
    const Surface tube = knot_tube(p, q, along, around);
    EXPECT_LE(flatness(tube), 1e-13 * diagonal(tube)) << p << " " << q << " " << along;
  }
  EXPECT_LT(roughness(knot_tube(7, 5, 360, 4), 0, 1e-4), 0.2);
  EXPECT_GT(roughness(jittered(rotated(box({0, 0, 0}, {1, 2, 3}, 8)), 1e-5), 0, 1e-4), 0.8);
}

TEST(Flatness, ScalesWithTheSurface) {
  Surface s = in_single_precision(rotated(box({0, 0, 0}, {1, 2, 3}, 3)));
  const double before = flatness(s);
  for (Point& p : s.vertices) {
    for (double& x : p) x = std::ldexp(x, 30);
  }
  EXPECT_EQ(flatness(s), std::ldexp(before, 30));
}

}  // namespace
}  // namespace delmesher::planar
