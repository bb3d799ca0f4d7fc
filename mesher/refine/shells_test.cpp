// Where subsegments are split, on segments whose lengths give the shells.
#include "mesher/refine/shells.h"

#include <gtest/gtest.h>

namespace delmesher::refine {
namespace {

// A subsegment of length 1 between two vertices with a segment of the given length at each; 0: the
// vertex is not an apex.
double split_fraction(double at_a, double at_b) {
  PointStore points;
  Plc plc;
  const VertexId a = points.add_explicit(0, 0, 0), b = points.add_explicit(0, 0, 1);
  for (const auto& [end, length] : {std::pair{a, at_a}, std::pair{b, at_b}}) {
    const Vec3 p = points.nearest(end);
    for (const double farther : {0.0, 0.03125}) {
      plc.segments.push_back({{points.add_explicit(p[0] + length + farther, p[1], p[2]), end}});
    }
  }
  const std::vector<std::uint8_t> apex = {at_a > 0, at_b > 0};
  return Shells(plc, points, apex).split_fraction(a, b, 1);
}

// Shells halve or double until they cross the subsegment in its middle third; of two, that nearer
// to the middle is taken.
TEST(Shells, OfTwoThatNearerToTheMiddleIsTaken) {
  EXPECT_EQ(split_fraction(0, 0), 0.5);
  EXPECT_EQ(split_fraction(0.375, 0), 0.375);
  EXPECT_EQ(split_fraction(0, 0.375), 1 - 0.375);
  EXPECT_EQ(split_fraction(0.4375, 0.625), 0.4375);
  EXPECT_EQ(split_fraction(0.625, 0.4375), 1 - 0.4375);
  EXPECT_EQ(split_fraction(0.5625, 0.375), 0.5625);
  EXPECT_EQ(split_fraction(0.375, 0.5625), 1 - 0.5625);
  EXPECT_EQ(split_fraction(4 * 0.4375, 0), 0.4375);
  EXPECT_EQ(split_fraction(0, 0.625 / 8), 1 - 0.625);
}

TEST(Shells, OnlyInputVerticesHaveThem) {
  PointStore points;
  Plc plc;
  plc.segments.push_back({{points.add_explicit(0, 0, 0), points.add_explicit(3, 0, 0)}});
  const std::vector<std::uint8_t> apex = {1};
  const Shells shells(plc, points, apex);
  EXPECT_EQ(shells.split_fraction(0, 1, 8), 0.375);
  EXPECT_EQ(shells.split_fraction(1, 2, 8), 0.5);
}

}  // namespace
}  // namespace delmesher::refine
