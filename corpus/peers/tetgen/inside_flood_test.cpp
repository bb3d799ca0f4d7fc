#include "corpus/peers/tetgen/inside_flood.h"

#include <gtest/gtest.h>

namespace tetproof {
namespace {

using Tets = std::vector<std::array<std::uint32_t, 4>>;
using Walls = std::vector<std::array<std::uint32_t, 3>>;
using Flags = std::vector<std::uint8_t>;

// A row of tetrahedra, each sharing a face with the next: i, i+1, i+2, i+3.
Tets row(std::uint32_t count) {
  Tets tets;
  for (std::uint32_t i = 0; i < count; ++i) tets.push_back({i, i + 1, i + 2, i + 3});
  return tets;
}

// The faces of tetrahedron i of a row.
Walls around(std::uint32_t i) {
  return {{i, i + 1, i + 2}, {i + 3, i + 1, i}, {i, i + 2, i + 3}, {i + 2, i + 3, i + 1}};
}

TEST(InsideFlood, WallsInTheMiddleAndOnTheBoundary) {
  for (std::uint32_t i = 0; i < 4; ++i) {
    Flags expected(4, 0);
    expected[i] = 1;
    EXPECT_EQ(flood_inside(row(4), around(i)), expected) << i;
  }
}

TEST(InsideFlood, NoWallsNothingInside) {
  EXPECT_EQ(flood_inside(row(3), {}), Flags(3, 0));
}

TEST(InsideFlood, LeakyWallsAreNoticed) {
  Walls walls = around(1);
  walls.pop_back();
  EXPECT_TRUE(flood_inside(row(3), walls).empty());
}

}  // namespace
}  // namespace tetproof
