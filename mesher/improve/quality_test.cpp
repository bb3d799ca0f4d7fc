#include "mesher/improve/quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "mesher/improve/cone.h"

namespace delmesher::improve {
namespace {

using Points = std::array<Vec3, 4>;

const Points kRegular = {{{0, 0, 0}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}}};
const Points kCorner = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

Quality of(const Points& p, const Quality& least = {}) {
  return quality(p[0], p[1], p[2], p[3], least);
}

Points positive(Points p) {
  if (of(p).dihedral == 0) std::swap(p[2], p[3]);
  return p;
}

Points random_points(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Points p;
  for (Vec3& x : p) x = {unit(random), unit(random), unit(random)};
  return positive(p);
}

// The dihedral angle of a regular one has a cosine of 1/3. In the corner of a cube the smallest
// dihedral angle has a cosine of 1/sqrt(3), the smallest face angle is 45 degrees, the circumradius
// is sqrt(3)/2 and the inradius 1/(3 + sqrt(3)).
TEST(Quality, OfKnownTetrahedra) {
  const Quality regular = of(positive(kRegular));
  EXPECT_NEAR(regular.dihedral, 8.0 / 9, 1e-6);
  EXPECT_NEAR(regular.face, 0.75, 1e-6);
  EXPECT_NEAR(regular.gamma, 1, 1e-6);
  const Quality corner = of(positive(kCorner));
  EXPECT_NEAR(corner.dihedral, 2.0 / 3, 1e-6);
  EXPECT_NEAR(corner.face, 0.5, 1e-6);
  const double gamma = 6 / (std::sqrt(3.0) * (3 + std::sqrt(3.0)));
  EXPECT_NEAR(corner.gamma, gamma * gamma, 1e-6);
}

TEST(Quality, IsZeroForFlatAndInverted) {
  Points p = positive(kRegular);
  std::swap(p[0], p[1]);
  for (const Points& bad : {p, Points{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}},
                            Points{{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {1, 1, 1}}}}) {
    EXPECT_EQ(of(bad).dihedral, 0);
    EXPECT_EQ(of(bad).face, 0);
    EXPECT_EQ(of(bad).gamma, 0);
  }
}

// Angles by another formula, whatever the order of the vertices and the scale.
TEST(Quality, AgreesWithAnglesOneByOne) {
  std::mt19937 random(1);
  for (int n = 0; n < 200; ++n) {
    const Points p = random_points(random);
    double dihedral = 1, face = 1;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k) {
          if (i == j || j == k || i == k) continue;
          const int l = 6 - i - j - k;
          const Vec3 a = subtract(p[j], p[i]), b = subtract(p[k], p[i]), c = subtract(p[l], p[i]);
          const Vec3 ab = cross(a, b), ac = cross(a, c);
          face = std::min(face, squared_norm(ab) / (squared_norm(a) * squared_norm(b)));
          dihedral = std::min(dihedral,
                              squared_norm(cross(ab, ac)) / (squared_norm(ab) * squared_norm(ac)));
        }
      }
    }
    const Quality q = of(p);
    EXPECT_NEAR(q.dihedral, dihedral, 1e-5 * dihedral);
    EXPECT_NEAR(q.face, face, 1e-5 * face);
    const Quality turned = quality(p[1], p[2], p[0], p[3]);
    EXPECT_NEAR(turned.gamma, q.gamma, 1e-5 * q.gamma);
    Points scaled = p;
    for (Vec3& x : scaled) x = {x[0] * 0x1p60, x[1] * 0x1p60, x[2] * 0x1p60};
    EXPECT_EQ(of(scaled).dihedral, q.dihedral);
    EXPECT_EQ(of(scaled).face, q.face);
    EXPECT_EQ(of(scaled).gamma, q.gamma);
  }
}

TEST(Quality, IsIncompleteBelowTheLeast) {
  const Points p = positive(kCorner);
  const Quality q = of(p);
  EXPECT_EQ(of(p, {q.dihedral, q.face, q.gamma}).gamma, q.gamma);
  EXPECT_EQ(of(p, {1, 0, 0}).dihedral, q.dihedral);
  EXPECT_EQ(of(p, {1, 0, 0}).gamma, 0);
  EXPECT_EQ(of(p, {0, 1, 0}).face, q.face);
  EXPECT_EQ(of(p, {0, 1, 0}).gamma, 0);
}

TEST(Quality, TheBestApexIsNearlyRegular) {
  std::mt19937 random(2);
  const Vec3 a = {0, 0, 0}, b = {2, 0, 0}, c = {1, std::sqrt(3.0), 0};
  const Vec3 apex = best_apex(a, b, c);
  EXPECT_GT(quality(apex, a, c, b).gamma + quality(apex, a, b, c).gamma, 0.99);
  EXPECT_LT(apex[2], 0);
  EXPECT_EQ(best_apex(a, a, a), a);
}

// The sides of a distorted cube around the origin, each cut in two, counter-clockwise from outside.
std::vector<std::array<Vec3, 3>> faces_around(std::mt19937& random) {
  std::uniform_real_distribution<double> size(0.8, 1.2);
  std::array<Vec3, 8> corner;
  for (std::size_t n = 0; n < 8; ++n) {
    const double r = size(random);
    corner[n] = {(n & 1U) != 0 ? r : -r, (n & 2U) != 0 ? r : -r, (n & 4U) != 0 ? r : -r};
  }
  constexpr std::size_t kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  std::vector<std::array<Vec3, 3>> faces;
  for (const auto& [a, b, c, d] : kSides) {
    faces.push_back({corner[a], corner[b], corner[c]});
    faces.push_back({corner[a], corner[c], corner[d]});
  }
  return faces;
}

// One by one, however many there are: the last lanes are not full, and lanes are used again.
TEST(Cone, AgreesWithTetrahedraOneByOne) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-0.3, 0.3);
  Cone cone;
  for (int round = 0; round < 200; ++round) {
    std::vector<std::array<Vec3, 3>> faces = faces_around(random);
    faces.resize(1 + random() % faces.size());
    std::ranges::shuffle(faces, random);
    const std::size_t ignored = random() % faces.size();
    cone.clear();
    for (std::size_t n = 0; n < faces.size(); ++n) {
      cone.add(faces[n][0], faces[n][1], faces[n][2], n != ignored);
    }
    cone.finish();
    ASSERT_EQ(cone.size(), faces.size());
    for (int place = 0; place < 5; ++place) {
      const Vec3 x = {unit(random), unit(random), unit(random)};
      Quality worst = kNotCounted;
      ASSERT_TRUE(cone.reaches(x, {}));
      for (std::size_t n = 0; n < faces.size(); ++n) {
        const Quality one = quality(x, faces[n][0], faces[n][1], faces[n][2]);
        const Quality lane = cone.quality(n);
        ASSERT_EQ(cone.counts(n), n != ignored);
        if (n == ignored) {
          ASSERT_EQ(lane.gamma, kNotCounted.gamma);
          continue;
        }
        ASSERT_NEAR(lane.dihedral, one.dihedral, 1e-5 * one.dihedral);
        ASSERT_NEAR(lane.face, one.face, 1e-5 * one.face);
        ASSERT_NEAR(lane.gamma, one.gamma, 1e-5 * one.gamma);
        worst = worse(worst, lane);
      }
      if (faces.size() == 1) continue;  // nothing counts
      // What all reach, and what one of them does not in one of three ways.
      EXPECT_TRUE(cone.reaches(x, worst));
      EXPECT_FALSE(cone.reaches(x, {1.0001F * worst.dihedral, worst.face, worst.gamma}));
      EXPECT_FALSE(cone.reaches(x, {worst.dihedral, 1.0001F * worst.face, worst.gamma}));
      EXPECT_FALSE(cone.reaches(x, {worst.dihedral, worst.face, 1.0001F * worst.gamma}));
    }
  }
}

// Over the faces that count, and over the edges of all.
TEST(Cone, KnowsItsAverages) {
  std::mt19937 random(9);
  for (std::size_t size = 2; size < 8; ++size) {
    const std::vector<std::array<Vec3, 3>> faces = faces_around(random);
    Cone cone;
    Vec3 apex{};
    double squared = 0;
    for (std::size_t n = 0; n < size; ++n) {
      const auto& [a, b, c] = faces[n];
      cone.add(a, b, c, n != 0);
      squared += squared_norm(subtract(b, a)) + squared_norm(subtract(c, b)) +
                 squared_norm(subtract(a, c));
      if (n != 0) apex = predicates::add(apex, best_apex(a, b, c));
    }
    cone.finish();
    EXPECT_NEAR(cone.average_squared_edge(), squared / static_cast<double>(3 * size), 1e-12);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(cone.average_apex()[i], apex[i] / static_cast<double>(size - 1), 1e-12);
    }
  }
}

// Also where the tetrahedron that is not positive does not count.
TEST(Cone, HasToBePositive) {
  std::mt19937 random(8);
  const std::vector<std::array<Vec3, 3>> faces = faces_around(random);
  for (const bool counts : {true, false}) {
    Cone cone;
    for (const auto& [a, b, c] : faces) cone.add(a, b, c, counts);
    cone.finish();
    EXPECT_TRUE(cone.reaches({0, 0, 0}, {}));
    EXPECT_FALSE(cone.reaches({2, 0, 0}, {}));
    EXPECT_FALSE(cone.reaches(faces[0][0], {}));
    EXPECT_FALSE(cone.reaches({std::nan(""), 0, 0}, {}));
    EXPECT_TRUE(cone.reaches({0, 0, 0}, {}));
  }
}

}  // namespace
}  // namespace delmesher::improve
