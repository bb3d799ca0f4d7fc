#include "mesher/policies/default_size.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace delmesher::policies {
namespace {

// A box in n slices of six tetrahedra each.
Result box(double length, double width, double height, std::uint32_t n) {
  Result result;
  TetMesh& mesh = result.mesh;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t v = 0; v < 4; ++v) {
      mesh.vertices.push_back({length * i / n, width * (v & 1), height * (v >> 1)});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t o = 4 * i, p = o + 7;
    for (const auto& [a, b] :
         {std::array<std::uint32_t, 2>{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}}) {
      mesh.tetrahedra.push_back({o, o + a, o + b, p});
    }
  }
  const std::uint32_t e = 4 * n;
  for (const auto& [a, b, c, d] : {std::array<std::uint32_t, 4>{0, 1, 3, 2},
                                   {e, e + 1, e + 3, e + 2},
                                   {0, 1, e + 1, e},
                                   {2, 3, e + 3, e + 2},
                                   {0, 2, e + 2, e},
                                   {1, 3, e + 3, e + 1}}) {
    mesh.boundary.push_back({a, b, c});
    mesh.boundary.push_back({a, c, d});
  }
  result.statistics.bbox_diagonal = std::hypot(length, width, height);
  return result;
}

// A cube has 5.77^3 cubes of a tenth of its diagonal, of 9.8 tetrahedra each.
TEST(DefaultSize, HalfOfWhatItMakesIsTooCoarse) {
  EXPECT_NEAR(default_size(box(1, 1, 1, 1)).size, std::sqrt(3) / 10, 1e-12);
  EXPECT_GT(default_size(box(1, 1, 1, 155)).size, 0);  // 930 tetrahedra
  EXPECT_EQ(default_size(box(1, 1, 1, 160)).size, 0);  // 960
}

// Twice the volume of a bar by its area is 0.48, less than a twentieth of 10.1. Lengths are in any
// unit.
TEST(DefaultSize, IsSmallerInThinParts) {
  for (const double unit : {0x1p-60, 0x1p60}) {
    const Result block = box(2 * unit, unit, unit, 3), bar = box(10 * unit, unit, unit, 3);
    EXPECT_EQ(default_size(block).size, block.statistics.bbox_diagonal / 10);
    EXPECT_EQ(default_size(bar).size, bar.statistics.bbox_diagonal / 20);
  }
}

// Thinner than a tenth of a twentieth of the diagonal, which is 0.0071.
TEST(DefaultSize, IsNoneForFoils) {
  EXPECT_GT(default_size(box(1, 1, 0.01, 1)).size, 0);
  EXPECT_EQ(default_size(box(1, 1, 0.005, 1)).size, 0);
}

TEST(DefaultSize, IsOfUseUnlessOneInTenIsFlat) {
  Result sized;
  sized.statistics.final.tetrahedra = 100;
  sized.statistics.final.below_5 = 10;
  EXPECT_EQ(why_not(sized, {}), "");
  sized.statistics.final.below_5 = 11;
  EXPECT_NE(why_not(sized, {}), "");
  sized.statistics.final.below_5 = 0;
  sized.statistics.rounding_flat = 1;
  EXPECT_NE(why_not(sized, {}), "");
}

TEST(DefaultSize, IsChosenWhereNothingElseDecides) {
  EXPECT_TRUE(may_choose_size({}));
  const auto with = [](const auto& change) {
    Options options;
    change(options);
    return may_choose_size(options);
  };
  EXPECT_TRUE(with([](Options& o) { o.surface = SurfaceChoice::split; }));
  EXPECT_FALSE(with([](Options& o) { o.surface = SurfaceChoice::keep; }));
  EXPECT_FALSE(with([](Options& o) { o.size = 0; }));
  EXPECT_FALSE(with([](Options& o) { o.max_edge = 1; }));
  EXPECT_FALSE(with([](Options& o) { o.size_field = {{{0, 0, 0}, 1}}; }));
  EXPECT_FALSE(with([](Options& o) { o.budget = 100; }));
  EXPECT_FALSE(with([](Options& o) { o.tolerance = -1e-3; }));
  EXPECT_FALSE(with([](Options& o) { o.regions = Regions::all; }));
  EXPECT_FALSE(with([](Options& o) { o.approximate = true; }));
  EXPECT_FALSE(may_choose_size(paper_options()));
}

}  // namespace
}  // namespace delmesher::policies
