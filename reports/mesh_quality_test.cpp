#include "reports/mesh_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

namespace tetproof::mesh_quality_test {
namespace {

using oracles::MeshFile;

// Two regular tetrahedra on a common face, with a spare vertex.
MeshFile two_regular() {
  MeshFile mesh;
  mesh.vertices = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}, {5. / 3, 5. / 3, -5. / 3},
                   {9, 9, 9}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  return mesh;
}

TEST(MeshQuality, SharedFacesCountOnce) {
  const MeshQuality q = measure(two_regular());
  EXPECT_EQ(q.all.tetrahedra, 2u);
  EXPECT_EQ(q.all.vertices, 5u);
  EXPECT_EQ(q.unused_vertices, 1u);
  EXPECT_EQ(q.all.faces, 7u);
  const AngleStatistics& a = q.all.angles;
  EXPECT_NEAR(a.min_face_angle, 60, 1e-9);
  EXPECT_NEAR(a.max_face_angle, 60, 1e-9);
  EXPECT_NEAR(a.mean_min_face_angle, 60, 1e-9);
  EXPECT_NEAR(a.min_dihedral, 70.5287793655, 1e-9);
  EXPECT_NEAR(a.mean_max_dihedral, 70.5287793655, 1e-9);
  EXPECT_EQ(std::accumulate(a.face_angle_histogram.begin(), a.face_angle_histogram.end(), 0u), 21u);
  EXPECT_EQ(a.dihedral_histogram[4], 12u);  // 60 to 75 degrees
}

// Tetrahedra of two equal isosceles triangles on a common edge, this many degrees apart.
TEST(MeshQuality, SharesOfSmallDihedrals) {
  MeshFile mesh;
  const auto add_sliver = [&](double degrees) {
    const double far = 10.0 * static_cast<double>(mesh.tetrahedra.size());
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    // The edge opposite to the x axis lies in the plane that leaves it at this angle.
    const double angle = degrees * 3.14159265358979323846 / 180;
    mesh.vertices.insert(mesh.vertices.end(), {{far, 0, 0},
                                               {far + 1, 0, 0},
                                               {far + 0.5, 1, 0},
                                               {far + 0.5, std::cos(angle), std::sin(angle)}});
    mesh.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
  };
  for (const double degrees : {4.99, 5.01, 9.99, 10.01, 60.0}) add_sliver(degrees);
  const AngleStatistics& a = measure(mesh).all.angles;
  EXPECT_NEAR(a.min_dihedral, 4.99, 1e-9);
  EXPECT_EQ(a.below_5, 1u);
  EXPECT_EQ(a.below_10, 3u);
  const auto json = nlohmann::json::parse(to_json(measure(mesh)));
  EXPECT_EQ(json.at("tetrahedra_below_5_degrees"), 1);
  EXPECT_EQ(json.at("tetrahedra_below_10_degrees"), 3);
}

// Shapes of the regular tetrahedron and the corner of a cube, by hand: the corner has an inscribed
// sphere of radius 1 / (3 + sqrt 3), a circumsphere of radius sqrt(3) / 2, squared edges of 9 and
// squared doubled areas of 6.
TEST(MeshQuality, ShapesByHand) {
  MeshFile mesh;
  mesh.vertices = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1},
                   {0, 0, 0}, {1, 0, 0},   {0, 1, 0},   {0, 0, 1}};
  mesh.tetrahedra = {{0, 2, 1, 3}};
  ShapeStatistics s = measure(mesh).all.shapes;
  for (const double value : {s.min_gamma, s.mean_gamma, s.gamma_percent, s.min_sicn, s.mean_sicn}) {
    EXPECT_NEAR(value, 1, 1e-14);
  }
  mesh.tetrahedra = {{4, 5, 6, 7}};
  const double gamma = 3 / (3 + std::sqrt(3.0)) / (std::sqrt(3.0) / 2), sicn = 6 / std::sqrt(54.0);
  s = measure(mesh).all.shapes;
  EXPECT_NEAR(s.mean_gamma, gamma, 1e-14);
  EXPECT_NEAR(s.mean_sicn, sicn, 1e-14);
  for (double& x : mesh.vertices[7]) x *= 1e-9;  // nearly flat, by exact arithmetic
  EXPECT_NEAR(measure(mesh).all.shapes.min_gamma, 1.5e-9 / std::sqrt(0.5), 1e-16);
  for (double& x : mesh.vertices[7]) x = 0;
  EXPECT_EQ(measure(mesh).all.shapes.min_gamma, 0);
  EXPECT_EQ(measure(mesh).all.shapes.min_sicn, 0);
}

TEST(MeshQuality, InvertedTetrahedraHaveANegativeConditionNumber) {
  MeshFile mesh = two_regular();
  mesh.tetrahedra.push_back({1, 2, 3, 4});  // of the same sign as one of the others, or not
  const std::uint64_t inverted = measure(mesh).inverted;
  std::swap(mesh.tetrahedra[2][0], mesh.tetrahedra[2][1]);
  EXPECT_EQ(measure(mesh).inverted, 1 - inverted);
  if (inverted == 1) std::swap(mesh.tetrahedra[2][0], mesh.tetrahedra[2][1]);
  const ShapeStatistics s = measure(mesh).all.shapes;
  EXPECT_LT(s.min_sicn, -0.1);
  EXPECT_GT(s.min_gamma, 0.1);
  for (auto& t : mesh.tetrahedra) std::swap(t[0], t[1]);
  EXPECT_EQ(measure(mesh).all.shapes.min_sicn, s.min_sicn);
}

// For 101 slivers of one kind, at angles of 1, 2, ... 101 tenths of a degree, it is the second one.
TEST(MeshQuality, QuantilesOfOnePercent) {
  MeshFile mesh;
  std::vector<double> gammas;
  for (int n = 101; n >= 1; --n) {
    const double angle = 0.1 * n * 3.14159265358979323846 / 180;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(
        mesh.vertices.end(),
        {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, std::cos(angle), std::sin(angle)}});
    mesh.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
    MeshFile one = mesh;
    one.tetrahedra = {mesh.tetrahedra.back()};
    gammas.push_back(measure(one).all.shapes.mean_gamma);
  }
  const PartQuality q = measure(mesh).all;
  EXPECT_NEAR(q.angles.dihedral_percent, 0.2, 1e-9);
  EXPECT_EQ(q.shapes.gamma_percent, gammas[99]);
  EXPECT_EQ(q.shapes.min_gamma, gammas[100]);
  const auto json = nlohmann::json::parse(to_json(measure(mesh)));
  EXPECT_EQ(json.at("gamma_1_percent"), q.shapes.gamma_percent);
  EXPECT_EQ(json.at("dihedral_1_percent"), q.angles.dihedral_percent);
}

TEST(MeshQuality, OrientationOfTheFileIsFoundByMajority) {
  MeshFile mesh = two_regular();
  EXPECT_EQ(measure(mesh).inverted, 0u);
  const bool handed = measure(mesh).left_handed;
  for (auto& t : mesh.tetrahedra) std::swap(t[0], t[1]);
  EXPECT_EQ(measure(mesh).inverted, 0u);
  EXPECT_NE(measure(mesh).left_handed, handed);
  mesh.tetrahedra.push_back(mesh.tetrahedra[0]);
  std::swap(mesh.tetrahedra[0][0], mesh.tetrahedra[0][1]);
  EXPECT_EQ(measure(mesh).inverted, 1u);
}

TEST(MeshQuality, FlatRepeatedAndCrowded) {
  MeshFile mesh = two_regular();
  mesh.tetrahedra.push_back({0, 0, 1, 2});
  EXPECT_EQ(measure(mesh).flat, 1u);
  EXPECT_EQ(measure(mesh).repeated_corners, 1u);
  mesh = two_regular();
  mesh.tetrahedra.push_back({0, 1, 2, 5});
  EXPECT_EQ(measure(mesh).all.crowded_faces, 1u);
}

TEST(MeshQuality, InsideIsMeasuredSeparately) {
  MeshFile mesh = two_regular();
  mesh.vertices[4] = {10, 10, -10};
  mesh.regions = {1, 2};
  const MeshQuality q = measure(mesh);
  ASSERT_TRUE(q.inside.has_value());
  EXPECT_EQ(q.inside->tetrahedra, 1u);
  EXPECT_NEAR(q.inside->angles.min_face_angle, 60, 1e-9);
  EXPECT_LT(q.all.angles.min_face_angle, 20);

  const auto json = nlohmann::json::parse(to_json(q));
  EXPECT_EQ(json.at("tetrahedra"), 2);
  EXPECT_EQ(json.at("interior_tetrahedra"), 1);
  EXPECT_EQ(json.at("inside").at("tetrahedra"), 1);
  EXPECT_EQ(json.at("face_angle_histogram").size(), 12u);
}

// Means against a plain sum over a mesh small enough to do by hand: the corner of a cube.
TEST(MeshQuality, MeansOfACorner) {
  MeshFile mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  const AngleStatistics a = measure(mesh).all.angles;
  EXPECT_NEAR(a.mean_min_face_angle, (3 * 45 + 60) / 4.0, 1e-9);
  EXPECT_NEAR(a.mean_max_face_angle, (3 * 90 + 60) / 4.0, 1e-9);
  EXPECT_NEAR(a.mean_min_dihedral, 54.7356103172, 1e-9);
  EXPECT_NEAR(a.mean_max_dihedral, 90, 1e-9);
  const auto& h = a.face_angle_histogram;
  EXPECT_EQ(h[2] + h[3] + h[4], 9u);  // 45 and 60 are edges of bins, within rounding
  EXPECT_EQ(h[5] + h[6], 3u);         // so is 90
}

// The angles of the corner of a cube are the same at any scale.
TEST(MeshQuality, AnyScale) {
  for (const double factor : {0x1p-300, 0x1p-70, 1.0, 0x1p70, 0x1p300}) {
    MeshFile mesh;
    mesh.vertices = {{0, 0, 0}, {factor, 0, 0}, {0, factor, 0}, {0, 0, factor}};
    mesh.tetrahedra = {{0, 1, 2, 3}};
    const PartQuality q = measure(mesh).all;
    EXPECT_NEAR(q.angles.min_dihedral, 54.735610317245346, 1e-12) << factor;  // atan(sqrt 2)
    EXPECT_NEAR(q.angles.max_dihedral, 90, 1e-12) << factor;
    EXPECT_NEAR(q.angles.min_face_angle, 45, 1e-12) << factor;
    EXPECT_NEAR(q.shapes.min_sicn, 6 / std::sqrt(54.0), 1e-12) << factor;
  }
}

// A square seen as a tetrahedron, then with one corner lifted by 1e-9: its sides have 0 and 180
// degrees, nearly; the diagonals' lengths are sqrt 2.
TEST(MeshQuality, FlatTetrahedraAndSlivers) {
  MeshFile mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  AngleStatistics a = measure(mesh).all.angles;
  EXPECT_EQ(a.min_dihedral, 0);
  EXPECT_EQ(a.max_dihedral, 180);
  EXPECT_EQ(measure(mesh).flat, 1u);
  mesh.vertices[3][2] = 1e-9;
  a = measure(mesh).all.angles;
  EXPECT_NEAR(a.min_dihedral * 3.14159265358979323846 / 180, 1e-9, 1e-10);
  EXPECT_EQ(measure(mesh).flat, 0u);
}

// Three coordinates of very different size, where plain doubles would be wrong: the dihedral angle
// at the long edge, and so the largest one, is as if its corners were exchanged.
TEST(MeshQuality, NeedlesAreMeasuredExactly) {
  MeshFile mesh;
  mesh.vertices = {
      {0, 0, 0}, {0x1p30, 0x1p-30, 0x1p-30}, {0x1p29, 0x1p-20, 0}, {0x1p29, 0, 0x1p-20}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  const AngleStatistics a = measure(mesh).all.angles;
  mesh.tetrahedra = {{1, 0, 3, 2}};
  const AngleStatistics b = measure(mesh).all.angles;
  EXPECT_NEAR(a.min_dihedral, b.min_dihedral, 1e-9);
  EXPECT_NEAR(a.max_dihedral, b.max_dihedral, 1e-9);
  EXPECT_GT(a.min_face_angle, 0);
}

TEST(MeshQuality, OtherRegionsSayNothingAboutInside) {
  MeshFile mesh = two_regular();
  EXPECT_FALSE(measure(mesh).inside.has_value());
  for (const auto& regions : {std::vector<std::int64_t>{0, 0}, {1, 7}, {2, 2}}) {
    mesh.regions = regions;
    EXPECT_FALSE(measure(mesh).inside.has_value());
  }
}

TEST(MeshQuality, MissingVerticesAreAnError) {
  MeshFile mesh = two_regular();
  mesh.tetrahedra[1][2] = 6;
  EXPECT_THROW(measure(mesh), std::runtime_error);
}

TEST(MeshQuality, EmptyMesh) {
  const MeshQuality q = measure(MeshFile{});
  EXPECT_EQ(q.all.tetrahedra, 0u);
  EXPECT_TRUE(nlohmann::json::accept(to_json(q)));
}

}  // namespace
}  // namespace tetproof::mesh_quality_test
