// Exact squared distances, on integers whose distances are known.
#include "oracles/distances.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tetproof::oracles
