#include "mesher/refine/facet_boundary.h"

#include <gtest/gtest.h>

#include "mesher/base/test_complaints.h"

namespace delmesher::refine {
namespace {

// A square of side 3 in the plane z = 0 with a square hole of side 1 in its middle: corners 0 to 3
// and 4 to 7, counter-clockwise; 8 is off the plane.
struct Frame {
  PointStore points;
  Predicates predicates{points};
  PlanarTriangulation planar;

  Frame() {
    for (const auto& [low, high] : {std::array{0.0, 3.0}, std::array{1.0, 2.0}}) {
      points.add_explicit(low, low, 0);
      points.add_explicit(high, low, 0);
      points.add_explicit(high, high, 0);
      points.add_explicit(low, high, 0);
    }
    const VertexId apex = points.add_explicit(0, 0, 1);
    const VertexId vertices[] = {0, 1, 2, 3, 4, 5, 6, 7};
    planar = triangulate_planar(predicates, {2, 1, apex}, vertices);
  }

  // Twice the area of the triangles inside.
  double area(const FacetBoundary& boundary) const {
    const std::vector<std::uint8_t> inside = boundary.inside(planar);
    double sum = 0;
    for (std::size_t t = 0; t < inside.size(); ++t) {
      if (inside[t] == 0) continue;
      const Vec3 a = points.nearest(planar.triangles[t][0]);
      const Vec3 b = points.nearest(planar.triangles[t][1]);
      const Vec3 c = points.nearest(planar.triangles[t][2]);
      sum += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    }
    return sum;
  }
};

const std::vector<DirectedSide> kOuter = {{0, 1, 10}, {1, 2, 11}, {2, 3, 12}, {3, 0, 13}};
const std::vector<DirectedSide> kHole = {{5, 4, 14}, {6, 5, 15}, {7, 6, 16}, {4, 7, 17}};
const std::vector<DirectedSide> kIsland = {{4, 5, 14}, {5, 6, 15}, {6, 7, 16}, {7, 4, 17}};

std::vector<DirectedSide> both(std::vector<DirectedSide> a, const std::vector<DirectedSide>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(FacetBoundary, SidesAreFoundInBothDirections) {
  const FacetBoundary boundary(both(kOuter, kHole));
  EXPECT_FALSE(boundary.empty());
  EXPECT_TRUE(FacetBoundary({}).empty());
  bool inward = false;
  for (const DirectedSide& side : both(kOuter, kHole)) {
    EXPECT_EQ(boundary.find(side.from, side.to, &inward), side.subsegment);
    EXPECT_TRUE(inward);
    EXPECT_EQ(boundary.find(side.to, side.from, &inward), side.subsegment);
    EXPECT_FALSE(inward);
  }
  EXPECT_EQ(boundary.find(0, 4, &inward), kNone);
  EXPECT_EQ(boundary.find(0, 2, &inward), kNone);
}

TEST(FacetBoundary, InsideIsWhatIsLeftOfTheSides) {
  const Frame frame;
  EXPECT_EQ(frame.area(FacetBoundary(kOuter)), 18);
  EXPECT_EQ(frame.area(FacetBoundary(both(kOuter, kHole))), 16);
  EXPECT_EQ(frame.area(FacetBoundary(kIsland)), 2);
}

TEST(FacetBoundary, WhatDoesNotSeparateIsRefused) {
  const Frame frame;
  const auto said_of = [&](const std::vector<DirectedSide>& sides) {
    return complaint([&] { static_cast<void>(FacetBoundary(sides).inside(frame.planar)); });
  };
  EXPECT_EQ(said_of(both(kOuter, kHole)), "nothing");
  // Sides that cross the triangulation.
  EXPECT_NE(said_of({{0, 6, 10}, {6, 3, 11}, {3, 0, 13}}).find("is not an edge"),
            std::string::npos);
  // One that leads backwards.
  std::vector<DirectedSide> turned = both(kOuter, kHole);
  std::swap(turned[4].from, turned[4].to);
  EXPECT_NE(said_of(turned).find("disagree about what is inside"), std::string::npos);
}

}  // namespace
}  // namespace delmesher::refine
