#include "mesher/geometry/size_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "mesher/geometry/vector.h"

namespace delmesher::geometry {
namespace {

// On a coarse grid, so that sources coincide and edges run through them.
class SizeFields : public testing::TestWithParam<std::size_t> {
 protected:
  Vec3 random_point() {
    Vec3 p;
    for (double& x : p) x = static_cast<double>(random_() % 33) / 4;
    return p;
  }
  std::vector<SizeSource> random_sources() {
    std::vector<SizeSource> sources(GetParam());
    for (SizeSource& s : sources) {
      s = {random_point(), static_cast<double>(1 + random_() % 40) / 16};
    }
    return sources;
  }

  std::mt19937_64 random_{GetParam()};
};

TEST_P(SizeFields, AreTheSmallestOfAllSources) {
  const std::vector<SizeSource> sources = random_sources();
  const SizeField field(sources, 0.25);
  EXPECT_EQ(field.empty(), sources.empty());
  for (int n = 0; n < 200; ++n) {
    const Vec3 x = random_point();
    double expected = HUGE_VAL;
    for (const SizeSource& s : sources) {
      expected = std::min(expected, s.size + 0.25 * distance(x, s.point));
    }
    EXPECT_EQ(field.at(x), expected);
  }
}

// Tries the points of an edge at thousandths of its length, so that it is known up to that fraction
// whether it is too long.
TEST_P(SizeFields, AnEdgeIsTooLongWhereItIsAtOneOfItsPoints) {
  constexpr double kGrowth = 0.5;
  const SizeField field(random_sources(), kGrowth);
  int too_long = 0, short_enough = 0;
  for (int n = 0; n < 100; ++n) {
    const Vec3 a = random_point();
    const Vec3 b = add_scaled(a, n % 2 == 0 ? 1 : 1.0 / 64, subtract(random_point(), a));
    const double length = distance(a, b);
    double smallest = HUGE_VAL;
    for (int i = 0; i <= 1000; ++i) {
      smallest = std::min(smallest, field.at(add_scaled(a, i / 1000.0, subtract(b, a))));
    }
    const double step = kGrowth * length / 1000;
    if (length > smallest + 1e-9) {
      EXPECT_TRUE(field.is_too_long(a, b));
      ++too_long;
    } else if (length < smallest - step - 1e-9) {
      EXPECT_FALSE(field.is_too_long(a, b));
      ++short_enough;
    }
    EXPECT_EQ(field.is_too_long(a, b), field.is_too_long(b, a));
  }
  EXPECT_EQ(too_long > 0, GetParam() > 0);
  EXPECT_GT(short_enough, 0);
}

TEST_P(SizeFields, DoNotDependOnTheOrderOfSources) {
  std::vector<SizeSource> sources = random_sources();
  const SizeField field(sources, 0.3);
  std::shuffle(sources.begin(), sources.end(), random_);
  const SizeField shuffled(sources, 0.3);
  for (int n = 0; n < 200; ++n) {
    const Vec3 a = random_point(), b = random_point();
    EXPECT_EQ(field.at(a), shuffled.at(a));
    EXPECT_EQ(field.is_too_long(a, b), shuffled.is_too_long(a, b));
  }
}

INSTANTIATE_TEST_SUITE_P(Sources, SizeFields, testing::Values(0, 1, 8, 9, 100, 1000));

// Its ends are far from the source, and so is all but its middle.
TEST(SizeField, LooksAtTheWholeEdge) {
  const SizeField field(std::vector<SizeSource>{{{0, 0, 0}, 1}}, 0.3);
  EXPECT_TRUE(field.is_too_long({-5, 0, 0}, {5, 0, 0}));
  EXPECT_FALSE(field.is_too_long({5, 0, 0}, {7.5, 0, 0}));  // 1 + 0.3 * 5
  EXPECT_TRUE(field.is_too_long({5, 0, 0}, {7.51, 0, 0}));
  EXPECT_FALSE(field.is_too_long({0, 0, 0}, {1, 0, 0}));
  EXPECT_TRUE(field.is_too_long({0, 0, 0}, {1.01, 0, 0}));
}

TEST(SizeField, AllowsAnythingFarFromItsSources) {
  const SizeField field(std::vector<SizeSource>{{{1e300, 0, 0}, 1e-300}}, 1e-3);
  EXPECT_FALSE(field.is_too_long({0, 0, 0}, {1, 0, 0}));
  EXPECT_GT(field.at({0, 0, 0}), 1e290);
}

}  // namespace
}  // namespace delmesher::geometry
