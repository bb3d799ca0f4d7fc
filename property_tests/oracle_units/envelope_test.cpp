#include "oracles/envelope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "oracles/base/triangle_distance.h"
#include "oracles/shared_data.h"

namespace tetproof::oracles {
namespace {

// A unit cube as given, and its six tetrahedra around the diagonal from 0 to 7; bits of an index
// are coordinates.
Polyhedron cube() {
  Polyhedron p;
  for (int v = 0; v < 8; ++v) {
    p.vertices.push_back({double(v & 1), double(v >> 1 & 1), double(v >> 2 & 1)});
  }
  p.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return p;
}

MeshFile cube_mesh() {
  MeshFile mesh;
  mesh.vertices = cube().vertices;
  mesh.tetrahedra = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                     {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  return mesh;
}

constexpr double kAllowedOfSkins = 0.02;
constexpr double kShare = 0.01;
const double kAllowed = kShare * std::sqrt(3.0);

VerifyReport judged(const MeshFile& mesh, const Polyhedron& input = cube()) {
  VerifyReport report;
  EXPECT_EQ(verify_envelope(input, mesh, kShare, {}, report), "");
  return report;
}

std::string failed_first(const VerifyReport& report) {
  for (const OracleReport& oracle : report.oracles) {
    if (!oracle.passed()) return oracle.name;
  }
  return report.verdict == Verdict::deviating ? "" : "none named";
}

TEST(Envelope, IsOfASurfaceWithTriangles) {
  VerifyReport report;
  EXPECT_EQ(verify_envelope({cube().vertices, {}, {}, {}}, cube_mesh(), kShare, {}, report),
            "the surface has no triangles");
  EXPECT_EQ(verify_envelope({}, cube_mesh(), kShare, {}, report), "the surface has no triangles");
}

// Squares that are cut along the other diagonal. By halves it would take 1e12 pieces.
TEST(Envelope, IsQuickToSayThatTwoSurfacesAreInOnePlace) {
  Polyhedron other = cube();
  for (std::size_t t = 0; t < other.triangles.size(); t += 2) {
    const auto [a, b, c] = other.triangles[t];
    const Index d = other.triangles[t + 1][2];
    other.triangles[t] = {a, b, d};
    other.triangles[t + 1] = {b, c, d};
  }
  EXPECT_LE(farthest(other, cube(), 1e-12, 0), 2e-12);
  other.vertices[0] = {-0.5, 0, 0};
  EXPECT_NEAR(farthest(other, cube(), 1e-12, 0), 0.5, 1e-11);
}

TEST(Envelope, ShellsMayBeInsideOut) {
  Polyhedron two = cube();
  MeshFile mesh = cube_mesh();
  for (const Position& vertex : cube().vertices) {
    two.vertices.push_back({vertex[0] + 3, vertex[1], vertex[2]});
  }
  for (const auto& [a, b, c] : cube().triangles) two.triangles.push_back({a + 8, c + 8, b + 8});
  EXPECT_EQ(failed_first(judged(mesh, two)), "envelope");
  mesh.vertices = two.vertices;
  for (const auto& [a, b, c, d] : cube_mesh().tetrahedra) {
    mesh.tetrahedra.push_back({a + 8, b + 8, c + 8, d + 8});
  }
  EXPECT_EQ(failed_first(judged(mesh, two)), "");
}

TEST(Envelope, DistancesAreBoundedFromAboveAndNearlySo) {
  Polyhedron spiked = cube();
  spiked.vertices.push_back({0.5, 0.6, 1.25});  // stands on the face z = 1, seen by no corner of it
  spiked.triangles.erase(spiked.triangles.begin() + 2);
  for (const auto& [a, b] : {std::pair{4U, 5U}, {5U, 7U}, {7U, 4U}}) {
    spiked.triangles.push_back({a, b, 8U});
  }
  for (const double precision : {1e-2, 1e-4}) {
    Position place{};
    const double there = farthest(spiked, cube(), precision, 0, &place);
    EXPECT_GE(there, 0.25);
    EXPECT_LE(there, 0.25 + precision * 1.0001);
    EXPECT_EQ(place, (Position{0.5, 0.6, 1.25}));
  }
  // The point of the face z = 1 below the spike's apex, by a search over the face.
  double exact = 0;
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) {
      Polyhedron point;  // a triangle without extent
      point.vertices = {{i / 20.0, j / 20.0, 1}};
      point.triangles = {{0, 0, 0}};
      exact = std::max(exact, farthest(point, spiked, 1e-9, 0));
    }
  }
  const double back = farthest(cube(), spiked, 1e-4, 0);
  EXPECT_GE(back, exact - 1e-9);
  EXPECT_LE(back, exact + 0.03);  // half a step of the search
}

// Of a row of triangles, each near another part of the segment: the one in the middle as well.
TEST(Envelope, ASegmentIsNearTrianglesThatCoverItTogether) {
  const auto strip = [](double from, double to) {
    return Corners{{{from, 0, 0}, {to, 0, 0}, {(from + to) / 2, -1, 0}}};
  };
  const std::vector<Corners> row = {strip(-1, 1.2), strip(1, 2), strip(1.9, 4)};
  const Position a = {0, 0, 0}, b = {3, 0, 0};
  EXPECT_TRUE(is_segment_near(a, b, row, 0.01));
  for (std::size_t n = 0; n < row.size(); ++n) {
    std::vector<Corners> others = row;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_FALSE(is_segment_near(a, b, others, 0.01)) << n;
  }
}

TEST(Envelope, AMeshWithinItPasses) {
  EXPECT_EQ(failed_first(judged(cube_mesh())), "");
  MeshFile moved = cube_mesh();
  for (Position& p : moved.vertices) p[0] += 0.9 * kAllowed;
  const VerifyReport report = judged(moved);
  EXPECT_EQ(failed_first(report), "");
  EXPECT_GE(report.deviation, 0.9 * kAllowed);
  EXPECT_LE(report.deviation, 1.01 * kAllowed);
  EXPECT_NEAR(report.deviation_share, report.deviation / std::sqrt(3.0), 1e-12);
}

TEST(Envelope, ASurfaceInsideOutBoundsTheSameSolid) {
  Polyhedron inside_out = cube();
  for (auto& triangle : inside_out.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_EQ(failed_first(judged(cube_mesh(), inside_out)), "");
}

TEST(Envelope, FormatsWithoutOrientationMayTurnAllTetrahedra) {
  MeshFile turned = cube_mesh();
  for (Tet& tet : turned.tetrahedra) std::swap(tet[0], tet[1]);
  EXPECT_EQ(failed_first(judged(turned)), "orientation");
  turned.either_orientation = true;
  EXPECT_EQ(failed_first(judged(turned)), "");
  std::swap(turned.tetrahedra[0][0], turned.tetrahedra[0][1]);
  EXPECT_NE(failed_first(judged(turned)), "");
}

TEST(Envelope, WhatEachOracleIsFor) {
  MeshFile far = cube_mesh();
  for (Position& p : far.vertices) p[0] += 1.1 * kAllowed;
  const VerifyReport report = judged(far);
  EXPECT_EQ(failed_first(report), "envelope");
  // It says where, on the side that was moved away.
  const auto& oracles = report.oracles;
  const auto envelope = std::find_if(oracles.begin(), oracles.end(),
                                     [](const OracleReport& o) { return o.name == "envelope"; });
  ASSERT_NE(envelope, oracles.end());
  EXPECT_NE(envelope->findings.at(0).find(" envelopes at (1.019"), std::string::npos)
      << envelope->findings.at(0);

  // All that there is lies on the input; a part of the input is far from it.
  MeshFile less = cube_mesh();
  less.tetrahedra.pop_back();
  EXPECT_EQ(failed_first(judged(less)), "envelope");

  MeshFile inverted = cube_mesh();
  std::swap(inverted.tetrahedra[0][0], inverted.tetrahedra[0][1]);
  EXPECT_EQ(judged(inverted).verdict, Verdict::broken);

  MeshFile twice = cube_mesh();
  twice.tetrahedra.push_back(twice.tetrahedra[0]);
  EXPECT_EQ(judged(twice).verdict, Verdict::broken);

  MeshFile nowhere = cube_mesh();
  nowhere.tetrahedra[0][0] = 99;
  EXPECT_EQ(failed_first(judged(nowhere)), "complex");

  MeshFile no_place = cube_mesh();
  no_place.vertices[3][1] = NAN;
  EXPECT_EQ(failed_first(judged(no_place)), "complex");

  MeshFile empty = cube_mesh();
  empty.tetrahedra.clear();
  EXPECT_EQ(failed_first(judged(empty)), "own-surface");
}

// Six plates thinner than the envelope, one on each face of the cube: every point of either surface
// is near the other one.
TEST(Envelope, ACrustIsNoSolid) {
  const double inner = 1 - kAllowed;
  MeshFile crust;
  for (const double scale : {1.0, inner}) {
    for (const Position& p : cube().vertices) {
      Position q;
      for (std::size_t i = 0; i < 3; ++i) q[i] = 0.5 + scale * (p[i] - 0.5);
      crust.vertices.push_back(q);
    }
  }
  // A prism below each triangle; triangles of a prism's sides are cut at the smaller index.
  for (const auto& [a, b, c] : cube().triangles) {
    std::array<Index, 3> t = {a, b, c};
    std::sort(t.begin(), t.end());
    const auto [p, q, r] = t;
    for (std::array<Index, 4> tet :
         {std::array<Index, 4>{p, q, r, p + 8}, {q, r, p + 8, q + 8}, {r, p + 8, q + 8, r + 8}}) {
      crust.tetrahedra.push_back(tet);
    }
  }
  for (Tet& tet : crust.tetrahedra) {
    double e[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        e[i][c] = crust.vertices[tet[i + 1]][c] - crust.vertices[tet[0]][c];
      }
    }
    const double volume = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                          e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                          e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    if (volume < 0) std::swap(tet[2], tet[3]);
  }
  // In any units, also those in which volumes, or squares, are not doubles.
  for (const int exponent : {0, -370, 340, -560, 600}) {
    const auto in_units = [exponent](std::vector<Position> vertices) {
      for (Position& p : vertices) {
        for (double& x : p) x = std::ldexp(x, exponent);
      }
      return vertices;
    };
    MeshFile mesh = crust, far = cube_mesh(), moved = cube_mesh();
    for (Position& p : far.vertices) p[0] += 1.1 * kAllowed;
    for (Position& p : moved.vertices) p[0] += 0.9 * kAllowed;
    Polyhedron input = cube();
    for (auto* vertices : {&mesh.vertices, &far.vertices, &moved.vertices, &input.vertices}) {
      *vertices = in_units(*vertices);
    }
    EXPECT_EQ(failed_first(judged(mesh, input)), "envelope-volume") << exponent;
    EXPECT_EQ(failed_first(judged(far, input)), "envelope") << exponent;
    const VerifyReport near = judged(moved, input);
    EXPECT_EQ(failed_first(near), "") << exponent;
    EXPECT_GE(near.deviation, std::ldexp(0.9 * kAllowed, exponent));
    EXPECT_LE(near.deviation, std::ldexp(1.01 * kAllowed, exponent));
  }
}

// Skins around a core of some size: the slack of the volumes grows with every skin.
class Skins : public testing::TestWithParam<double> {};

TEST_P(Skins, HaveTheCore) {
  constexpr int kSkins = 12;
  constexpr double kStep = 0.6 * kAllowedOfSkins;
  const auto radius = [](int layer) { return GetParam() + kStep * layer; };
  Polyhedron input;
  MeshFile mesh;
  // Layer 0 is the core; skins are between layers 1 and 2, 3 and 4, ...
  for (int layer = 0; layer <= 2 * kSkins; ++layer) {
    const auto first = static_cast<Index>(input.vertices.size());
    for (Position p : cube().vertices) {
      for (double& x : p) x = (2 * x - 1) * radius(layer);
      input.vertices.push_back(p);
    }
    for (auto triangle : cube().triangles) {
      for (Index& v : triangle) v += first;
      if (layer % 2 == 1) std::swap(triangle[0], triangle[1]);
      input.triangles.push_back(triangle);
    }
  }
  mesh.vertices.assign(input.vertices.begin() + 8, input.vertices.end());
  for (int skin = 0; skin < kSkins; ++skin) {
    for (auto corners : cube().triangles) {
      std::ranges::sort(corners);  // so that neighbours agree in their diagonals
      const Index low = 16 * static_cast<Index>(skin), high = low + 8;
      const auto [a, b, c] = corners;
      mesh.tetrahedra.push_back({low + a, low + b, low + c, high + c});
      mesh.tetrahedra.push_back({low + a, low + b, high + b, high + c});
      mesh.tetrahedra.push_back({low + a, high + a, high + b, high + c});
    }
  }
  for (Tet& tet : mesh.tetrahedra) {
    ExactPoints points;
    points.assign(mesh.vertices);
    if (exact::orient3d(points, tet[0], tet[1], tet[2], tet[3]) < 0) std::swap(tet[0], tet[1]);
  }
  // So far away that cells of space are larger than the core.
  const auto base = static_cast<Index>(input.vertices.size());
  for (const Position& p : cube().vertices) input.vertices.push_back({p[0] + 9, p[1], p[2]});
  for (const auto& [a, b, c] : cube().triangles)
    input.triangles.push_back({a + base, b + base, c + base});
  const auto beside = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), input.vertices.begin() + base, input.vertices.end());
  for (Tet tet : cube_mesh().tetrahedra) {
    for (Index& v : tet) v += beside;
    mesh.tetrahedra.push_back(tet);
  }
  const double share = kAllowedOfSkins / diagonal_of(input);
  VerifyReport report;
  EXPECT_EQ(verify_envelope(input, mesh, share, {}, report), "");
  EXPECT_EQ(failed_first(report), "envelope-sides") << to_text(report);
  // With the core all is well.
  const auto first = static_cast<Index>(mesh.vertices.size());
  for (int v = 0; v < 8; ++v) mesh.vertices.push_back(input.vertices[static_cast<std::size_t>(v)]);
  for (Tet tet : cube_mesh().tetrahedra) {
    for (Index& v : tet) v += first;
    mesh.tetrahedra.push_back(tet);
  }
  EXPECT_EQ(verify_envelope(input, mesh, share, {}, report), "");
  EXPECT_EQ(failed_first(report), "") << to_text(report);
  ASSERT_EQ(report.unproven.size(), 1U);
  EXPECT_TRUE(report.unproven[0].starts_with("parts thinner than ")) << report.unproven[0];
}

INSTANTIATE_TEST_SUITE_P(OfAllSizes, Skins, testing::Values(0.035, 0.1, 1.0));

TEST(Envelope, SaysFirstWhatItDoesNotCompare) {
  Polyhedron input = cube();
  input.labels.assign(input.triangles.size(), 1);
  input.labels[0] = 2;
  VerifyOptions options;
  EXPECT_EQ(parse_promise("mesh --max-edge 0.5 --tau 0.1", options.promised), "");
  VerifyReport report;
  EXPECT_EQ(verify_envelope(input, cube_mesh(), kShare, options, report), "");
  EXPECT_EQ(report.verdict, Verdict::undecided) << to_text(report);
  ASSERT_EQ(report.unproven.size(), 4U) << to_text(report);
  EXPECT_TRUE(report.unproven[0].starts_with("--max-edge (")) << report.unproven[0];
  EXPECT_EQ(report.unproven[1], "--tau");
  EXPECT_EQ(report.unproven[2], "labels");
  EXPECT_TRUE(report.unproven[3].starts_with("parts thinner than ")) << report.unproven[3];
}

}  // namespace
}  // namespace tetproof::oracles
