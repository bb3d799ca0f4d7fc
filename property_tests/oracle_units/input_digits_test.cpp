// How far planar facets may be from planar by the digits of the input.
#include "oracles/surface/input_digits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

#include "mesher/surface/test_surfaces.h"
#include "oracles/surface/edge_noise.h"

namespace tetproof::oracles {
namespace {

using delmesher::surface::test_surfaces::to_single;

constexpr double kAlways = 0x1p-18;

// In a box with corners at 0 and 100, to `unit`.
std::vector<Position> numbers(double unit) {
  std::mt19937 random(5);
  std::vector<Position> result = {{0, 0, 0}, {100, 100, 100}};
  for (int n = 0; n < 100; ++n) {
    Position p;
    for (double& x : p) {
      const double some = static_cast<double>(random()) * 0x1p-32 * 100;
      x = unit > 0 ? std::round(some / unit) / std::round(1 / unit) : some;
    }
    result.push_back(p);
  }
  return result;
}

// Six halves of a unit per axis, over the diagonal.
double share(double unit, double size) {
  return 6 * (unit / 2) / size;
}

TEST(InputDigits, DecimalsLetDeviateByTheirLastPlace) {
  EXPECT_NEAR(automatic_planar_share(numbers(1e-3)), share(1e-3, 100), 1e-15);
  EXPECT_EQ(automatic_planar_share(numbers(1e-6)), kAlways);
  EXPECT_EQ(automatic_planar_share(numbers(1e-1)), kAlways);  // too coarse: meant
  EXPECT_EQ(automatic_planar_share(numbers(1)), kAlways);
  EXPECT_EQ(automatic_planar_share(numbers(0)), kAlways);
}

TEST(InputDigits, OneNumberWithMoreCounts) {
  std::vector<Position> p = numbers(1e-3);
  p.back()[1] = 1.2345;
  EXPECT_EQ(automatic_planar_share(p), kAlways);
  p.back()[1] = 12.3456;  // six digits, as printed: 100 has three behind the point then
  EXPECT_NEAR(automatic_planar_share(p), share(1e-3, 100), 1e-15);
  p.back()[1] = 1 / 3.0;
  EXPECT_EQ(automatic_planar_share(p), kAlways);
}

TEST(InputDigits, SixDigitsArePrintedDigits) {
  std::vector<Position> p = numbers(1e-3);
  p.back() = {0.00123456, 0.0123456, 0.123456};
  EXPECT_NEAR(automatic_planar_share(p), share(1e-3, 100), 1e-15);
}

TEST(InputDigits, SinglePrecisionFarAway) {
  std::vector<Position> p = numbers(0);
  for (Position& q : p) {
    for (double& x : q) x = to_single(x + 5000);  // up to 8191
  }
  EXPECT_NEAR(automatic_planar_share(p), share(0x1p-11, 100), 1e-15);
  for (Position& q : p) {
    for (double& x : q) x += 0x1p-30;
  }
  EXPECT_EQ(automatic_planar_share(p), kAlways);
}

TEST(InputDigits, OfSmallAndLargeModels) {
  for (const double size : {1e-40, 1e40}) {
    std::vector<Position> p = numbers(1e-3);
    for (Position& q : p) {
      for (double& x : q) x = std::stod(std::to_string(x) + (size < 1 ? "e-40" : "e40"));
    }
    // Of the small one all are behind the point; those of the large one are integers.
    EXPECT_NEAR(automatic_planar_share(p), size < 1 ? share(1e-3, 100) : kAlways, 1e-15);
  }
  EXPECT_EQ(automatic_planar_share(std::vector<Position>{}), kAlways);
}

// Decimals below 1, and numbers of single precision, that were rounded before a power of two made
// them small or large. The mesher takes out that power again.
TEST(InputDigits, OfModelsTimesPowersOfTwo) {
  std::vector<Position> decimal = numbers(1e-3), single = numbers(0);
  for (Position& q : decimal) {
    for (double& x : q) x = std::round(x * 800) / 1e5;  // up to 0.8
  }
  for (Position& q : single) {
    for (double& x : q) x = to_single(x + 5000);
  }
  for (const int power : {-300, -90, 0, 90, 300}) {
    const auto scaled = [power](std::vector<Position> p) {
      for (Position& q : p) {
        for (double& x : q) x = std::ldexp(x, power);
      }
      return p;
    };
    EXPECT_NEAR(automatic_planar_share(scaled(decimal)), share(1e-5, 0.8), 1e-15) << power;
    EXPECT_NEAR(automatic_planar_share(scaled(single)), share(0x1p-11, 100), 1e-15) << power;
  }
  // Not if a number would lose digits.
  std::vector<Position> p = decimal;
  for (Position& q : p) {
    for (double& x : q) x = std::ldexp(x, 300);
  }
  p.front()[0] = 0x1p-1074;
  EXPECT_EQ(automatic_planar_share(p), kAlways);
}

// The largest number on an axis is 0.01, which in single precision is slightly less.
TEST(InputDigits, OfNumbersPrintedWithTheirDigits) {
  std::vector<Position> p = numbers(0);
  for (Position& q : p) {
    for (double& x : q) {
      char text[32];
      std::snprintf(text, sizeof text, "%.6g", x * 1e-4);
      x = static_cast<double>(std::strtof(text, nullptr));
    }
  }
  EXPECT_NEAR(automatic_planar_share(p), share(1e-7, 0.01), 1e-12);
}

// A height field over a square of 12 x 12 cells, 1 wide, without a bottom. Heights in 0.8.
Polyhedron field(const std::function<double(std::uint32_t, std::uint32_t)>& height) {
  constexpr std::uint32_t kCells = 12, kWide = kCells + 1;
  Polyhedron field;
  for (std::uint32_t i = 0; i < kWide; ++i) {
    for (std::uint32_t j = 0; j < kWide; ++j) {
      field.vertices.push_back({i / 12.0, j / 12.0, height(i, j)});
      if (i == kCells || j == kCells) continue;
      const Index a = i * kWide + j, b = a + kWide;
      field.triangles.push_back({a, b, b + 1});
      field.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return field;
}

TEST(EdgeNoise, OfRandomHeights) {
  std::mt19937 random(7);
  for (const double most : {1e-5, 1e-7}) {
    const auto any = [&] { return most * (static_cast<double>(random()) * 0x1p-31 - 1); };
    const Polyhedron noisy = field([&](auto, auto) { return any(); });
    const double share = noise_of_edges(noisy) * std::sqrt(2);
    EXPECT_GT(share, most / 4);
    EXPECT_LT(share, 2 * most);
    EXPECT_EQ(automatic_planar_share(noisy), std::max(kAlways, 16 * noise_of_edges(noisy)));
    for (const int power : {-900, 900}) {
      Polyhedron scaled = noisy;
      for (Position& p : scaled.vertices) {
        for (double& x : p) x = std::ldexp(x, power);
      }
      EXPECT_DOUBLE_EQ(noise_of_edges(scaled), noise_of_edges(noisy));
    }
  }
  const Polyhedron coarse =
      field([&](auto, auto) { return 1e-3 * static_cast<double>(random()) * 0x1p-32; });
  EXPECT_LT(noise_of_edges(coarse), 1e-5);
}

// Two of its vertices are lifted by six times the noise: that bends the edges at them by about four
// times it, and those across from them by twice as much as it.
TEST(EdgeNoise, OfAFieldWithAFewEdgesBentByMore) {
  std::mt19937 random(9);
  const double most = 1e-6;
  const Polyhedron some = field([&](auto i, auto j) {
    const double noise = most * (static_cast<double>(random()) * 0x1p-31 - 1);
    return noise + (i == 4 && (j == 4 || j == 8) ? 6 * most : 0);
  });
  EXPECT_GT(noise_of_edges(some) * std::sqrt(2), most / 4);
  EXPECT_LT(noise_of_edges(some) * std::sqrt(2), 3 * most);
}

// A third of the field in each direction has noise, and the rest a hundredth of it, which hides it.
TEST(EdgeNoise, BelowAFinerOne) {
  std::mt19937 random(10);
  const double most = 1e-6;
  const Polyhedron both = field([&](auto i, auto j) {
    return (i < 5 && j < 5 ? most : most / 100) * (static_cast<double>(random()) * 0x1p-31 - 1);
  });
  EXPECT_LT(noise_of_edges(both) * std::sqrt(2), most / 10);
  const double share = noise_of_edges(both, most / 50) * std::sqrt(2);
  EXPECT_GT(share, most / 4);
  EXPECT_LT(share, 2 * most);
}

TEST(EdgeNoise, TakesEightEdgesOfBothSides) {
  const auto bent_pairs = [](std::uint32_t n, std::uint32_t convex) {
    Polyhedron pairs;
    for (Index i = 0; i < n; ++i) {
      const double x = i;
      const Index a = 4 * i;
      const double height = 1e-6 * (x + 1) * (i % n < convex ? -1 : 1);
      pairs.vertices.insert(pairs.vertices.end(),
                            {{x, 0, 0}, {x + 0.5, 0, 0}, {x + 0.5, 1, 0}, {x, 1, height}});
      pairs.triangles.push_back({a, a + 1, a + 2});
      pairs.triangles.push_back({a, a + 2, a + 3});
    }
    return pairs;
  };
  EXPECT_EQ(noise_of_edges(bent_pairs(7, 3)), 0);
  EXPECT_GT(noise_of_edges(bent_pairs(8, 4)), 0);
  // Fifteen, if smaller ones are left out.
  EXPECT_EQ(noise_of_edges(bent_pairs(14, 7), 1e-12), 0);
  EXPECT_GT(noise_of_edges(bent_pairs(15, 7), 1e-12), 0);
  for (const std::uint32_t convex : {0U, 12U}) EXPECT_EQ(noise_of_edges(bent_pairs(12, convex)), 0);
}

TEST(EdgeNoise, IsNeitherGroovesNorDomesNorAFewEdges) {
  // Of one size.
  EXPECT_EQ(noise_of_edges(field([](auto i, auto) { return i % 2 == 0 ? 1e-5 : 0; })), 0);
  // Of all sizes to both sides, and larger ones without end.
  EXPECT_EQ(noise_of_edges(field([](auto i, auto j) {
              return 6e-7 * std::exp2(0.8 * i) * ((i + j) % 2 == 0 ? 1 : -1);
            })),
            0);
  // Far above the noise.
  std::mt19937 random(8);
  EXPECT_LT(noise_of_edges(field([&](auto i, auto j) {
              const double noise = 1e-9 * static_cast<double>(random()) * 0x1p-32;
              return noise + (i == 6 && j == 6 ? 1e-5 : i == 3 && j == 6 ? 3e-6 : 0);
            })),
            1e-9);
  EXPECT_EQ(noise_of_edges(field([](auto i, auto j) { return i == 6 && j == 6 ? 1e-5 : 0; })), 0);
  EXPECT_EQ(noise_of_edges({}), 0);
}

}  // namespace
}  // namespace tetproof::oracles
