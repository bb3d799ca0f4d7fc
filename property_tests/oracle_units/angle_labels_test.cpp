// Labels by angle, as the oracles read them.
#include "oracles/surface/angle_labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesher/delmesher/labelled_faces.h"

namespace tetproof::oracles {
namespace {

// A prism of n sides and height 1, whose sides bend by 360 / n degrees, with its ends.
Polyhedron prism(Index n) {
  Polyhedron p;
  for (const double z : {0.0, 1.0}) {
    for (Index i = 0; i < n; ++i) {
      const double a = 2 * 3.14159265358979323846 * i / n;
      p.vertices.push_back({std::cos(a), std::sin(a), z});
    }
  }
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    p.triangles.push_back({i, j, n + j});
    p.triangles.push_back({i, n + j, n + i});
  }
  for (Index i = 1; i + 1 < n; ++i) {
    p.triangles.push_back({0, i + 1, i});
    p.triangles.push_back({n, n + i, n + i + 1});
  }
  return p;
}

TEST(AngleLabels, OfAPrism) {
  Polyhedron p = prism(10);
  ASSERT_EQ(label_by_angle(p, 36.1), "");
  std::vector<std::int32_t> wanted(20, 1);
  for (int i = 0; i < 8; ++i) wanted.insert(wanted.end(), {2, 3});
  EXPECT_EQ(p.labels, wanted);
  EXPECT_EQ(p.names, (SetNames{{{2, 1}, "face_1"}, {{2, 2}, "face_2"}, {{2, 3}, "face_3"}}));
  EXPECT_NE(label_by_angle(p, 36.1), "");  // now it has labels
  p = prism(10);
  ASSERT_EQ(label_by_angle(p, 35.9), "");
  EXPECT_EQ(p.labels[19], 10);
}

// Sides that bend by the angle itself, up to roundings: with a rational cosine it is decided, else
// not, and said so.
TEST(AngleLabels, WhatDoublesCannotTellIsSaid) {
  Polyhedron square = prism(4);
  EXPECT_EQ(label_by_angle(square, 90), "");
  Polyhedron dozen = prism(12);
  EXPECT_EQ(label_by_angle(dozen, 30), "");
  Polyhedron ten = prism(10);
  EXPECT_NE(label_by_angle(ten, 36).find("as far as doubles can tell"), std::string::npos);
}

// The mesher reads the same labels: of shaken prisms, at many angles.
TEST(AngleLabels, AreThoseOfTheMesher) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shake(0.9, 1.1), angle(1, 89);
  for (int run = 0; run < 60; ++run) {
    Polyhedron p = prism(12);
    for (Position& v : p.vertices) {
      for (double& x : v) x *= shake(random);
    }
    const double degrees = run < 4 ? std::array{30.0, 45.0, 60.0, 90.0}[run % 4] : angle(random);
    delmesher::Surface surface{p.vertices, p.triangles, {}};
    ASSERT_EQ(label_by_angle(p, degrees), "");
    ASSERT_TRUE(delmesher::label_by_angle(surface, degrees).ok());
    EXPECT_EQ(p.labels, surface.labels) << degrees;
  }
}

}  // namespace
}  // namespace tetproof::oracles
