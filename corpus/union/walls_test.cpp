// The laws of walls.h. What bodies divide off is counted in cells, by hand.
#include "corpus/union/walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>

#include "corpus/generators/random.h"
#include "corpus/generators/shapes.h"
#include "corpus/generators/test_surfaces.h"
#include "mesher/delmesher.h"

namespace tetproof::unite {
namespace {

using delmesher::Surface;
using shapes::box;
using test_surfaces::together;
using Point = std::array<double, 3>;

struct Block {
  std::array<int, 3> low, high;
};

// The first body has label 1, and so on.
Surface labelled(const std::vector<Surface>& bodies) {
  Surface surface = together(bodies);
  for (std::size_t n = 0; n < bodies.size(); ++n) {
    surface.labels.insert(surface.labels.end(), bodies[n].triangles.size(),
                          static_cast<std::int32_t>(n + 1));
  }
  return surface;
}

Surface surface_of_blocks(const std::vector<Block>& blocks) {
  std::vector<Surface> bodies;
  for (const Block& b : blocks) {
    bodies.push_back(box({double(b.low[0]), double(b.low[1]), double(b.low[2])},
                         {double(b.high[0]), double(b.high[1]), double(b.high[2])}));
  }
  return labelled(bodies);
}

// Which blocks contain the unit cell at these coordinates: a bit for each.
unsigned around(const std::vector<Block>& blocks, const std::array<int, 3>& cell) {
  unsigned set = 0;
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    bool in = true;
    for (std::size_t k = 0; k < 3; ++k) {
      in = in && blocks[n].low[k] <= cell[k] && cell[k] < blocks[n].high[k];
    }
    set |= in ? 1U << n : 0U;
  }
  return set;
}

// Of the parts of space that the blocks' sides divide off: cells that no side is between are in the
// same blocks.
std::vector<double> volumes_by_cells(const std::vector<Block>& blocks, int size) {
  std::map<std::array<int, 3>, bool> seen;
  std::vector<double> volumes;
  const auto flood = [&](const std::array<int, 3>& start) {
    const unsigned set = around(blocks, start);
    double volume = 0;
    bool bounded = true;
    std::vector<std::array<int, 3>> open = {start};
    seen[start] = true;
    while (!open.empty()) {
      const std::array<int, 3> cell = open.back();
      open.pop_back();
      ++volume;
      for (std::size_t k = 0; k < 6; ++k) {
        std::array<int, 3> next = cell;
        next[k / 2] += k % 2 != 0 ? 1 : -1;
        const bool out = next[k / 2] < -1 || next[k / 2] > size;
        bounded = bounded && !out;
        if (out || around(blocks, next) != set || seen[next]) continue;
        seen[next] = true;
        open.push_back(next);
      }
    }
    if (bounded) volumes.push_back(volume);
  };
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      for (int z = 0; z < size; ++z) {
        if (!seen[{x, y, z}]) flood({x, y, z});
      }
    }
  }
  std::ranges::sort(volumes, std::greater());
  return volumes;
}

std::vector<double> volumes_of_regions(const Surface& surface) {
  delmesher::Options options;
  options.regions = delmesher::Regions::all;
  const delmesher::Result result = delmesher::tetrahedralize(surface, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  std::vector<double> volumes;
  for (const delmesher::MeshRegion& region : result.regions) volumes.push_back(region.volume);
  return volumes;
}

double area(const Surface& surface, std::int32_t label) {
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.labels[t] != label) continue;
    std::array<Point, 3> x;
    for (std::size_t k = 0; k < 3; ++k) x[k] = surface.vertices[surface.triangles[t][k]];
    double squares = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
      const double n =
          (x[1][u] - x[0][u]) * (x[2][v] - x[0][v]) - (x[1][v] - x[0][v]) * (x[2][u] - x[0][u]);
      squares += n * n;
    }
    sum += std::sqrt(squares) / 2;
  }
  return sum;
}

enum class Placing : std::uint8_t { given, turned, single, digits };

double with_six_digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return std::strtod(text, nullptr);
}

// As it is, turned, and then with coordinates of single precision and of six digits.
void place(Surface& surface, Placing placing) {
  if (placing == Placing::given) return;
  shapes::move(surface, [&](const Point& p) {
    if (placing == Placing::single) return Point{float(p[0]), float(p[1]), float(p[2])};
    if (placing == Placing::digits) {
      return Point{with_six_digits(p[0]), with_six_digits(p[1]), with_six_digits(p[2])};
    }
    return Point{0.36 * p[0] + 0.48 * p[1] - 0.8 * p[2], -0.8 * p[0] + 0.6 * p[1],
                 0.48 * p[0] + 0.64 * p[1] + 0.6 * p[2]};
  });
}

TEST(Walls, DivideOffWhatBodiesDo) {
  constexpr int kSize = 6;
  Random random(20261129);
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    std::vector<Block> blocks;
    for (int n = 0; n < 2 + i % 4; ++n) {
      Block block;
      for (std::size_t k = 0; k < 3; ++k) {
        block.low[k] = static_cast<int>(random.between(0, kSize - 1));
        block.high[k] =
            block.low[k] + 1 + static_cast<int>(random.between(0, kSize - block.low[k]));
        block.high[k] = std::min(block.high[k], kSize);
      }
      blocks.push_back(block);
    }
    Surface surface = surface_of_blocks(blocks);
    const std::vector<double> expected = volumes_by_cells(blocks, kSize);
    // Sides that were in one plane are roundings apart once they are turned.
    for (const Placing placing :
         {Placing::given, Placing::turned, Placing::single, Placing::digits}) {
      SCOPED_TRACE(static_cast<int>(placing));
      place(surface, placing);
      const bool coarse = placing == Placing::digits;
      const double near = coarse ? 1e-2 : placing == Placing::single ? 1e-3 : 1e-9;
      const UnionResult result = cut_into_walls(surface, coarse ? 2e-5 : 0, {});
      ASSERT_EQ(result.code, UnionCode::done) << result.message;
      const std::vector<double> volumes = volumes_of_regions(result.surface);
      ASSERT_EQ(volumes.size(), expected.size());
      for (std::size_t n = 0; n < volumes.size(); ++n) {
        EXPECT_NEAR(volumes[n], expected[n], near);
      }
      for (std::size_t n = 0; n < blocks.size(); ++n) {
        std::array<double, 3> d;
        for (std::size_t k = 0; k < 3; ++k) d[k] = blocks[n].high[k] - blocks[n].low[k];
        EXPECT_NEAR(area(result.surface, static_cast<std::int32_t>(n + 1)),
                    2 * (d[0] * d[1] + d[1] * d[2] + d[2] * d[0]), near);
      }
    }
  }
}

TEST(Walls, AreCutByOpenSheets) {
  // A sheet through a box, and one that ends in it.
  Surface sheets;
  sheets.vertices = {{-1, -1, 1}, {9, -1, 1}, {-1, 9, 1}, {2, 2, 2}, {5, 2, 2}, {2, 2.5, 2}};
  sheets.triangles = {{0, 1, 2}, {3, 4, 5}};
  sheets.labels = {0, 0};
  const Surface body = box({0, 0, 0}, {3, 3, 3});
  const UnionResult result = cut_into_walls(labelled({body, sheets}), 0, {});
  ASSERT_EQ(result.code, UnionCode::done) << result.message;
  const std::vector<double> volumes = volumes_of_regions(result.surface);
  ASSERT_EQ(volumes.size(), 2U);
  EXPECT_NEAR(volumes[0], 18, 1e-9);
  EXPECT_NEAR(volumes[1], 9, 1e-9);
  EXPECT_NEAR(area(result.surface, 1), 54, 1e-9);
  EXPECT_NEAR(area(result.surface, 2), 50.75, 1e-9);
  // Once more it is what it is.
  const UnionResult again = cut_into_walls(result.surface, 0, {});
  EXPECT_EQ(again.surface.vertices, result.surface.vertices);
  EXPECT_EQ(again.surface.triangles, result.surface.triangles);
  EXPECT_EQ(again.surface.labels, result.surface.labels);
  EXPECT_EQ(again.counts.cut + again.counts.pairs, 0U);
}

// Bodies that touch, overlap and contain each other, roundings apart.
Surface turned_blocks(Placing placing) {
  Surface surface = surface_of_blocks({{{0, 0, 0}, {2, 2, 2}},
                                       {{2, 1, 0}, {4, 3, 2}},
                                       {{1, 1, 1}, {3, 3, 3}},
                                       {{0, 0, 2}, {1, 1, 3}}});
  place(surface, Placing::turned);
  place(surface, placing);
  return surface;
}

TEST(Walls, ScaleWithTheirInput) {
  for (const Placing placing : {Placing::given, Placing::single}) {
    const Surface surface = turned_blocks(placing);
    const double length = placing == Placing::given ? 0x1p-20 : 0;
    const UnionResult expected = cut_into_walls(surface, length, {});
    ASSERT_EQ(expected.code, UnionCode::done) << expected.message;
    ASSERT_GT(expected.counts.largest_move, 0);
    for (const int exponent : {-900, -700, -500, -250, -100, -64, -3, 40, 130, 300, 600, 900}) {
      SCOPED_TRACE(exponent);
      const auto scaled = [&](Surface s) {
        shapes::move(s, [&](const Point& p) {
          return Point{std::ldexp(p[0], exponent), std::ldexp(p[1], exponent),
                       std::ldexp(p[2], exponent)};
        });
        return s;
      };
      const UnionResult result = cut_into_walls(scaled(surface), std::ldexp(length, exponent), {});
      ASSERT_EQ(result.code, UnionCode::done) << result.message;
      EXPECT_EQ(result.surface.vertices, scaled(expected.surface).vertices);
      EXPECT_EQ(result.surface.triangles, expected.surface.triangles);
      EXPECT_EQ(result.surface.labels, expected.surface.labels);
      EXPECT_EQ(result.counts.largest_move, std::ldexp(expected.counts.largest_move, exponent));
      // So does the union.
      EXPECT_EQ(unite(scaled(surface)).surface.vertices, scaled(unite(surface).surface).vertices);
    }
  }
}

TEST(Walls, NeedCoordinatesThatDoublesHave) {
  Surface surface = turned_blocks(Placing::single);
  shapes::move(surface, [](const Point& p) {
    return Point{std::ldexp(p[0], -1052), std::ldexp(p[1], -1052), std::ldexp(p[2], -1052)};
  });
  EXPECT_EQ(cut_into_walls(surface, 0, {}).code, UnionCode::out_of_range);
  // One that vanishes beside the others.
  surface = turned_blocks(Placing::single);
  shapes::move(surface, [](const Point& p) {
    return Point{std::ldexp(p[0], 900), std::ldexp(p[1], 900), p[2]};
  });
  surface.vertices[0][2] = 0x1p-300;
  const UnionResult result = cut_into_walls(surface, 0, {});
  EXPECT_EQ(result.code, UnionCode::out_of_range);
  EXPECT_EQ(result.message.find("; "), std::string::npos) << "no length does it";
}

}  // namespace
}  // namespace tetproof::unite
