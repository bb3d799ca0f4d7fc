#include "mesher/improve/quality.h"

#include <gmpxx.h>
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

bool reaches(const Quality& q, const Quality& least) {
  return q.dihedral >= least.dihedral && q.face >= least.face && q.gamma >= least.gamma;
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

// By rational arithmetic: squared sines of the smallest dihedral and face angles.
struct ExactQuality {
  using Rational = mpq_class;
  using Vector = std::array<Rational, 3>;

  explicit ExactQuality(const Points& p) {
    const auto between = [&](int i, int j) {
      Vector x;
      for (std::size_t k = 0; k < 3; ++k) x[k] = Rational(p[j][k]) - Rational(p[i][k]);
      return x;
    };
    const auto product = [](const Vector& x, const Vector& y) {
      return Vector{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2],
                    x[0] * y[1] - x[1] * y[0]};
    };
    const auto scalar = [](const Vector& x, const Vector& y) -> Rational {
      return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    };
    positive = scalar(product(between(0, 1), between(0, 2)), between(0, 3)) > 0;
    if (!positive) return;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k) {
          if (i == j || j == k || i == k) continue;
          const Vector a = between(i, j), b = between(i, k), c = between(i, 6 - i - j - k);
          const Vector ab = product(a, b), ac = product(a, c), n = product(ab, ac);
          const Rational of_face = scalar(ab, ab) / (scalar(a, a) * scalar(b, b)),
                         of_edge = scalar(n, n) / (scalar(ab, ab) * scalar(ac, ac));
          face = std::min(face, of_face.get_d());
          dihedral = std::min(dihedral, of_edge.get_d());
        }
      }
    }
  }

  bool positive = false;
  double dihedral = 1, face = 1;
};

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

// Three corners within 1e-10 of the fourth's distance, and flat ones, as exact arithmetic has them.
TEST(Quality, OfNeedlesAndFlatTetrahedraIsAccurate) {
  const Points needle = {{{0.547332763671875, 0.60345458984375, 0.563568115234375},
                          {0.6241694207870403, 0.67485945465581865, 0.3041489110208454},
                          {0.6241694207870403, 0.67485945486560561, 0.3041489110208454},
                          {0.62416942078951099, 0.67485945465581865, 0.3041489110208454}}};
  std::vector<Points> all = {needle};
  std::mt19937 random(3);
  for (int n = 0; n < 60; ++n) {
    Points p = random_points(random);
    // The last corner goes towards a corner, or into the plane of the others.
    const double left = std::ldexp(1, -20 - n / 2);
    for (std::size_t i = 0; i < 3; ++i) {
      const double there = n % 2 == 0 ? p[2][i] : (p[0][i] + p[1][i] + p[2][i]) / 3;
      p[3][i] = there + left * (p[3][i] - there);
    }
    all.push_back(p);
  }
  int positive = 0;
  for (const Points& p : all) {
    for (const auto& [i, j, k, l] : {std::array{0, 1, 2, 3}, {1, 2, 0, 3}, {3, 2, 1, 0}}) {
      const Points turned = {p[i], p[j], p[k], p[l]};
      const ExactQuality exact(turned);
      const Quality q = of(turned);
      EXPECT_EQ(q.dihedral > 0, exact.positive);
      for (const float factor : {0.5F, 0.999F, 1.001F, 3.0F}) {
        for (const Quality& least : {Quality{factor * q.dihedral, 0, 0},
                                     {0, factor * q.face, 0},
                                     {factor * q.dihedral, factor * q.face, 0},
                                     {1e-9F, 1e-9F, 0}}) {
          EXPECT_EQ(reaches(of(turned, least), least), reaches(q, least));
        }
      }
      if (!exact.positive) continue;
      ++positive;
      EXPECT_NEAR(q.dihedral, exact.dihedral, 1e-5 * exact.dihedral);
      EXPECT_NEAR(q.face, exact.face, 1e-5 * exact.face);
    }
  }
  EXPECT_GT(positive, 100);
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
      if (n != 0) apex = geometry::add(apex, best_apex(a, b, c));
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
