// What is promised of the refined mesh: features of chamfers, encroachment, Delaunay.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oracles/mesh/delaunay.h"
#include "oracles/mesh/tet_complex.h"
#include "oracles/record/chamfer_features.h"
#include "oracles/record/refinement.h"
#include "oracles/surface/corners.h"
#include "oracles/surface/input_surface.h"
#include "property_tests/oracle_units/helpers.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT

// The acute corners of a surface, those below 60 degrees, and the features of their chamfers.
class Sharp {
 public:
  explicit Sharp(const Polyhedron& solid) : points_(points_of(solid.vertices)) {
    EXPECT_EQ(surface_.assign(solid, points_), "");
    corners_.emplace(points_, surface_);
  }
  std::vector<ChamferFeatures::Feature> features(Index vertex,
                                                 const ChamferShape& shape = {}) const {
    const CornerThresholds thresholds = {60, 60};
    return ChamferFeatures(points_, surface_, *corners_, thresholds, shape).at(vertex, [](Index) {
      return true;
    });
  }
  double smallest_feature(Index vertex, const ChamferShape& shape = {}) const {
    double smallest = kInfinity;
    for (const auto& feature : features(vertex, shape)) {
      smallest = std::min(smallest, feature.size);
    }
    return smallest;
  }
  // Of the features of that size, the one that fits most often.
  double times(Index vertex, double size) const {
    double most = -1;
    for (const auto& feature : features(vertex)) {
      if (std::fabs(feature.size - size) < 1e-12) most = std::max(most, feature.times);
    }
    return most;
  }

 private:
  ExactPoints points_;
  InputSurface surface_;
  std::optional<AcuteCorners> corners_;
};

// A prism over a triangle whose corner at vertex 0 has the half angle a, tan a = 1 / 4, and whose
// opposite side is 12 away, so that the chamfer distance is 4 at most. Smallest is the side of the
// bridge in that corner, sin a / (cos a + 1 / 2) of the chamfer distance (Figure 4).
void expect_features_of_a_sharp_prism(double bottom) {
  Polyhedron prism;
  for (const double z : {bottom, 100.0}) {
    for (const auto& [x, y] : {std::pair(0.0, 0.0), {12.0, -3.0}, {12.0, 3.0}}) {
      prism.vertices.push_back({x, y, z});
    }
  }
  prism.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                     {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  const Sharp sharp(prism);
  const double side = 1 / (4 + std::sqrt(17.0) / 2);
  for (const Index v : {0U, 3U}) {
    EXPECT_NEAR(sharp.smallest_feature(v), 4 * side, 1e-12);
    EXPECT_NEAR(sharp.smallest_feature(v, {.limit = 1}), side, 1e-12);
  }
  // How often gaps fit: between the two long edges of the triangle, from 4 on to their ends; and
  // between the strips of the edge between the triangles, from 4 on to 4 before its other end.
  const double sine = 1 / std::sqrt(17.0), strip = 4 * std::sqrt(0.5) / (std::sqrt(0.5) + 0.5);
  EXPECT_NEAR(sharp.times(0, 8 * sine), std::log(std::sqrt(153.0) / 4) * 17 / 8, 1e-12);
  EXPECT_NEAR(sharp.times(0, 2 * strip * sine), (92 - bottom) / (2 * strip * sine), 1e-12);
  for (const Index v : {1U, 2U, 4U, 5U}) {  // no angle below 60 degrees
    EXPECT_EQ(sharp.smallest_feature(v), kInfinity);
  }
}

TEST(ChamferFeatures, OfASharpPrism) {
  expect_features_of_a_sharp_prism(0);
}

// Products of exact vectors are not doubles there.
TEST(ChamferFeatures, OfCoordinatesWithManyBits) {
  expect_features_of_a_sharp_prism(0x1p-600);
}

// A prism over a square with a notch, whose tip is 1 away from the middle of the side across. The
// prism leans, so that it has a dihedral angle of atan(1 / 2) at that side. The strip along the
// side is a third wide there, although its ends have no feature that near, and the two strips are
// as far apart as the angle says.
TEST(ChamferFeatures, AVertexNearTheMiddleOfAnEdgeNarrowsItsStrip) {
  Polyhedron notched;
  for (const double z : {0.0, 24.0}) {
    for (const auto& [x, y] :
         {std::pair(0.0, 0.0), {12.0, 0.0}, {12.0, 12.0}, {6.0, 1.0}, {0.0, 12.0}}) {
      notched.vertices.push_back({x, y + 2 * z, z});
    }
  }
  for (Index i = 0; i < 5; ++i) {
    const Index j = (i + 1) % 5;
    notched.triangles.push_back({i, j, j + 5});
    notched.triangles.push_back({i, j + 5, i + 5});
  }
  for (const auto& [a, b, c] : {std::array<Index, 3>{0, 1, 3}, {1, 2, 3}, {0, 3, 4}}) {
    notched.triangles.push_back({a, c, b});
    notched.triangles.push_back({a + 5, b + 5, c + 5});
  }
  EXPECT_NEAR(Sharp(notched).smallest_feature(0), 2.0 / 3 * std::sin(std::atan(0.5) / 2), 1e-12);
}

// One edge after another of 16 is encroached by a corner of its own tetrahedron. With that many
// vertices only a few edges can be tried against all of them, yet each must be found.
TEST(Encroachment, ByANeighbourIsFoundWhateverIsSampled) {
  constexpr std::size_t kVertices = 1U << 16U, kEdges = 16;
  std::vector<Position> positions;
  TetComplex complex;
  delmesher::ExactRecord record;
  record.parameters.gabriel = true;
  while (positions.size() < kVertices) {
    const auto first = static_cast<Index>(positions.size());
    const double x = 10.0 * first;
    for (const Position& p : {Position{0, 0, 0}, {2, 0, 0}, {1, 0.5, 0}, {1, 3, 3}}) {
      positions.push_back({x + p[0], p[1], p[2]});
    }
    complex.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
    if (record.segments.size() < kEdges) {
      record.segments.push_back({false, kNone, {first, first + 1}});
    }
  }
  const ExactPoints points = points_of(positions);
  complex.points = &points;
  RefinedMesh mesh;
  mesh.record = &record;
  mesh.points = &points;
  mesh.complex = &complex;
  const OracleReport report = check_encroachment(mesh);
  EXPECT_EQ(report.checked, kEdges);
  EXPECT_GE(report.violations, kEdges);
}

// The vertex is of another tetrahedron, and doubles do not tell on which side of the ball around
// the edge or the face it is: centre (1, 0, 0), radius 1.
TEST(Encroachment, ByAnotherTetrahedronIsDecidedExactly) {
  const auto violations = [](const Position& v) {
    std::array<std::uint64_t, 2> result{};  // of the edge, of the face
    for (const bool face : {false, true}) {
      const ExactPoints points = points_of(
          {{0, 0, 0}, {2, 0, 0}, {1, -1, 0}, {1, 0, 5}, v, {50, 0, 0}, {50, 1, 0}, {50, 0, 1}});
      TetComplex complex;
      complex.points = &points;
      complex.tetrahedra = {{0, 1, 2, 3}, {4, 5, 6, 7}};
      delmesher::ExactRecord record;
      record.parameters.gabriel = true;
      if (face) {
        record.refined_facets.push_back({0, 1, 2, 0});
      } else {
        record.segments.push_back({false, kNone, {0, 1}});
      }
      RefinedMesh mesh;
      mesh.record = &record;
      mesh.points = &points;
      mesh.complex = &complex;
      result[face ? 1 : 0] = check_encroachment(mesh).violations;
    }
    return result;
  };
  using Two = std::array<std::uint64_t, 2>;
  EXPECT_EQ(violations({1, 0, 0.5}), (Two{1, 1}));
  EXPECT_EQ(violations({1, 0, 1 - 0x1p-53}), (Two{1, 1}));
  EXPECT_EQ(violations({1, 0, 1}), (Two{0, 0}));
  EXPECT_EQ(violations({1, 0, 1 + 0x1p-52}), (Two{0, 0}));
}

// The sphere through the first tetrahedron contains the apex of the second, and the other way
// round: reported once for the face between them, once for each of the two.
TEST(Delaunay, AFaceBetweenTwoSpheresIsNamed) {
  ExactPoints points;
  ASSERT_EQ(
      points.assign(std::vector<Position>{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {1, 1, -1}}),
      "");
  TetComplex complex{&points, {{0, 1, 2, 3}, {0, 2, 1, 4}}, {}, 0, 5};
  Neighbours neighbours;
  ASSERT_TRUE(check_complex(complex, neighbours).passed());
  const OracleReport report = check_delaunay(complex, neighbours);
  EXPECT_EQ(report.violations, 3U) << report.findings.front();
  EXPECT_NE(report.findings.front().find("face"), std::string::npos) << report.findings.front();
}

// Faces between two tetrahedra that a mesh which is Delaunay has as well are not decided again, all
// others are. The surface hides the apexes from each other.
TEST(Delaunay, AFaceIsLeftOutOnlyIfBothOfItsTetrahedraAreKnown) {
  ExactPoints points;
  const std::vector<Position> vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {1, 1, -1}};
  ASSERT_EQ(points.assign(vertices), "");
  InputSurface surface;
  ASSERT_EQ(
      surface.assign({vertices, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, {}, {}}, points), "");
  const TetComplex complex{&points, {{0, 1, 2, 3}, {0, 2, 1, 4}}, {}, 0, 5};
  Neighbours neighbours;
  ASSERT_TRUE(check_complex(complex, neighbours).passed());
  const auto violations = [&](const std::vector<Tet>& others) {
    const TetComplex other{&points, others, {}, 0, 0};
    const std::vector<delmesher::ExactRecord::Tet> tets = {{{0, 1, 2, 3}, true},
                                                           {{0, 2, 1, 4}, false}};
    return check_constrained_delaunay(complex, neighbours, surface, {},
                                      {.known = in_both(tets, other)})
        .violations;
  };
  EXPECT_EQ(check_constrained_delaunay(complex, neighbours, surface, {}).violations, 1U);
  EXPECT_EQ(violations({}), 1U);
  EXPECT_EQ(violations({{0, 1, 2, 3}}), 1U);
  EXPECT_EQ(violations({{0, 1, 2, 3}, {0, 3, 1, 4}}), 1U);
  EXPECT_EQ(violations({{3, 2, 1, 0}, {4, 0, 1, 2}}), 0U);
}

// Comparing all of them with each other would take 2e10 comparisons.
TEST(Delaunay, TetrahedraInBothAreFoundAroundAVertexOfAlmostAll) {
  constexpr Index kMany = 200000;
  const ExactPoints points;
  TetComplex other{&points, {}, {}, 0, 0};
  std::vector<delmesher::ExactRecord::Tet> tets;
  for (Index v = 1; v <= kMany; ++v) {
    other.tetrahedra.push_back({0, v, v + 1, v + 2});
    // The same in another order, or with the same sum of its corners.
    tets.push_back(v % 2 == 0 ? delmesher::ExactRecord::Tet{{v + 2, v, 0, v + 1}, true}
                              : delmesher::ExactRecord::Tet{{0, v, v, v + 3}, true});
  }
  std::uint64_t compared = 0;
  const std::vector<std::uint8_t> found = in_both(tets, other, &compared);
  EXPECT_LT(compared, 10U * kMany);
  ASSERT_EQ(found.size(), tets.size());
  for (Index v = 1; v <= kMany; ++v) ASSERT_EQ(found[v - 1] != 0, v % 2 == 0) << v;
}

// Tetrahedra around one edge, in an order in which none follows its neighbour. As they come, each
// face would be compared with a quarter of all.
TEST(Complex, ManyTetrahedraAroundAnEdgeTakeNoQuadraticTime) {
  constexpr Index kMany = 100003, kStep = 31607;  // without a common divisor
  ExactPoints points;
  std::vector<Position> vertices = {{0, 0, -1}, {0, 0, 1}};
  for (Index v = 0; v < kMany; ++v) {
    const double angle = 2 * std::acos(-1.0) * v / kMany;
    vertices.push_back({std::cos(angle), std::sin(angle), 0});
  }
  ASSERT_EQ(points.assign(vertices), "");
  TetComplex complex{&points, {}, {}, 0, kMany + 2};
  for (std::uint64_t n = 0; n < kMany; ++n) {
    const auto v = static_cast<Index>(n * kStep % kMany);
    complex.tetrahedra.push_back({0, 1, v + 2, (v + 1) % kMany + 2});
  }
  Neighbours neighbours;
  const OracleReport report = check_complex(complex, neighbours);
  EXPECT_LT(neighbours.compared, 100U * 4 * kMany);
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(std::count(neighbours.across.begin(), neighbours.across.end(), kNone), 2 * kMany);
}

}  // namespace
}  // namespace tetproof
