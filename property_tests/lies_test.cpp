// Lies about a run: promises laxer than asked; sections of the record swapped, emptied, duplicated,
// cut short, out of date; records and files of other runs; changes of mesh and record together, so
// that both agree; false local operations. Each must be caught by the oracle meant for it. At the
// end they are printed as a table.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <utility>

#include "property_tests/lies/told.h"
#include "property_tests/score_table.h"

namespace tetproof {
namespace {

using namespace lies;     // NOLINT
using namespace oracles;  // NOLINT
using delmesher::ExactPoint;
using delmesher::ExactRecord;
using delmesher::Options;

class Lies : public testing::TestWithParam<Lie> {};

TEST_P(Lies, AreCaughtByTheOracleMeantForThem) {
  Told told = honest();
  const auto verdict = [](const Told& t) {
    VerifyReport report;
    EXPECT_EQ(verify(t.sample.input, t.sample.mesh, &t.record,
                     {.stage = t.promise.approximate         ? Stage::refined
                               : t.promise.task == Task::cdt ? Stage::final
                                                             : Stage::both,
                      .promised = t.promise,
                      .record_version = t.version},
                     report),
              "");
    return report;
  };
  static const VerifyReport good = verdict(told);
  ASSERT_TRUE(samples::exact_or_rounded(good)) << to_text(good);
  GetParam().tell(told);
  judge("wedge and slab", GetParam().name, GetParam().oracle, verdict(told), GetParam().before);
}

INSTANTIATE_TEST_SUITE_P(Relaxed, Lies, testing::ValuesIn(relaxed()), test_name<Lie>);
INSTANTIATE_TEST_SUITE_P(Sections, Lies, testing::ValuesIn(sections()), test_name<Lie>);
INSTANTIATE_TEST_SUITE_P(Foreign, Lies, testing::ValuesIn(foreign()), test_name<Lie>);
INSTANTIATE_TEST_SUITE_P(Consistent, Lies, testing::ValuesIn(consistent()), test_name<Lie>);
INSTANTIATE_TEST_SUITE_P(Improved, Lies, testing::ValuesIn(improved()), test_name<Lie>);
INSTANTIATE_TEST_SUITE_P(Kept, Lies, testing::ValuesIn(kept()), test_name<Lie>);

VerifyReport verdict_on(const Told& told) {
  VerifyReport report;
  EXPECT_EQ(verify(told.sample.input, told.sample.mesh, &told.record,
                   {.stage = Stage::both, .promised = told.promise}, report),
            "");
  return report;
}

std::map<std::string, double> figures_of(const VerifyReport& report, const std::string& oracle) {
  const OracleReport* found = report.find(oracle);
  EXPECT_NE(found, nullptr) << oracle;
  if (found == nullptr) return {};
  return {found->figures.begin(), found->figures.end()};
}

// What the record says and nobody can decide stands in the first line.
TEST(Truths, SayFirstWhatIsTrusted) {
  Options options;
  options.want_exact = true;
  options.surface = delmesher::SurfaceChoice::keep;
  Told kept = run_of(options);
  EXPECT_EQ(verdict_on(kept).unproven, std::vector<std::string>{});
  kept.promise = promise_of(Options{});
  EXPECT_EQ(verdict_on(kept).unproven,
            std::vector<std::string>{"that bounded angles were too heavy (the surface is kept)"});
  Told split = honest();
  EXPECT_EQ(verdict_on(split).unproven, std::vector<std::string>{});
  split.promise.delta = 25;
  split.promise.names = true;
  EXPECT_EQ(verdict_on(split).unproven,
            (std::vector<std::string>{"--delta above 14.4775 degrees", "--names"}));
}

// The figures of an honest run, apart from that it passes.
TEST(Truths, FiguresAreThoseOfTheRun) {
  const ExactRecord& r = honest().record;
  const VerifyReport report = verdict_on(honest());
  // The largest coordinate is 3, that of some facets less.
  EXPECT_GT(report.deviation, 0);
  EXPECT_GE(report.deviation_ulps, report.deviation / 0x1p-51);
  EXPECT_LE(report.deviation_ulps, 4);
  std::set<Index> refined, created;
  for (const auto& tet : r.refined) refined.insert(tet.vertices.begin(), tet.vertices.end());
  for (const auto& tet : r.unrepaired.empty() ? r.final : r.unrepaired) {
    for (const Index v : tet.vertices) {
      if (v >= honest().sample.input.vertices.size() && !refined.contains(v)) created.insert(v);
    }
  }
  EXPECT_EQ(figures_of(report, "enrichment").at("new on the surface"),
            static_cast<double>(created.size()));
}

// Chamfers that obey a bound pass.
TEST(Truths, ChamfersWithinTheirBoundPass) {
  Options options = honest_options();
  options.chamfer_radius = 0x1p-5;
  const Told told = run_of(options);
  EXPECT_FALSE(told.record.chamfer_points.empty());
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
}

// One side goes, for a gap that is long and no wider than the tolerance.
TEST(Truths, AFacetMayGoForItsChamfers) {
  Told told = honest();
  dagger(told);
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
  EXPECT_EQ(figures_of(report, "refined-filter").at("dropped for what chamfering made of them"), 1);
}

// A refined mesh is written as it is recorded, except for rounding, or for what was declared.
TEST(Truths, ARefinedMeshDeviatesFromWhereItIsWritten) {
  Told told = honest();
  run_approximate(told);
  const auto judged = [&told] {
    VerifyReport report;
    EXPECT_EQ(verify(told.sample.input, told.sample.mesh, &told.record,
                     {.stage = Stage::refined, .promised = told.promise, .declared_deviation = 1},
                     report),
              "");
    return report;
  };
  const VerifyReport as_it_was = judged();
  EXPECT_LE(as_it_was.deviation_ulps, 1) << to_text(as_it_was);
  const auto rounded = [&told](const Position& written, Index v) {
    return told.record.points[v].kind != ExactPoint::Kind::explicit_point && written[0] < 2;
  };
  for (std::size_t i = 0; i < told.sample.mesh.vertices.size(); ++i) {
    Position& written = told.sample.mesh.vertices[i];
    if (!rounded(written, told.record.mesh_vertices[i])) continue;
    written[0] += 0x1p-30;
    break;
  }
  const VerifyReport moved = judged();
  EXPECT_EQ(moved.verdict, Verdict::deviating) << to_text(moved);
  EXPECT_NEAR(moved.deviation, 0x1p-30, 0x1p-50);
}

// A stage alone is not all that was promised, and the first line says so.
TEST(Truths, TheVerdictOnAStageIsOfThatAlone) {
  const auto judged = [](Stage stage) {
    VerifyReport report;
    EXPECT_EQ(verify(honest().sample.input, honest().sample.mesh, &honest().record,
                     {.stage = stage, .promised = honest().promise}, report),
              "");
    return to_text(report).substr(0, 60) + to_json(report).substr(0, 80);
  };
  EXPECT_EQ(judged(Stage::both).find("alone"), std::string::npos);
  EXPECT_EQ(judged(Stage::both).find("scope"), std::string::npos);
  for (const char* part : {"rounded, of the final mesh alone", "\"scope\": \"the final mesh\""}) {
    EXPECT_NE(judged(Stage::final).find(part), std::string::npos) << judged(Stage::final);
  }
  for (const char* part : {"of the refined mesh alone", "\"scope\": \"the refined mesh\""}) {
    EXPECT_NE(judged(Stage::refined).find(part), std::string::npos) << judged(Stage::refined);
  }
}

// The filter may leave nothing to refine; then nothing is written.
TEST(Truths, ARefinedMeshOfNothingPasses) {
  Options options = honest_options();
  options.approximate = true;
  const Told told = run_of(options, Task::mesh, flat_wedge());
  EXPECT_TRUE(told.sample.mesh.tetrahedra.empty());
  VerifyReport report;
  ASSERT_EQ(verify(told.sample.input, told.sample.mesh, &told.record,
                   {.stage = Stage::refined, .promised = told.promise}, report),
            "");
  EXPECT_TRUE(report.all_passed()) << to_text(report);
}

TEST(Truths, OfNothingNoEdgeIsTooLong) {
  Options options = honest_options();
  options.max_edge = 0.25;
  const VerifyReport report = verdict_on(run_of(options, Task::mesh, flat_wedge()));
  ASSERT_NE(report.find("refined-edges"), nullptr);
  EXPECT_TRUE(report.find("refined-edges")->passed()) << to_text(report);
  EXPECT_TRUE(report.all_passed()) << to_text(report);
}

// The field is promised as it was asked for; one that grows more slowly was not kept.
TEST(Truths, ASizeFieldIsKeptAndNoFinerOne) {
  Options options = honest_options();
  options.max_edge = 0;
  const delmesher::Surface surface = samples::wedge_and_slab();
  options.size_field = {{surface.vertices[0], 0.02}, {{50, 60, 70}, 0.1}};
  Told told = run_of(options, Task::mesh, surface);
  const VerifyReport report = verdict_on(told);
  ASSERT_NE(report.find("refined-sizes"), nullptr);
  EXPECT_TRUE(samples::exact_or_rounded(report) && report.all_passed()) << to_text(report);
  told.promise.size_growth = 0.2;
  EXPECT_FALSE(verdict_on(told).find("refined-sizes")->passed());
  told.promise.size_growth = options.size_growth;
  told.promise.size_field[0].size = 0.01;
  EXPECT_FALSE(verdict_on(told).find("refined-sizes")->passed());
}

// A cut point is the same point from either end of its edge.
TEST(Truths, CutPointsMayBeGivenFromEitherEnd) {
  Told told = honest();
  std::size_t turned = 0;
  for (ExactPoint& p : told.record.points) {
    if (p.kind != ExactPoint::Kind::on_segment) continue;
    if (mpq_class(1) - mpq_class(p.x) != mpq_class(1 - p.x)) continue;
    std::swap(p.i, p.j);
    p.x = 1 - p.x;
    ++turned;
  }
  EXPECT_GT(turned, 0U);
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
}

// The edges to the apex of this pyramid rise at 45 degrees over the diagonals of its base: angles
// of a segment and a facet that are as large as they have to be, and none is called smaller.
TEST(Truths, AnAngleAtTheThresholdIsNotBelowIt) {
  delmesher::Surface pyramid;
  pyramid.vertices = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  pyramid.triangles = {{0, 3, 1}, {1, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  Options options = honest_options();
  options.acute = 45;
  const Told told = run_of(options, Task::mesh, pyramid);
  EXPECT_TRUE(told.record.corners.empty());
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
  const auto figures = figures_of(report, "refined-chamfer-angles");
  EXPECT_EQ(figures.at("below the threshold by rounding"), 0);
}

}  // namespace
}  // namespace tetproof
