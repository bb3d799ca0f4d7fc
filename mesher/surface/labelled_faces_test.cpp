#include "mesher/delmesher/labelled_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "mesher/surface/test_surfaces.h"

namespace delmesher::surface {
namespace {

using test_surfaces::box;

// A can of radius 2 with n sides: two triangles for each, then the fans of both ends.
Surface can(std::uint32_t n, double turned_by = 0) {
  Surface s;
  for (const double z : {0.0, 3.0}) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const double a = 2 * 3.14159265358979323846 * i / n;
      // Turned round the x axis.
      const double y = 2 * std::sin(a), c = std::cos(turned_by), d = std::sin(turned_by);
      s.vertices.push_back({2 * std::cos(a), c * y - d * z, d * y + c * z});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    s.triangles.push_back({i, j, n + j});
    s.triangles.push_back({i, n + j, n + i});
  }
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    s.triangles.push_back({0, i + 1, i});
    s.triangles.push_back({n, n + i, n + i + 1});
  }
  return s;
}

std::vector<std::int32_t> labels(Surface s, double degrees) {
  const Status status = label_by_angle(s, degrees);
  EXPECT_TRUE(status.ok()) << status.message;
  return s.labels;
}

std::int32_t count(const std::vector<std::int32_t>& all) {
  return *std::max_element(all.begin(), all.end());
}

TEST(LabelByAngle, FacesOfABoxInTheOrderOfTheirTriangles) {
  std::vector<std::int32_t> wanted;
  for (int face = 1; face <= 6; ++face) wanted.insert(wanted.end(), 18, face);
  EXPECT_EQ(labels(box({0, 0, 0}, {1, 2, 3}, 3), 30), wanted);
  // Edges of a box bend by a right angle, which is not less than one.
  EXPECT_EQ(labels(box({0, 0, 0}, {1, 2, 3}, 3), 90), wanted);
}

// Sides of a can of n sides bend by 360 / n degrees.
TEST(LabelByAngle, CurvedSidesAreOneFace) {
  EXPECT_EQ(count(labels(can(12), 30.001)), 3);
  EXPECT_EQ(count(labels(can(12), 29.999)), 14);
  const std::vector<std::int32_t> of_36 = labels(can(36, 0.3), 11);
  EXPECT_EQ(count(of_36), 3);
  EXPECT_EQ(of_36, [] {
    std::vector<std::int32_t> wanted(72, 1);
    for (int i = 0; i < 34; ++i) wanted.insert(wanted.end(), {2, 3});
    return wanted;
  }());
}

// A wedge that bends by exactly 45 degrees at two edges: not less, whatever the rounding.
TEST(LabelByAngle, TheAngleItselfIsSharp) {
  Surface s;
  s.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {1, 1, 0}, {0, 1, 1}};
  s.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                 {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  // The right angle between bottom and back bends by 90, the others by 135, ends by 90.
  EXPECT_EQ(count(labels(s, 90)), 5);
  // A roof on a box: its slopes bend by 45 degrees from the walls and by 90 from each other.
  Surface roof;
  roof.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {2, 1, 0}, {0, 0, 1},
                   {2, 0, 1}, {0, 1, 1}, {2, 1, 1}, {1, 0, 2}, {1, 1, 2}};
  roof.triangles = {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}, {4, 5, 8}, {2, 6, 7},
                    {2, 7, 3}, {6, 9, 7}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5},
                    {4, 8, 9}, {4, 9, 6}, {5, 7, 9}, {5, 9, 8}};
  EXPECT_EQ(count(labels(roof, 45)), 7);
  EXPECT_EQ(count(labels(roof, 45.0000001)), 5);  // each slope with its wall
}

// Laws (2) and (3): on a surface of random bends, a torus whose vertices were shaken.
TEST(LabelByAngle, FacesDoNotDependOnTheOrderAndShrinkWithTheAngle) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shake(-0.15, 0.15);
  constexpr std::uint32_t kN = 20;
  Surface s;
  for (std::uint32_t i = 0; i < kN; ++i) {
    for (std::uint32_t j = 0; j < kN; ++j) {
      const double a = 0.1 * 3.14159265358979323846 * i, b = 0.1 * 3.14159265358979323846 * j;
      const double r = 3 + std::cos(b);
      s.vertices.push_back({r * std::cos(a) + shake(random), r * std::sin(a) + shake(random),
                            std::sin(b) + shake(random)});
      const std::uint32_t k = (i + 1) % kN, l = (j + 1) % kN;
      s.triangles.push_back({kN * i + j, kN * k + j, kN * k + l});
      s.triangles.push_back({kN * i + j, kN * k + l, kN * i + l});
    }
  }
  std::vector<std::int32_t> larger(s.triangles.size(), 1);
  for (const double degrees : {60.0, 45.0, 30.0, 20.0, 10.0}) {
    const std::vector<std::int32_t> given = labels(s, degrees);
    EXPECT_GT(count(given), 1) << degrees;
    // (3) each face is in one of the larger angle.
    std::map<std::int32_t, std::int32_t> in;
    for (std::size_t t = 0; t < given.size(); ++t) {
      ASSERT_EQ(in.try_emplace(given[t], larger[t]).first->second, larger[t]) << degrees;
    }
    larger = given;

    // (2) other triangles first, other corners first, inside out.
    std::vector<std::uint32_t> order(given.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random);
    Surface other;
    other.vertices = s.vertices;
    for (const std::uint32_t t : order) {
      auto corners = s.triangles[t];
      std::rotate(corners.begin(), corners.begin() + t % 3, corners.end());
      std::swap(corners[0], corners[1]);
      other.triangles.push_back(corners);
    }
    const std::vector<std::int32_t> shuffled = labels(other, degrees);
    std::map<std::int32_t, std::int32_t> same, back;
    std::int32_t highest = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      ASSERT_EQ(same.try_emplace(shuffled[i], given[order[i]]).first->second, given[order[i]]);
      ASSERT_EQ(back.try_emplace(given[order[i]], shuffled[i]).first->second, shuffled[i]);
      ASSERT_LE(shuffled[i], highest + 1);  // numbered as they come
      highest = std::max(highest, shuffled[i]);
    }

    // (4) no vertex has just one edge between labels.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::int32_t>> edges;
    for (std::size_t t = 0; t < given.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = s.triangles[t][k], b = s.triangles[t][(k + 1) % 3];
        edges[{std::min(a, b), std::max(a, b)}].insert(given[t]);
      }
    }
    std::map<std::uint32_t, int> ends;
    for (const auto& [edge, of] : edges) {
      if (of.size() < 2) continue;
      ++ends[edge.first];
      ++ends[edge.second];
    }
    for (const auto& [v, n] : ends) ASSERT_NE(n, 1) << v;
  }
}

TEST(LabelByAngle, RefusesAndLeavesAsItWas) {
  Surface s = box({0, 0, 0}, {1, 1, 1});
  for (const double degrees : {0.0, -1.0, 90.5, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(label_by_angle(s, degrees).code, StatusCode::invalid_options);
    EXPECT_TRUE(s.labels.empty());
  }
  s.labels.assign(12, 5);  // one name for all, as most files have it
  EXPECT_TRUE(label_by_angle(s, 30).ok());
  EXPECT_EQ(count(s.labels), 6);
  const std::vector<std::int32_t> given = s.labels;
  EXPECT_EQ(label_by_angle(s, 60).code, StatusCode::invalid_options);
  EXPECT_EQ(s.labels, given);
  s.labels.clear();
  s.triangles[3][1] = 8;
  EXPECT_EQ(label_by_angle(s, 30).code, StatusCode::invalid_surface);
  s.triangles[3][1] = 7;
  s.vertices[0][2] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(label_by_angle(s, 30).code, StatusCode::invalid_surface);
  EXPECT_TRUE(s.labels.empty());
}

// What is not a surface: open edges and edges of three triangles part faces.
TEST(LabelByAngle, EdgesOfOneOrThreeTrianglesPartFaces) {
  Surface s;
  s.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0.5, 0, 1}};
  s.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(labels(s, 30), (std::vector<std::int32_t>{1, 1}));
  s.triangles.push_back({0, 1, 4});
  EXPECT_EQ(labels(s, 30), (std::vector<std::int32_t>{1, 2, 3}));
  s.triangles = {{0, 1, 2}, {0, 1, 3}};  // turned against each other
  EXPECT_EQ(labels(s, 30), (std::vector<std::int32_t>{1, 2}));
}

TEST(LabelledFaces, PlanesAndCylindersAreKnown) {
  Surface s = can(36, 0.3);
  ASSERT_TRUE(label_by_angle(s, 11).ok());
  const std::vector<LabelledFace> faces = labelled_faces(s);
  ASSERT_EQ(faces.size(), 3U);
  const double pi = 3.14159265358979323846, sine = std::sin(0.3), cosine = std::cos(0.3);
  EXPECT_EQ(faces[0].shape, LabelledFace::Shape::cylindrical);
  EXPECT_EQ(faces[0].triangles, 72U);
  EXPECT_NEAR(faces[0].area, 36 * 4 * std::sin(pi / 36) * 3, 1e-9);
  EXPECT_NEAR(faces[0].direction[1], -sine, 1e-9);
  EXPECT_NEAR(faces[0].direction[2], cosine, 1e-9);
  for (const int end : {1, 2}) {
    const LabelledFace& face = faces[static_cast<std::size_t>(end)];
    EXPECT_EQ(face.shape, LabelledFace::Shape::planar);
    EXPECT_NEAR(face.area, 18 * 4 * std::sin(pi / 18), 1e-9);
    EXPECT_NEAR(face.direction[2], end == 1 ? -cosine : cosine, 1e-9);
    EXPECT_NEAR(face.lower[0], -2, 1e-12);
    EXPECT_NEAR(face.upper[0], 2, 1e-12);
  }
}

// A cone, a ball, a can with its ends, and a bent sheet of two strips are neither.
TEST(LabelledFaces, OthersAreNeither) {
  Surface cone = can(36);
  for (std::size_t v = 36; v < 72; ++v) {
    for (std::size_t i = 0; i < 2; ++i) cone.vertices[v][i] *= 0.9;
  }
  ASSERT_TRUE(label_by_angle(cone, 11).ok());
  EXPECT_EQ(labelled_faces(cone)[0].shape, LabelledFace::Shape::other);
  Surface whole = can(36);
  whole.labels.assign(whole.triangles.size(), 4);
  ASSERT_EQ(labelled_faces(whole).size(), 1U);
  EXPECT_EQ(labelled_faces(whole)[0].shape, LabelledFace::Shape::other);
  EXPECT_EQ(labelled_faces(whole)[0].label, 4);
  EXPECT_EQ(labelled_faces(whole)[0].direction, (std::array<double, 3>{}));
  Surface bent;
  bent.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0.3}, {1, 2, 0.3}};
  bent.triangles = {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}};
  ASSERT_TRUE(label_by_angle(bent, 30).ok());
  ASSERT_EQ(labelled_faces(bent).size(), 1U);
  EXPECT_EQ(labelled_faces(bent)[0].shape, LabelledFace::Shape::other);
  EXPECT_TRUE(labelled_faces(can(5)).empty());  // no labels
}

}  // namespace
}  // namespace delmesher::surface
