#include "corpus/generators/vary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "corpus/generators/certify.h"
#include "corpus/generators/shapes.h"
#include "corpus/generators/test_surfaces.h"

namespace tetproof {
namespace {

using delmesher::Surface;
using shapes::Point;
using test_surfaces::a_box;
using test_surfaces::volume;
using Corners = std::array<Point, 3>;

// A triangle by its corners' coordinates, the least one first, mapped by `map`: what a numbering
// does not change.
template <class Map>
std::vector<Corners> triangles_of(const Surface& s, const Map& map) {
  std::vector<Corners> all;
  for (const auto& [a, b, c] : s.triangles) {
    Corners t = {map(s.vertices[a]), map(s.vertices[b]), map(s.vertices[c])};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    all.push_back(t);
  }
  std::sort(all.begin(), all.end());
  return all;
}
std::vector<Corners> triangles_of(const Surface& s) {
  return triangles_of(s, [](const Point& p) { return p; });
}

// 24 is the box's volume, and all of this is exact.
TEST(Vary, TurnsAreMotions) {
  const Surface given = a_box();
  const Surface quarter = quarter_turned(given), third = third_turned(given);
  EXPECT_EQ(triangles_of(quarter), triangles_of(given, [](const Point& p) {
              return Point{0 - p[1], p[0], p[2]};
            }));
  EXPECT_EQ(triangles_of(third_turned(third_turned(third))), triangles_of(given));
  EXPECT_NE(triangles_of(third), triangles_of(given));
  EXPECT_EQ(volume(quarter), 24);  // a reflection would turn its sign
  EXPECT_EQ(volume(third), 24);
}

TEST(Vary, ScalesKeepEveryBit) {
  Surface given = a_box();
  given.vertices[0][0] = std::nextafter(-1, 0);
  const auto large = scaled(given, 10), small = scaled(given, -10);
  ASSERT_TRUE(large && small);
  EXPECT_EQ(large->vertices[0][0], 1024 * given.vertices[0][0]);
  EXPECT_EQ(scaled(*small, 10)->vertices, given.vertices);
  EXPECT_FALSE(scaled(given, 1023));   // beyond the largest double
  EXPECT_FALSE(scaled(given, -1050));  // its last bits would be lost
}

TEST(Vary, ANumberingChangesNothingElse) {
  Surface given = a_box();
  std::map<Corners, std::int32_t> label;
  for (std::size_t t = 0; t < given.triangles.size(); ++t) {
    given.labels.push_back(static_cast<std::int32_t>(t));
  }
  const auto labels_of = [](const Surface& s) {
    std::map<Corners, std::int32_t> labels;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
      labels[triangles_of({s.vertices, {s.triangles[t]}, {}})[0]] = s.labels[t];
    }
    return labels;
  };
  Random random(1);
  const Surface copy = renumbered(given, random);
  EXPECT_EQ(triangles_of(copy), triangles_of(given));
  EXPECT_EQ(labels_of(copy), labels_of(given));
  EXPECT_NE(copy.vertices, given.vertices);
  EXPECT_NE(copy.triangles, given.triangles);
}

TEST(Vary, AnEdgeIsSplitWhereDoublesHaveItsMidpoint) {
  const Surface given = a_box();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const auto copy = split_exactly(given, random);
    ASSERT_TRUE(copy);
    EXPECT_EQ(copy->vertices.size(), 9U);
    EXPECT_EQ(copy->triangles.size(), 14U);
    EXPECT_TRUE(certified_valid(*copy));
    EXPECT_EQ(volume(*copy), 24);
  }
}

// Only one of its edges has a midpoint in doubles: the sums of the others have more bits.
TEST(Vary, OtherEdgesAreLeftAlone) {
  const double full = 1 + 0x1p-52;
  const Surface given = shapes::tetrahedron({full, 0, 0}, {0x1p-10 * full, 2, 0},
                                            {0x1p-20 * full, 1, 0}, {-full, 0, 4});
  ASSERT_TRUE(certified_valid(given));
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const auto copy = split_exactly(given, random);
    ASSERT_TRUE(copy);
    EXPECT_EQ(copy->vertices.back(), (Point{0, 0, 2}));
  }
  Surface none = given;
  none.vertices[3][0] = -0.125 * full;
  Random random(1);
  EXPECT_FALSE(split_exactly(none, random));
}

TEST(Vary, AllCopiesAreValidAndOthers) {
  const Surface given = a_box();
  std::vector<std::string> suffixes;
  for (const ExactCopy& copy : exact_copies(given)) {
    suffixes.push_back(copy.suffix);
    ASSERT_TRUE(copy.surface) << copy.suffix;
    EXPECT_TRUE(certified_valid(*copy.surface)) << copy.suffix;
    EXPECT_TRUE(copy.surface->vertices != given.vertices ||
                copy.surface->triangles != given.triangles)
        << copy.suffix;
  }
  EXPECT_EQ(suffixes, (std::vector<std::string>{"t1", "t2", "s1", "s2", "n1", "e1"}));
  EXPECT_EQ(exact_copies(given)[4].surface->triangles, exact_copies(given)[4].surface->triangles);
}

}  // namespace
}  // namespace tetproof
