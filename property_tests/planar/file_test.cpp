// Which triangles count as one planar facet when a file is judged: what was promised decides, and a
// record that says more does not help.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "property_tests/planar/runs.h"

namespace tetproof::planar {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactRecord;
using delmesher::Surface;

// The mesh bends the box at its waist, so that edges between its walls are missing. United, the
// walls around the box would be one facet, whose normals cancel: none at all.
TEST(PlanarFile, WallsAroundABoxAreNoFacet) {
  samples::Sample stretched = samples::cube();
  const auto stretch = [](std::vector<Position>& vertices) {
    for (Position& p : vertices) p[2] *= 4;
  };
  stretch(stretched.input.vertices);
  stretch(stretched.mesh.vertices);
  samples::Sample bent = stretched;
  for (Position& p : bent.mesh.vertices) {
    if (p[2] == 2) p[0] += 0.125;
  }
  VerifyReport report;
  ASSERT_EQ(verify(stretched.input, stretched.mesh, nullptr, {}, report), "");
  EXPECT_EQ(report.verdict, Verdict::exact) << to_text(report);
  ASSERT_EQ(verify(bent.input, bent.mesh, nullptr, {.promised = {.planar = Promise::kPlanarAuto}},
                   report),
            "");
  EXPECT_EQ(report.verdict, Verdict::broken) << to_text(report);
}

// A vertex inside a face is 1e-6 off its plane. No planar facet explains that, since the face is
// planar as given: it is a deviation.
TEST(PlanarFile, AVertexOffItsFacetIsNoPlanarFacet) {
  samples::Sample sample = samples::cube();
  for (Position& p : sample.mesh.vertices) {
    if (p == Position{0.5, 0.5, 1}) p[2] += 1e-6;
  }
  VerifyReport report;
  const VerifyOptions options{.promised = {.planar = Promise::kPlanarAuto}};
  ASSERT_EQ(verify(sample.input, sample.mesh, nullptr, options, report), "");
  EXPECT_EQ(report.verdict, Verdict::deviating);
  EXPECT_TRUE(failed(report, options));
}

// One corner is off its faces by the smallest double, and heights times areas are too small for
// doubles. That is a deviation all the same, and the volume may differ.
TEST(PlanarFile, DeviationsOfTheSmallestDoubleAreSome) {
  Surface box = samples::to_surface(samples::cube().input);
  for (auto& p : box.vertices) {
    for (double& x : p) x *= 0x1p-64;
  }
  *std::ranges::find(box.vertices.front(), 0) = 0x1p-1074;
  for (const double planar : {delmesher::kPlanarAuto, 0.0}) {
    const Told told = run_of(box, planar);
    for (const bool with_record : {false, true}) {
      const VerifyReport report = verdict_on(told, with_record);
      EXPECT_FALSE(failed(report, {.promised = told.promise})) << to_text(report);
    }
  }
}

// A box with all faces bent along their diagonals.
Surface bent_box() {
  Surface box = samples::to_surface(samples::cube().input);
  std::mt19937 random(5);
  for (auto& p : box.vertices) {
    for (double& x : p) x += static_cast<double>(random() % 1024) * 0x1p-36;
  }
  return box;
}

// The same beside a box whose faces are planar within a slab: theirs does not hold this one.
TEST(PlanarFile, ASlabHoldsNoVertexOfAnotherFacet) {
  Told told = run_of(bent_box());
  const samples::Sample cube = samples::cube();
  auto& [input, mesh] = told.sample;
  const auto before = static_cast<Index>(input.vertices.size()),
             written = static_cast<Index>(mesh.vertices.size());
  for (const Position& p : cube.input.vertices) input.vertices.push_back({p[0] + 2, p[1], p[2]});
  for (const Position& p : cube.mesh.vertices) mesh.vertices.push_back({p[0] + 2, p[1], p[2]});
  for (const auto& [a, b, c] : cube.input.triangles) {
    input.triangles.push_back({a + before, b + before, c + before});
  }
  for (Tet tet : cube.mesh.tetrahedra) {
    for (Index& v : tet) v += written;
    mesh.tetrahedra.push_back(tet);
  }
  mesh.regions.assign(mesh.tetrahedra.size(), 1);
  mesh.boundary.clear();
  mesh.labels.clear();
  mesh.facets.clear();
  const VerifyReport good = verdict_on(told, false);
  EXPECT_GT(good.slab, 1e-9) << to_text(good);
  EXPECT_FALSE(failed(good, {.promised = told.promise})) << to_text(good);
  for (Position& p : mesh.vertices) {
    if (p == Position{2.5, 0.5, 1}) p[2] += good.slab / 2;
  }
  const VerifyReport report = verdict_on(told, false);
  EXPECT_TRUE(failed(report, {.promised = told.promise})) << to_text(report);
}

// Two triangles are one facet wherever the mesh has the other diagonal.
TEST(PlanarFile, FacetsThatWereUnitedAreCounted) {
  const Surface box = bent_box();
  ASSERT_EQ(box.triangles.size(), 12U);
  const Told told = run_of(box);
  ASSERT_EQ(told.statistics.given_facets, 12U);
  ASSERT_EQ(told.sample.mesh.vertices.size(), 8U);
  std::set<std::pair<std::uint32_t, std::uint32_t>> missing;
  for (const auto& [a, b, c] : box.triangles) {
    for (const auto& edge : {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)}) {
      missing.emplace(edge.first, edge.second);
    }
  }
  for (const auto& t : told.sample.mesh.tetrahedra) {
    for (const std::uint32_t a : t) {
      for (const std::uint32_t b : t) missing.erase({a, b});
    }
  }
  ASSERT_FALSE(missing.empty());
  const VerifyReport report = verdict_on(told, false);
  const OracleReport* conformity = report.find("conformity");
  ASSERT_NE(conformity, nullptr);
  EXPECT_TRUE(std::ranges::any_of(conformity->figures, [&](const auto& figure) {
    return figure.first == "facets united" && figure.second == static_cast<double>(missing.size());
  })) << to_text(report);
}

// A plate of the width 2 and the length 4 whose top has a ridge along the middle.
Surface ridge(double height) {
  Surface s;
  for (const double y : {0.0, 4.0}) {
    for (const auto& [x, z] :
         {std::pair(-1.0, 0.0), {1.0, 0.0}, {1.0, 1.0}, {0.0, 1 + height}, {-1.0, 1.0}}) {
      s.vertices.push_back({x, y, z});
    }
  }
  for (std::uint32_t i = 0; i < 5; ++i) {
    const std::uint32_t j = (i + 1) % 5;
    s.triangles.push_back({i, j + 5, j});
    s.triangles.push_back({i, i + 5, j + 5});
  }
  for (std::uint32_t i = 1; i < 4; ++i) {
    s.triangles.push_back({0, i, i + 1});
    s.triangles.push_back({5, i + 6, i + 5});
  }
  return s;
}

// Rounded to few decimals after it was rotated, so that `auto` needs more than without evidence.
const Told& noisy() {
  static const Told told =
      run_of(rotated(stairs(), [](double x) { return std::round(x * 3e4) / 3e4; }));
  return told;
}

// As the file states its number, it is judged by that; stated too small, the facets deviate by
// more.
TEST(PlanarFile, FacetsDeviateByNoMoreThanTheFileStates) {
  Told told = noisy();
  const double stated = told.sample.mesh.planar_within;
  ASSERT_GT(stated, 4 * Promise::kAutomatic);
  const VerifyReport good = verdict_on(told, false);
  EXPECT_EQ(good.verdict, Verdict::deviating);
  EXPECT_FALSE(failed(good, {.promised = told.promise})) << to_text(good);
  ASSERT_NE(good.find("conformity")->figure("slab over diagonal"), std::nullopt);
  const double slab = *good.find("conformity")->figure("slab over diagonal");
  EXPECT_GT(slab, Promise::kAutomatic);
  EXPECT_LE(slab, stated);
  told.sample.mesh.planar_within = slab * (1 - 1e-6);
  const VerifyReport report = verdict_on(told, false);
  EXPECT_FALSE(report.find("conformity")->passed()) << to_text(report);
}

TEST(PlanarFile, AFileStatesNoMoreThanAutoMay) {
  Told told = noisy();
  told.sample.mesh.planar_within = 1.01 * Promise::kMostAutomatic;
  const VerifyReport above = verdict_on(told, false);
  EXPECT_FALSE(above.find("promise")->passed()) << to_text(above);
  told.sample.mesh.planar_within = Promise::kMostAutomatic;
  const VerifyReport most = verdict_on(told, false);
  EXPECT_FALSE(failed(most, {.promised = told.promise})) << to_text(most);
  told.promise.planar = noisy().sample.mesh.planar_within;
  EXPECT_FALSE(verdict_on(told, false).find("promise")->passed());
}

// If nothing states the number, the slab is measured all the same. It fails above what `auto` does
// without evidence, unless the caller allows it.
TEST(PlanarFile, TheSlabIsMeasuredWhereNothingStatesIt) {
  Told told = noisy();
  const VerifyReport stated = verdict_on(told, false);
  told.sample.mesh.planar_within = 0;
  const VerifyReport report = verdict_on(told, false);
  EXPECT_EQ(report.verdict, Verdict::deviating);
  EXPECT_EQ(report.slab, stated.slab);
  EXPECT_TRUE(failed(report, {.promised = told.promise})) << to_text(report);
  EXPECT_FALSE(failed(report, {.promised = told.promise, .declared_deviation = 1e-4}));
  told.promise.planar = 1e-4;
  const VerifyReport promised = verdict_on(told, false);
  EXPECT_FALSE(failed(promised, {.promised = told.promise})) << to_text(promised);
}

// Not without an end.
TEST(PlanarFile, NoSlabIsWiderThanTheMostThatAutoMayState) {
  Told told = run_of(ridge(1e-2), 1e-2);
  ASSERT_GT(told.statistics.planar_groups, 0U);
  EXPECT_FALSE(failed(verdict_on(told, false), {.promised = told.promise}));
  told.promise.planar = Promise::kPlanarAuto;
  told.sample.mesh.planar_within = 0;
  const VerifyReport report = verdict_on(told, false);
  EXPECT_FALSE(report.find("conformity")->passed()) << to_text(report);
}

// Far from the origin, where roundings are larger than any share of the size that other tolerances
// begin with: a face is bent, and a vertex on an edge of another one is `ulps` off.
VerifyReport report_on_rounded_edge(double ulps) {
  samples::Sample sample = samples::cube();
  constexpr double kAway = 8192;
  for (auto* vertices : {&sample.input.vertices, &sample.mesh.vertices}) {
    for (Position& p : *vertices) {
      const bool rounded = p == Position{0.5, 0, 1};
      const double bend = p[2] == 1 ? p[0] * p[1] * 0x1p-30 : 0;
      for (double& x : p) x += kAway;
      p[2] += bend;
      if (rounded) p[1] += ulps * 0x1p-39;
    }
  }
  VerifyReport report;
  EXPECT_EQ(verify(sample.input, sample.mesh, nullptr, {.promised = {.planar = 1e-6}}, report), "");
  return report;
}

TEST(PlanarFile, EdgesMayBeRoundedBesidePlanarFacets) {
  for (const double ulps : {0.0, 1.0, 3.0, 4.0}) {
    const VerifyReport report = report_on_rounded_edge(ulps);
    EXPECT_FALSE(failed(report, {.promised = {.planar = 1e-6}})) << to_text(report);
    EXPECT_GT(report.slab, 0);
  }
  const VerifyReport off = report_on_rounded_edge(6);
  EXPECT_TRUE(failed(off, {.promised = {.planar = 1e-6}})) << to_text(off);
}

// A needle of this width along the front edge of a box's top. The mesh has it in the front, whose
// upper side is bent for that.
VerifyReport report_on_needle(double width) {
  MeshFile mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},       {0, 0, 1},
                   {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5, width, 1}, {0.5, 0.5, 0.5}};
  std::vector<Face> faces = {{0, 2, 1}, {1, 2, 3}, {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6},
                             {1, 3, 5}, {3, 7, 5}, {4, 8, 6}, {8, 5, 7}, {8, 7, 6}};
  Polyhedron input{mesh.vertices, faces, {}, {}};
  input.vertices.pop_back();
  input.triangles.insert(input.triangles.end(), {{0, 1, 5}, {0, 5, 4}, {4, 5, 8}});
  faces.insert(faces.end(), {{0, 1, 8}, {0, 8, 4}, {1, 5, 8}});
  for (const auto& [a, b, c] : faces) mesh.tetrahedra.push_back({a, b, c, 9});
  mesh.either_orientation = true;
  VerifyReport report;
  EXPECT_EQ(verify(input, mesh, nullptr, {.promised = {.planar = 1e-3}}, report), "");
  return report;
}

TEST(PlanarFile, ANeedleIsInThePlaneOfEitherSide) {
  const VerifyOptions options{.promised = {.planar = 1e-3}};
  for (const double width : {0x1p-10, 0x1p-14, 0x1p-30}) {
    const VerifyReport report = report_on_needle(width);
    EXPECT_FALSE(failed(report, options)) << to_text(report);
    EXPECT_EQ(report.verdict, Verdict::deviating) << to_text(report);
  }
  for (const double width : {0x1p-8, 0x1p-4}) {
    EXPECT_TRUE(failed(report_on_needle(width), options));
  }
}

// The same with a fan of needles, each beside the one before, around one end of the front edge of a
// box's top.
VerifyReport report_on_fan(int needles, double width) {
  MeshFile mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                   {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  std::vector<Face> faces = {{0, 2, 1}, {1, 2, 3}, {2, 6, 3}, {3, 6, 7}, {0, 4, 2},
                             {2, 4, 6}, {1, 3, 5}, {3, 7, 5}, {6, 5, 7}};
  std::vector<Face> as_given = {{0, 1, 5}, {0, 5, 4}};
  faces.push_back({0, 1, 5});
  Index last = 5;
  for (int i = 1; i <= needles; ++i) {
    const auto next = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.push_back({1 - i / (needles + 1.0), i * width / needles, 1});
    as_given.push_back({4, last, next});
    faces.push_back({0, last, next});
    as_given.push_back({6, next, last});
    faces.push_back({6, next, last});
    last = next;
  }
  as_given.push_back({6, 4, last});
  faces.insert(faces.end(), {{6, 4, last}, {0, last, 4}});
  as_given.insert(as_given.end(), faces.begin(), faces.begin() + 9);
  const Polyhedron input{mesh.vertices, as_given, {}, {}};
  const auto middle = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.push_back({0.5, 0.5, 0.5});
  for (const auto& [a, b, c] : faces) mesh.tetrahedra.push_back({a, b, c, middle});
  mesh.either_orientation = true;
  VerifyReport report;
  EXPECT_EQ(verify(input, mesh, nullptr, {.promised = {.planar = 1e-3}}, report), "");
  return report;
}

TEST(PlanarFile, NeedlesBesideNeedlesAreInThePlaneOfEitherSide) {
  const VerifyOptions options{.promised = {.planar = 1e-3}};
  for (const int needles : {1, 4, 5, 6, 40}) {
    const VerifyReport report = report_on_fan(needles, 0x1p-10);
    EXPECT_FALSE(failed(report, options)) << to_text(report);
    EXPECT_EQ(report.verdict, Verdict::deviating) << needles << " needles";
    // Each is no wider than the bound, all together are.
    EXPECT_TRUE(failed(report_on_fan(needles, 0x1p-8), options)) << needles << " needles";
  }
}

// A ridge that the mesh does not have, in a file without record: the promise decides.
TEST(PlanarFile, ARidgeAboveTheBoundIsMissed) {
  Told told = run_of(ridge(1e-3), 1e-3);
  ASSERT_GT(told.statistics.planar_groups, 0U);
  const VerifyReport good = verdict_on(told, false);
  EXPECT_FALSE(failed(good, {.promised = told.promise})) << to_text(good);
  EXPECT_EQ(good.verdict, Verdict::deviating);
  EXPECT_GE(good.deviation, 4e-4);
  told.promise.planar = 1e-5;
  const VerifyReport report = verdict_on(told, false);
  EXPECT_TRUE(failed(report, {.promised = told.promise})) << to_text(report);
  // Nor does it help that a record names the two sides of the ridge as one facet.
  const VerifyReport named = verdict_on(told, true);
  ASSERT_NE(named.find("conformity"), nullptr);
  EXPECT_FALSE(named.find("conformity")->passed()) << to_text(named);
}

// A ridge that the mesh has elsewhere is off the surface, though a record names all triangles as
// one facet.
TEST(PlanarFile, ARecordMakesNoFacetOfABody) {
  Told told = run_of(ridge(1e-3), 0);
  ASSERT_TRUE(samples::exact_or_rounded(verdict_on(told)));
  for (Position& p : told.sample.mesh.vertices) {
    if (p[2] == 1 + 1e-3 && p[1] > 0) p[0] += 1e-3;
  }
  ExactRecord::Facet all = told.record.facets.front();
  for (const ExactRecord::Facet& facet : told.record.facets) {
    if (facet.id == all.id) continue;
    all.triangles.insert(all.triangles.end(), facet.triangles.begin(), facet.triangles.end());
  }
  told.record.facets = {all};
  told.promise.planar = 0.01;
  const VerifyReport report = verdict_on(told);
  EXPECT_EQ(report.slab, 0);
  EXPECT_TRUE(failed(report, {.promised = told.promise}));
}

}  // namespace
}  // namespace tetproof::planar
