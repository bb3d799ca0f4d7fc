// What is said of a mesh file without a record.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "oracles/files/edge_nodes.h"
#include "oracles/mesh/conformity.h"
#include "oracles/mesh/tet_complex.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT

// A tetrahedron with a needle P A B of width w, cut by s1 in the middle of PA and s2 at a quarter
// of PB, without an edge from s1 to B. s1 is off PA by a share of w, away from PB: beyond 0.25 the
// chain of boundary edges that begins nearest to PA is that over s2, and PB is left without one.
Verdict verdict_on_needle(double w, double share, bool whole = true) {
  const Position p = {0, 0, 0}, a = {1, 0, 0}, b = {1, w, 0}, c = {0, 0, 1};
  const Polyhedron input = {
      {p, a, b, c}, {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}}, {}, {}};
  MeshFile mesh;
  mesh.vertices = {p, a, b, c, {0.5, -share * w, 0}, {0.25, 0.25 * w, 0}};
  mesh.tetrahedra = {{0, 4, 5, 3}, {4, 1, 5, 3}};
  if (whole) mesh.tetrahedra.push_back({1, 2, 5, 3});
  mesh.either_orientation = true;
  VerifyReport report;
  EXPECT_EQ(verify(input, mesh, nullptr, {.promised = {.planar = 0}}, report), "");
  return report.verdict;
}

TEST(FileAlone, IsNotJudgedWhereDoublesDoNotTellEdgesApart) {
  EXPECT_EQ(verdict_on_needle(0x1p-52, 0), Verdict::exact);
  EXPECT_EQ(verdict_on_needle(0x1p-20, 0), Verdict::exact);
  EXPECT_EQ(verdict_on_needle(0x1p-52, 0.35), Verdict::undecided);
  // At that distance doubles tell; and an error of another kind is an error there too.
  EXPECT_EQ(verdict_on_needle(0x1p-20, 0.35), Verdict::broken);
  EXPECT_EQ(verdict_on_needle(0x1p-52, 0.35, false), Verdict::broken);
}

// A square pyramid upside down. Its base has a facet as thin as a needle P A B. A vertex on PA and
// one on PB make its edges indistinguishable. Two vertices of the base are pushed in and out by as
// much, which changes no volume.
Verdict verdict_on_dented_base(double dent) {
  constexpr double kThin = 0x1p-52;
  const Polyhedron input = {{{0, 0, 0},
                             {1, 0, 0},
                             {1, kThin, 0},
                             {-1, -2, 0},
                             {2, -2, 0},
                             {2, 2, 0},
                             {-1, 2, 0},
                             {0.5, 0, -3}},
                            {{{0, 1, 2}},
                             {{0, 3, 1}},
                             {{3, 4, 1}},
                             {{4, 2, 1}},
                             {{4, 5, 2}},
                             {{5, 6, 2}},
                             {{6, 0, 2}},
                             {{6, 3, 0}},
                             {{3, 6, 7}},
                             {{4, 3, 7}},
                             {{5, 4, 7}},
                             {{6, 5, 7}}},
                            {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                            {}};
  MeshFile mesh;
  mesh.vertices = input.vertices;
  mesh.vertices.push_back({0.5, -0.35 * kThin, 0});
  mesh.vertices.push_back({0.25, 0.25 * kThin, 0});
  // In the triangles 3 4 1 and 5 6 2, of equal size.
  mesh.vertices.push_back({0.5, -1, dent});
  mesh.vertices.push_back({0.5, 1, -dent});
  // Seen from above: the needle without an edge from vertex 8 to B, and its surroundings.
  const std::vector<Face> base = {
      {0, 8, 9}, {8, 1, 9}, {1, 2, 9},  {0, 3, 8},  {3, 1, 8},  {3, 4, 10}, {4, 1, 10}, {1, 3, 10},
      {4, 2, 1}, {4, 5, 2}, {5, 6, 11}, {6, 2, 11}, {2, 5, 11}, {6, 0, 9},  {6, 9, 2},  {6, 3, 0}};
  for (const auto& [a, b, c] : base) mesh.tetrahedra.push_back({a, b, c, 7});
  mesh.either_orientation = true;
  VerifyReport report;
  EXPECT_EQ(verify(input, mesh, nullptr, {}, report), "");
  return report.verdict;
}

TEST(FileAlone, MayBeTurnedOverWhereTheFormatHasNoConvention) {
  const samples::Sample honest = samples::l_shape();
  for (const bool either : {true, false}) {
    MeshFile turned = honest.mesh;
    turned.either_orientation = either;
    for (Tet& tet : turned.tetrahedra) std::swap(tet[0], tet[1]);
    VerifyReport report;
    EXPECT_EQ(verify(honest.input, turned, nullptr, {}, report), "");
    EXPECT_EQ(report.verdict, either ? Verdict::exact : Verdict::broken) << to_text(report);
  }
}

TEST(FileAlone, IsNoExcuseForWhatIsFarFromTheSurface) {
  EXPECT_EQ(verdict_on_dented_base(0), Verdict::undecided);
  EXPECT_EQ(verdict_on_dented_base(0x1p-10), Verdict::broken);
  EXPECT_EQ(verdict_on_dented_base(0x1p-30), Verdict::broken);
}

// A tetrahedron of size `size` without a corner, which a facet of size `cut` cuts off. The smallest
// double keeps it from being verified in other units. Vertices are rounded on the large facet and
// on an edge of it; that of the small facet is at `spike`.
VerifyReport report_on_cut_corner(double size, double cut, const Position& spike) {
  const Polyhedron input = {
      {{size, 0, 0}, {0, size, 0}, {0, 0, size}, {cut, 0, 0x1p-1074}, {0, cut, 0}, {0, 0, cut}},
      {{{0, 1, 2}},
       {{3, 5, 4}},
       {{3, 1, 0}},
       {{3, 4, 1}},
       {{0, 2, 5}},
       {{0, 5, 3}},
       {{1, 4, 5}},
       {{1, 5, 2}}},
      {},
      {}};
  MeshFile mesh;
  mesh.vertices = input.vertices;
  mesh.vertices.push_back({size / 3, size / 3, size / 3});
  mesh.vertices.push_back(spike);
  mesh.vertices.push_back({size / 8, size / 8, size / 8});
  mesh.vertices.push_back({size / 3, size - size / 3, 0});
  std::vector<Face> faces = {{0, 9, 6}, {9, 1, 6}, {1, 2, 6}, {2, 0, 6}, {3, 5, 7},
                             {5, 4, 7}, {4, 3, 7}, {3, 1, 9}, {3, 9, 0}};
  faces.insert(faces.end(), input.triangles.begin() + 3, input.triangles.end());
  for (const auto& [a, b, c] : faces) mesh.tetrahedra.push_back({a, b, c, 8});
  mesh.either_orientation = true;
  VerifyReport report;
  EXPECT_EQ(verify(input, mesh, nullptr, {.promised = {.planar = 0}}, report), "");
  return report;
}

// Squares of such lengths are not doubles, and where some lengths are the smallest, others cannot
// be measured in other units.
TEST(FileAlone, IsMeasuredWhereSquaresAreNoDoubles) {
  const double s = 0x1p1000, t = 0x1p200;
  for (const double size : {1.0, 0x1p190, 0x1p300, s}) {
    const double cut = size * 0x1p-10;
    const VerifyReport report = report_on_cut_corner(size, cut, {cut / 4, cut / 4, cut / 2});
    EXPECT_EQ(report.verdict, Verdict::rounded) << to_text(report);
  }
  EXPECT_EQ(report_on_cut_corner(s, t, {t / 4, t / 4, t / 2}).verdict, Verdict::rounded);
  // Where the vertex of the small facet is far from it, that is a hollow as thin as a rounding of
  // others.
  const VerifyReport hollow = report_on_cut_corner(s, t, {s / 1024, s / 1024, s / 1024});
  ASSERT_NE(hollow.find("conformity"), nullptr);
  EXPECT_FALSE(hollow.find("conformity")->passed()) << to_text(hollow);
}

void expect_no_conformity(const Polyhedron& input, const MeshFile& mesh,
                          double declared_deviation) {
  VerifyReport report;
  VerifyOptions options{.promised = {.planar = 0}};
  options.declared_deviation = declared_deviation;
  EXPECT_EQ(verify(input, mesh, nullptr, options, report), "");
  EXPECT_EQ(report.verdict, Verdict::broken);
  EXPECT_FALSE(report.find("conformity")->passed()) << to_text(report);
}

// Two sheets in the plane of a facet, beyond it: as many faces turned over as faces that are not.
TEST(FileAlone, HasNoCrackInThePlaneOfAFacet) {
  samples::Sample l =
      samples::grid_sample(2, 4, [](int x, int y, int) { return x == 0 || y == 0; });
  MeshFile& mesh = l.mesh;
  mesh.boundary.clear();
  VerifyReport whole;
  EXPECT_EQ(verify(l.input, mesh, nullptr, {.promised = {.planar = 0}}, whole), "");
  EXPECT_EQ(whole.verdict, Verdict::exact);
  // Beyond the facet x = 1/2, y > 1/2; the vertices on the edge of the two facets as well.
  const auto is_cut = [](const Position& p) {
    return p[0] == 0.5 && p[1] > 0 && p[1] <= 0.5 && p[2] > 0 && p[2] < 1;
  };
  std::map<Index, Index> copies;
  for (Tet& tet : mesh.tetrahedra) {
    double x = 0;
    for (const Index v : tet) x += mesh.vertices[v][0] / 4;
    if (x < 0.5) continue;
    for (Index& v : tet) {
      if (!is_cut(mesh.vertices[v])) continue;
      const auto [at, fresh] = copies.try_emplace(v, static_cast<Index>(mesh.vertices.size()));
      if (fresh) mesh.vertices.push_back(Position(mesh.vertices[v]));
      v = at->second;
    }
  }
  ASSERT_EQ(copies.size(), 28U);
  expect_no_conformity(l.input, mesh, 0);
  expect_no_conformity(l.input, mesh, 0.01);
}

// A tetrahedron on a face, as thin as a rounding and of any length.
TEST(FileAlone, HasNoFinBesideAFacet) {
  const samples::Sample cube = samples::cube();
  for (const double reach : {0.3, 1.5, 3.0, 1e9}) {
    for (const double thickness : {0x1p-52, 1e-6}) {
      MeshFile mesh = cube.mesh;
      Face top{};
      for (const Face& face : cube.mesh.boundary) {
        const bool is_inner = std::ranges::all_of(face, [&](Index v) {
          const Position& p = mesh.vertices[v];
          return p[2] == 1 && p[0] < 1 && p[1] < 1;
        });
        if (is_inner) top = face;
      }
      ASSERT_NE(top[0], top[1]);
      mesh.boundary.clear();
      mesh.vertices.push_back({reach, 0.3, 1 + thickness});
      mesh.tetrahedra.push_back(
          {top[0], top[1], top[2], static_cast<Index>(mesh.vertices.size() - 1)});
      mesh.regions.resize(mesh.regions.empty() ? 0 : mesh.tetrahedra.size(), 1);
      mesh.either_orientation = true;
      SCOPED_TRACE(reach);
      expect_no_conformity(cube.input, mesh, 0);
      expect_no_conformity(cube.input, mesh, 1e-5);
    }
  }
}

// A cube around a point, with a face on top whose vertices are an ulp off: it is turned over, and
// every tetrahedron is positive. That is a deviation of about as much, whatever the tolerance.
TEST(FileAlone, MayHaveAFaceThatRoundingTurnedOver) {
  Polyhedron input{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      {{{0, 2, 1}},
       {{0, 3, 2}},
       {{0, 1, 5}},
       {{0, 5, 4}},
       {{1, 2, 6}},
       {{1, 6, 5}},
       {{2, 3, 7}},
       {{2, 7, 6}},
       {{3, 0, 4}},
       {{3, 4, 7}}},
      {},
      {}};
  std::vector<Face> faces(input.triangles.begin(), input.triangles.end());
  faces.insert(
      faces.end(),
      {{8, 9, 10}, {4, 5, 9}, {4, 9, 8}, {5, 6, 9}, {4, 8, 7}, {8, 10, 7}, {10, 9, 6}, {10, 6, 7}});
  MeshFile mesh;
  mesh.vertices = input.vertices;
  for (const Position& p : {Position{0.25, 0.5, 1}, Position{0.75, 0.5, 1},
                            Position{0.5, 0.5 - 0x1p-54, 1 + 0x1p-52}, Position{0.5, 0.9, 0.5}}) {
    mesh.vertices.push_back(p);
  }
  for (const auto& [a, b, c] : faces) mesh.tetrahedra.push_back({a, c, b, 11});
  input.triangles.push_back({4, 5, 6});
  input.triangles.push_back({4, 6, 7});
  VerifyReport report;
  EXPECT_EQ(verify(input, mesh, nullptr, {.promised = {.planar = 0}}, report), "");
  EXPECT_EQ(report.verdict, Verdict::rounded) << to_text(report);
  EXPECT_NE(to_text(report).find("1 faces folded over"), std::string::npos) << to_text(report);
}

// Tetrahedra outside are there to fill the hull, however small they are.
TEST(FileAlone, WhatIsOutsideFillsTheHull) {
  const samples::Sample cube = samples::cube();
  MeshFile mesh = cube.mesh;
  const auto is_on_top = [&mesh](const Face& face) {
    return std::ranges::all_of(face, [&](Index v) { return mesh.vertices[v][2] == 1; });
  };
  const Face top = *std::ranges::find_if(cube.mesh.boundary, is_on_top);
  mesh.boundary.clear();
  mesh.vertices.push_back({0.5, 0.5, 1 + 1e-6});
  mesh.tetrahedra.push_back({top[0], top[1], top[2], static_cast<Index>(mesh.vertices.size() - 1)});
  mesh.regions.assign(cube.mesh.tetrahedra.size(), 1);
  mesh.regions.push_back(2);
  mesh.either_orientation = true;
  VerifyReport report;
  EXPECT_EQ(verify(cube.input, mesh, nullptr, {.promised = {.planar = 0}}, report), "");
  ASSERT_NE(report.find("hull"), nullptr) << to_text(report);
  EXPECT_FALSE(report.find("hull")->passed()) << to_text(report);
}

// The faces of one tetrahedron, with the label of each input triangle in its plane.
samples::Sample labelled_cube() {
  samples::Sample cube = samples::cube();
  cube.input.labels.clear();
  for (std::size_t t = 0; t < cube.input.triangles.size(); ++t) {
    cube.input.labels.push_back(7);
  }
  cube.input.labels[0] = cube.input.labels[1] = 8;
  cube.mesh.lists_boundary = true;
  cube.mesh.labels.clear();
  return cube;
}

TEST(FileAlone, ListsTrianglesWhereTheInputHasLabels) {
  samples::Sample sample = labelled_cube();
  sample.mesh.boundary.clear();
  VerifyReport report;
  EXPECT_EQ(verify(sample.input, sample.mesh, nullptr, {}, report), "");
  ASSERT_NE(report.find("boundary-list"), nullptr);
  EXPECT_EQ(report.verdict, Verdict::broken);
  const auto judged = [&] {
    EXPECT_EQ(verify(sample.input, sample.mesh, nullptr, {}, report), "");
    EXPECT_EQ(report.verdict, Verdict::exact) << to_text(report);
    return report.unproven;
  };
  const std::vector<std::string> lost = {"labels of the input (the file has none)"};
  sample.mesh.lists_boundary = false;  // the format cannot
  EXPECT_EQ(judged(), lost);
  sample.mesh.boundary = samples::cube().mesh.boundary;  // nor give them labels
  sample.mesh.facets.clear();
  EXPECT_EQ(judged(), lost);
  sample.mesh.boundary.clear();
  sample.mesh.lists_boundary = true;
  for (auto& label : sample.input.labels) label = 7;  // says nothing
  EXPECT_EQ(judged(), std::vector<std::string>{});
}

TEST(FileAlone, ListsTrianglesThatLookOutwards) {
  samples::Sample sample = samples::l_shape();
  std::map<Face, std::pair<int, Face>> faces;
  for (const Tet& tet : sample.mesh.tetrahedra) {
    for (int i = 0; i < 4; ++i) {
      Face face = face_of(tet, i), key = face;
      sort_face(key);
      auto& [count, seen] = faces.try_emplace(key, 0, face).first->second;
      ++count;
    }
  }
  sample.mesh.boundary.clear();
  sample.mesh.labels.clear();
  sample.mesh.facets.clear();
  for (const auto& [key, face] : faces) {
    if (face.first == 1) sample.mesh.boundary.push_back(face.second);
  }
  for (const bool inwards : {false, true}) {
    for (const bool either : {false, true}) {
      MeshFile mesh = sample.mesh;
      mesh.either_orientation = either;
      for (Face& face : mesh.boundary) {
        if (inwards) std::swap(face[1], face[2]);
      }
      VerifyReport report;
      EXPECT_EQ(verify(sample.input, mesh, nullptr, {}, report), "");
      // Other programs promise no orientation of what they list, but the first line tells.
      EXPECT_EQ(report.verdict, Verdict::exact) << to_text(report);
      ASSERT_EQ(report.unproven.size(), inwards ? 1U : 0U) << to_text(report);
      if (!inwards) continue;
      EXPECT_EQ(report.find("boundary-list")->figure(kTurned), mesh.boundary.size());
      std::swap(mesh.boundary[0][1], mesh.boundary[0][2]);
      EXPECT_EQ(verify(sample.input, mesh, nullptr, {}, report), "");
      EXPECT_EQ(report.find("boundary-list")->figure(kTurned), mesh.boundary.size() - 1);
    }
  }
}

// A cube that is moved, beside one so far away that the doubles there are units apart.
VerifyReport report_on_moved_cube(double by) {
  samples::Sample cube = samples::cube();
  const auto inputs = static_cast<Index>(cube.input.vertices.size()),
             vertices = static_cast<Index>(cube.mesh.vertices.size());
  const auto add_far = [](std::vector<Position>& list, std::size_t count) {
    for (std::size_t v = 0; v < count; ++v) {
      list.push_back({0x1p52 + 8 * list[v][0], 8 * list[v][1], 8 * list[v][2]});
    }
  };
  add_far(cube.input.vertices, inputs);
  add_far(cube.mesh.vertices, vertices);
  for (std::size_t t = 0, count = cube.input.triangles.size(); t < count; ++t) {
    const auto [a, b, c] = cube.input.triangles[t];
    cube.input.triangles.push_back({a + inputs, b + inputs, c + inputs});
  }
  for (std::size_t t = 0, count = cube.mesh.tetrahedra.size(); t < count; ++t) {
    const auto [a, b, c, d] = cube.mesh.tetrahedra[t];
    cube.mesh.tetrahedra.push_back({a + vertices, b + vertices, c + vertices, d + vertices});
  }
  cube.mesh.regions.clear();
  cube.mesh.boundary.clear();
  cube.mesh.labels.clear();
  cube.mesh.facets.clear();
  for (std::size_t v = 0; v < vertices; ++v) cube.mesh.vertices[v][0] += by;
  VerifyReport report;
  EXPECT_EQ(verify(cube.input, cube.mesh, nullptr, {}, report), "");
  return report;
}

TEST(FileAlone, IsRoundedWhereItIsAndNotWhereItIsLargest) {
  EXPECT_EQ(report_on_moved_cube(0).verdict, Verdict::exact);
  const VerifyReport rounded = report_on_moved_cube(3 * 0x1p-52);
  EXPECT_EQ(rounded.verdict, Verdict::rounded) << to_text(rounded);
  EXPECT_NEAR(rounded.deviation_ulps, 3, 1e-9);
  for (const double by : {5 * 0x1p-52, 0x1p-30}) {
    const VerifyReport report = report_on_moved_cube(by);
    EXPECT_EQ(report.verdict, Verdict::deviating) << to_text(report);
    EXPECT_NEAR(report.deviation_ulps, by * 0x1p52, by * 0x1p32);
  }
  // Less than 4 ulp of the largest coordinate.
  EXPECT_EQ(report_on_moved_cube(3.9).verdict, Verdict::broken);
}

// Whichever triangle is the last one.
TEST(FileAlone, IsRoundedByItsSmallestFacetInAnyOrder) {
  Polyhedron input = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0x1p20}},
                      {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}},
                      {},
                      {}};
  MeshFile mesh;
  mesh.vertices = input.vertices;
  mesh.vertices[0][0] = -3 * 0x1p-52;  // in ulp of the base; far below one of the others
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.either_orientation = true;
  for (int turn = 0; turn < 4; ++turn) {
    VerifyReport report;
    EXPECT_EQ(verify(input, mesh, nullptr, {.promised = {.planar = 0}}, report), "");
    EXPECT_NEAR(report.deviation_ulps, 3, 1e-9) << turn << to_text(report);
    std::rotate(input.triangles.begin(), input.triangles.begin() + 1, input.triangles.end());
  }
}

TEST(FileAlone, HasNodesInTheMiddleOfEachEdgeWhereThisIs) {
  MeshFile mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0x1p52, 0, 0}, {0x1p52 + 8, 0, 0}};
  const auto judged = [&](double near, double far, double given) {
    mesh.edge_nodes = {{{0, 1}, {0.5 + near, 0, 0}}, {{2, 3}, {0x1p52 + 4 + far, 0, 0}}};
    return check_edge_nodes(mesh, 0, given).violations;
  };
  EXPECT_EQ(judged(4 * 0x1p-52, 4, 0), 0U);
  EXPECT_EQ(judged(5 * 0x1p-52, 4, 0), 1U);
  EXPECT_EQ(judged(0, 5, 0), 1U);
  EXPECT_EQ(judged(4 * 0x1p-42, 4, 1024), 0U);  // as given, where both are moved
}

TEST(FileAlone, SaysFirstWhatItDoesNotShow) {
  samples::Sample cube = samples::cube();
  const auto judged = [&](const char* promise) {
    VerifyReport report;
    VerifyOptions options;
    EXPECT_EQ(parse_promise(promise, options.promised), "");
    EXPECT_EQ(verify(cube.input, cube.mesh, nullptr, options, report), "");
    return report;
  };
  EXPECT_EQ(judged("mesh").unproven, std::vector<std::string>{});
  EXPECT_EQ(judged("mesh --max-edge 10").unproven, std::vector<std::string>{});
  EXPECT_EQ(judged("mesh --max-edge 10").verdict, Verdict::exact);
  const VerifyReport all = judged("mesh --delta 10 --tau 0.1 --gabriel --chamfer-radius 1");
  EXPECT_EQ(all.unproven,
            (std::vector<std::string>{"--delta", "--tau", "--gabriel", "--chamfer-radius"}));
  const std::string text = to_text(all);
  EXPECT_TRUE(text.starts_with("verdict: exact, of the mesh as written alone; not proven: --delta"))
      << text;
  EXPECT_NE(to_json(all).find("\"unproven\""), std::string::npos);
  EXPECT_EQ(judged("mesh --surface split").unproven, std::vector<std::string>{"--surface split"});
  EXPECT_EQ(judged("mesh --names set.txt").unproven, std::vector<std::string>{"--names"});
  EXPECT_EQ(judged("mesh --order 2").verdict, Verdict::broken);
  cube.mesh.has_second_order = false;
  EXPECT_EQ(judged("mesh --order 2").unproven, std::vector<std::string>{kLinearOnly});
  EXPECT_EQ(judged("mesh --order 2").verdict, Verdict::exact);
  const VerifyReport longer = judged("mesh --max-edge 0.1");
  EXPECT_EQ(longer.verdict, Verdict::undecided);
  ASSERT_EQ(longer.unproven.size(), 1U);
  EXPECT_TRUE(longer.unproven[0].starts_with("--max-edge (")) << longer.unproven[0];
}

// The constrained tetrahedrization of the hull is no larger than that.
TEST(FileAlone, FillsTheHullOfTheInput) {
  for (const bool larger : {false, true}) {
    samples::Sample sample = samples::cube_in_hull();
    if (!larger) sample = samples::cube();
    VerifyReport report;
    VerifyOptions options;
    EXPECT_EQ(parse_promise("cdt", options.promised), "");
    EXPECT_EQ(verify(sample.input, sample.mesh, nullptr, options, report), "");
    ASSERT_NE(report.find("hull"), nullptr) << to_text(report);
    EXPECT_EQ(report.find("hull")->passed(), !larger) << to_text(report);
  }
}

// A cube has six faces, twelve edges and eight corners, however it is triangulated.
TEST(FileAlone, IsComparedWithTheWholeSurface) {
  const samples::Sample cube = samples::cube();
  VerifyReport report;
  EXPECT_EQ(verify(cube.input, cube.mesh, nullptr, {}, report), "");
  const OracleReport* conformity = report.find("conformity");
  ASSERT_NE(conformity, nullptr);
  const std::map<std::string, double> figures(conformity->figures.begin(),
                                              conformity->figures.end());
  EXPECT_EQ(figures.at("facets"), 6);
  EXPECT_EQ(figures.at("edges"), 12);
  EXPECT_EQ(figures.at("input vertices"), 8);
}

TEST(FileAlone, HasNoMoreVerticesThanWerePromised) {
  const samples::Sample cube = samples::cube();
  const auto report_on = [&cube](std::size_t vertices) {
    VerifyReport report;
    const Promise promise{.max_vertices = static_cast<double>(vertices)};
    EXPECT_EQ(verify(cube.input, cube.mesh, nullptr, {.promised = promise}, report), "");
    return report;
  };
  EXPECT_EQ(report_on(cube.mesh.vertices.size()).verdict, Verdict::exact);
  const VerifyReport report = report_on(cube.mesh.vertices.size() - 1);
  EXPECT_EQ(report.verdict, Verdict::broken);
  ASSERT_NE(report.find("promise"), nullptr);
  EXPECT_FALSE(report.find("promise")->passed()) << to_text(report);
}

// The inside of a refined mesh may be empty; a mesh may not.
TEST(Complex, NamesVerticesAsTheFileDoes) {
  TetComplex complex;
  complex.tetrahedra = {{3, 4, 5, 9}};
  complex.first_vertex = 3;
  EXPECT_EQ(complex.vertex_name(2), "input vertex 2");
  EXPECT_EQ(complex.vertex_name(3), "vertex 0");
  EXPECT_EQ(complex.vertex_name(9), "vertex 6");
  EXPECT_EQ(complex.tet_name(0), "tetrahedron 0 (0 1 2 6)");
}

TEST(Complex, OnlyAPartMayBeEmpty) {
  TetComplex complex;
  const ExactPoints none;
  complex.points = &none;
  Neighbours neighbours;
  EXPECT_EQ(check_complex(complex, neighbours, true).violations, 0U);
  const OracleReport report = check_complex(complex, neighbours);
  EXPECT_EQ(report.violations, 1U);
  EXPECT_EQ(report.findings, std::vector<std::string>{"there are no tetrahedra"});
}

// Of a solid that is not convex, the mesh of the solid is not that of its hull.
TEST(FileAlone, IsHeldToTheRegionThatWasPromised) {
  for (const Task task : {Task::mesh, Task::cdt}) {
    const auto verdict_on = [task](const samples::Sample& sample) {
      VerifyReport report;
      Promise promise{.task = task, .region = delmesher::Region::hull};
      EXPECT_EQ(verify(sample.input, sample.mesh, nullptr, {.promised = promise}, report), "");
      return report;
    };
    EXPECT_EQ(verdict_on(samples::cube()).verdict, Verdict::exact);
    // The hull of `mesh` is that of a box, that of `cdt` the input's.
    EXPECT_EQ(verdict_on(samples::cube_in_hull()).verdict,
              task == Task::mesh ? Verdict::exact : Verdict::broken);
    const VerifyReport solid = verdict_on(samples::l_shape());
    EXPECT_EQ(solid.verdict, Verdict::broken);
    ASSERT_NE(solid.find("hull"), nullptr);
    EXPECT_FALSE(solid.find("hull")->passed()) << to_text(solid);
  }
}

}  // namespace
}  // namespace tetproof
