#include "mesher/improve/given_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "mesher/base/face_key.h"
#include "mesher/delmesher/run.h"

namespace delmesher::improve {
namespace {

// Four tetrahedra around vertex 4; the last two are of region 2.
struct Given {
  std::vector<Vec3> vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {1, 1, 1}};
  std::vector<Tet> tetrahedra = {{0, 1, 2, 4}, {0, 3, 1, 4}, {1, 3, 2, 4}, {0, 2, 3, 4}};
  std::vector<RegionId> region = {1, 1, 2, 2};
  std::vector<std::array<VertexId, 3>> triangles;

  CheckedMesh check() const {
    Limits limits;
    Control control(limits);
    return check_given({vertices, tetrahedra, region, triangles}, control);
  }
};

std::set<std::array<VertexId, 3>> surface(const CheckedMesh& checked) {
  std::set<std::array<VertexId, 3>> faces;
  for (const SurfaceFace& face : checked.mesh.boundary) {
    const auto& [a, b, c] = face.vertices;
    EXPECT_TRUE(faces.insert(undirected_face(a, b, c)).second);
  }
  return faces;
}

TEST(GivenMesh, KeepsHullInterfacesAndTriangles) {
  Given given;
  given.region = {1, 1, 1, 1};
  const std::set<std::array<VertexId, 3>> hull = {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}};
  EXPECT_EQ(given.check().defect, "");
  EXPECT_EQ(surface(given.check()), hull);
  given.triangles = {{4, 0, 1}, {0, 1, 4}, {1, 0, 2}};  // one of them twice, one of the hull
  std::set<std::array<VertexId, 3>> kept = hull;
  kept.insert({0, 1, 4});
  EXPECT_EQ(surface(given.check()), kept);
  given.region = {1, 1, 2, 2};
  kept.insert({{1, 2, 4}, {0, 2, 4}, {1, 3, 4}, {0, 3, 4}});
  EXPECT_EQ(given.check().defect, "");
  EXPECT_EQ(surface(given.check()), kept);
}

TEST(GivenMesh, TurnsWhatIsOfTheOtherConvention) {
  Given given;
  EXPECT_FALSE(given.check().turned);
  EXPECT_EQ(given.check().mesh.tetrahedra, given.tetrahedra);
  const std::vector<Tet> right = given.tetrahedra;
  for (Tet& t : given.tetrahedra) std::swap(t[0], t[1]);
  const CheckedMesh checked = given.check();
  EXPECT_EQ(checked.defect, "");
  EXPECT_TRUE(checked.turned);
  for (std::size_t t = 0; t < right.size(); ++t) {
    const Tet &v = checked.mesh.tetrahedra[t], &w = right[t];
    EXPECT_EQ(v, (Tet{w[1], w[0], w[3], w[2]}));
  }
}

TEST(GivenMesh, AcceptsFlatTetrahedra) {
  Given given;
  given.vertices[4] = {1, 1, 0};  // in the face 0 1 2
  const CheckedMesh checked = given.check();
  EXPECT_EQ(checked.defect, "");
  EXPECT_EQ(checked.flat, 1U);
}

// A mesh with one defect, and the message about it.
struct Wrong {
  const char* name;
  void (*spoil)(Given& given);
  const char* defect;
};

class WrongMeshes : public testing::TestWithParam<Wrong> {};

TEST_P(WrongMeshes, AreRefusedByName) {
  Given given;
  GetParam().spoil(given);
  EXPECT_EQ(given.check().defect, GetParam().defect);
}

const Wrong kWrong[] = {
    {"NoTetrahedra", [](Given& g) { g.tetrahedra.clear(); }, "there are no tetrahedra"},
    {"NotFinite", [](Given& g) { g.vertices[2][1] = HUGE_VAL; },
     "vertex 2 has a coordinate that is not finite"},
    {"NotANumber", [](Given& g) { g.vertices[4][0] = std::nan(""); },
     "vertex 4 has a coordinate that is not finite"},
    {"OutOfRange", [](Given& g) { g.tetrahedra[1][2] = 5; },
     "tetrahedron 1 names vertex 5 of 5, counted from 0"},
    {"VertexTwice", [](Given& g) { g.tetrahedra[3][2] = 0; }, "tetrahedron 3 has vertex 0 twice"},
    {"TriangleOutOfRange",
     [](Given& g) {
       g.triangles = {{0, 1, 2}, {0, 1, 9}};
     },
     "triangle 1 names vertex 9 of 5, counted from 0"},
    {"TriangleOfTwo",
     [](Given& g) {
       g.triangles = {{0, 1, 1}};
     },
     "triangle 0 has vertex 1 twice"},
    {"TriangleOfNoTetrahedron",
     [](Given& g) {
       g.vertices.push_back({9, 9, 9});
       g.triangles = {{0, 1, 2}, {0, 1, 5}};
     },
     "triangle 1 (0-1-5) is a face of no tetrahedron"},
    {"Inverted", [](Given& g) { std::swap(g.tetrahedra[2][0], g.tetrahedra[2][1]); },
     "tetrahedra 0 and 2 are of opposite orientation: one of them is inverted"},
    {"Twice",
     [](Given& g) {
       g.tetrahedra.push_back({2, 0, 1, 4});
       g.region.push_back(1);
     },
     "tetrahedra 0 and 4 are on the same side of the face 0-1-2"},
    {"SameSide",
     [](Given& g) {
       g.vertices.push_back({1, 1, 2});
       g.tetrahedra.push_back({0, 1, 2, 5});
       g.region.push_back(1);
     },
     "tetrahedra 0 and 4 are on the same side of the face 0-1-2"},
    {"TheSameFourCorners",
     [](Given& g) {
       g.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
       g.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 3}};
       g.region = {1, 1};
       g.triangles.clear();
     },
     "tetrahedra 0 and 1 have the same four corners"},
    {"ThreeAtAFace",
     [](Given& g) {
       g.vertices.push_back({3, 3, 3});
       g.tetrahedra.push_back({0, 1, 4, 5});
       g.region.push_back(1);
     },
     "more than two tetrahedra have the face 0-1-4: 0, 1 and 4"},
    {"TwoStarsAtAVertex",
     [](Given& g) {
       // The same again elsewhere, around the same vertex 4, whose star is closed as it is.
       for (const VertexId v : {0, 1, 2, 3}) g.vertices.push_back(g.vertices[v]);
       for (std::size_t t = 0; t < 4; ++t) {
         Tet tet = g.tetrahedra[t];
         for (VertexId& v : tet) v = v == 4 ? 4 : v + 5;
         g.tetrahedra.push_back(tet);
       }
       g.region.assign(8, 1);
     },
     "the tetrahedra at vertex 4 are not connected by faces: 0 and 4"}};

INSTANTIATE_TEST_SUITE_P(GivenMesh, WrongMeshes, testing::ValuesIn(kWrong),
                         [](const auto& wrong) { return std::string(wrong.param.name); });

// Vertices that are kept may join parts that no face connects.
TEST(GivenMesh, TetrahedraMayMeetAtAKeptVertex) {
  Given given;
  given.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  given.tetrahedra = {{0, 1, 2, 3}, {0, 5, 4, 6}};
  given.region = {1, 1};
  EXPECT_EQ(given.check().defect, "");
}

}  // namespace
}  // namespace delmesher::improve
