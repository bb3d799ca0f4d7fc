// Exact squared distances, on integers whose distances are known.
#include "oracles/base/distances.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace tetproof::oracles {
namespace {

// In units of length: the points' own are smaller by a power of two.
double length_of(const mpq_class& squared, const ExactPoints& points) {
  return square_root(squared, points.exponent());
}

ExactPoints points_at(const std::vector<Position>& places) {
  ExactPoints points;
  EXPECT_EQ(points.assign(places), "");
  return points;
}

// Products and lengths here are 2^-2222 and 2^-1148, or 2^3000 and 2^2000.
TEST(Distances, AlongVectorsDoNotUnderOrOverflowOnTheWay) {
  const ExactVector small{ExactNumber(0), ExactNumber(3), ExactNumber(4)};
  EXPECT_EQ(component(ExactNumber(5), small, -1074), 0x1p-1074);
  EXPECT_EQ(component(ExactNumber(-10), small, -1000), -0x1p-999);
  EXPECT_EQ(component(ExactNumber(-1), small, -1074), -0x1p-1074);  // a fifth of that
  EXPECT_EQ(component(ExactNumber(0), small, -1074), 0);
  EXPECT_EQ(length_over(small, small, -1074), 0x1p-1074);
  ExactVector large = small;
  for (ExactNumber& x : large) x = x.shifted(2000);
  EXPECT_EQ(component(ExactNumber(5).shifted(3000), large, 0), 0x1p1000);
  EXPECT_EQ(length_over(large, small, -1000), 0x1p1000);
  EXPECT_EQ(length_over({ExactNumber(0), ExactNumber(0), ExactNumber(0)}, small, 0), 0);
}

TEST(Distances, ToASegmentAreThoseToItsEndsBeyondThem) {
  const ExactPoints points =
      points_at({{0, 0, 0}, {4, 0, 0}, {-3, 4, 0}, {7, 0, 4}, {2, 3, 4}, {4, 0, 1}});
  for (const Index v : {2U, 3U, 4U}) {
    EXPECT_EQ(length_of(squared_distance_to_segment(points, v, 0, 1), points), 5);
    EXPECT_EQ(length_of(squared_distance_to_segment(points, v, 1, 0), points), 5);
  }
  EXPECT_EQ(length_of(squared_distance_to_segment(points, 5, 0, 1), points), 1);
}

TEST(Distances, OfSegmentsCountWhereTheyArePassedInside) {
  const ExactPoints points = points_at({{-1, 0, 0},
                                        {1, 0, 0},
                                        {0, -1, 2},
                                        {0, 1, 2},
                                        {0, 0, 2},
                                        {1, -1, 2},
                                        {1, 1, 2},
                                        {-1, 0, 1},
                                        {1, 0, 1}});
  EXPECT_EQ(length_of(squared_distance_inside(points, 0, 1, 2, 3), points), 2);
  EXPECT_LT(squared_distance_inside(points, 0, 1, 4, 3), 0);  // from an end of the second
  EXPECT_LT(squared_distance_inside(points, 0, 1, 5, 6), 0);  // to an end of the first
  EXPECT_LT(squared_distance_inside(points, 5, 6, 0, 1), 0);
  EXPECT_LT(squared_distance_inside(points, 0, 1, 7, 8), 0);  // parallel
}

TEST(Distances, ToAFaceCountWhereTheFootIsOnIt) {
  const ExactPoints points = points_at(
      {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -3}, {2, 2, 5}, {3, 3, 1}, {-1, 1, 0}, {2, 0, 0}});
  for (const std::array<Index, 3>& face : {std::array<Index, 3>{0, 1, 2}, {2, 1, 0}}) {
    EXPECT_EQ(length_of(squared_distance_to_face(points, 3, face), points), 3);
    EXPECT_EQ(length_of(squared_distance_to_face(points, 4, face), points), 5);  // over an edge
    EXPECT_LT(squared_distance_to_face(points, 5, face), 0);
    EXPECT_LT(squared_distance_to_face(points, 6, face), 0);
    EXPECT_EQ(length_of(squared_distance_to_triangle(points, 6, face), points), 1);
  }
  // A triangle of no area has no feet, but it has edges.
  EXPECT_LT(squared_distance_to_face(points, 3, {0, 1, 7}), 0);
  EXPECT_EQ(length_of(squared_distance_to_triangle(points, 6, {0, 1, 7}), points),
            length_of(squared_distance_to_segment(points, 6, 0, 1), points));
}

// On a lattice, where many points are on faces, their edges and their corners, and of points that
// are given on a side, beyond its ends as well.
TEST(Distances, AreZeroOnTheFaceAlone) {
  std::vector<delmesher::ExactPoint> definitions;
  for (int n = 0; n < 64; ++n) {
    definitions.push_back({delmesher::ExactPoint::Kind::explicit_point, 0, 0, 0,
                           static_cast<double>(n % 4), static_cast<double>(n / 4 % 4),
                           static_cast<double>(n / 16)});
  }
  for (const double share : {-0.25, 0.3, 1.25}) {
    definitions.push_back({delmesher::ExactPoint::Kind::on_segment, 5, 43, 0, share, 0, 0});
  }
  ExactPoints points;
  ASSERT_EQ(points.assign(definitions), "");
  std::array<int, 2> counts{};
  for (const std::array<Index, 3>& face : std::vector<std::array<Index, 3>>{
           {5, 43, 48}, {43, 5, 3}, {0, 3, 15}, {0, 63, 12}, {0, 21, 42}, {1, 54, 27}}) {
    for (Index v = 0; v < points.size(); ++v) {
      const bool on = squared_distance_to_face(points, v, face) == 0;
      EXPECT_EQ(lies_on_face(points, v, face), on) << v;
      ++counts[on ? 1 : 0];
    }
  }
  EXPECT_GT(counts[0], 300);
  EXPECT_GT(counts[1], 20);
}

}  // namespace
}  // namespace tetproof::oracles
