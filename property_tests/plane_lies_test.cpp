// Lies of a record of the plane, as lies_test.cpp tells them in space: relaxed promises; sections
// emptied, cut short, doubled, swapped; records and files of other runs; lies that change mesh and
// record together. Each must be caught by the oracle meant for it. At the end they are printed
// as a table.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "property_tests/plane_lies/told.h"
#include "property_tests/score_table.h"

namespace tetproof::plane_lies_test {
namespace {

using namespace plane_lies;  // NOLINT
using delmesher::PlanarGraph;
using delmesher::PlaneRecord;
using Side = PlaneRecord::Side;
using Index = std::uint32_t;

class PlaneLies : public testing::TestWithParam<Lie> {};

TEST_P(PlaneLies, AreCaughtByTheOracleMeantForThem) {
  Told told = honest();
  const auto verdict = [](const Told& t) {
    oracles::VerifyReport report;
    EXPECT_EQ(verify_plane(t.graph, t.file, &t.record, t.how, report), "");
    return report;
  };
  static const oracles::VerifyReport good = verdict(told);
  ASSERT_TRUE(good.all_passed()) << to_text(good);
  GetParam().tell(told);
  judge("square with a dent", GetParam().name, GetParam().oracle, verdict(told), GetParam().before);
}

INSTANTIATE_TEST_SUITE_P(Relaxed, PlaneLies, testing::ValuesIn(relaxed()), test_name<Lie>);
INSTANTIATE_TEST_SUITE_P(Sections, PlaneLies, testing::ValuesIn(sections()), test_name<Lie>);
INSTANTIATE_TEST_SUITE_P(Foreign, PlaneLies, testing::ValuesIn(foreign()), test_name<Lie>);
INSTANTIATE_TEST_SUITE_P(Consistent, PlaneLies, testing::ValuesIn(consistent()), test_name<Lie>);

// Without corners and drops the lies would be empty.
TEST(PlaneLies, AreToldOfARunThatChamfersAndDrops) {
  EXPECT_GE(honest().record.corners.size(), 2U);
  EXPECT_EQ(honest().record.dropped.size(), 1U);
}

oracles::VerifyReport verdict_on(const Told& told, bool with_record = true) {
  oracles::VerifyReport report;
  EXPECT_EQ(
      verify_plane(told.graph, told.file, with_record ? &told.record : nullptr, told.how, report),
      "");
  return report;
}

TEST(PlaneTruths, DeviationIsToldInUnitsOfTheLargestCoordinate) {
  Told told = honest();
  told.file.vertices[steiner(told)][0] += 3 * 0x1p-50;  // 3 ulp of the largest, 4.5
  for (const bool with_record : {false, true}) {
    const oracles::VerifyReport report = verdict_on(told, with_record);
    EXPECT_GT(report.deviation, 0x1p-50);
    EXPECT_DOUBLE_EQ(report.deviation_ulps, report.deviation / 0x1p-50);
  }
}

bool says(const oracles::VerifyReport& report, const char* oracle, const std::string& words) {
  const oracles::OracleReport* found = report.find(oracle);
  return found != nullptr && std::ranges::any_of(found->findings, [&](const std::string& finding) {
           return finding.find(words) != std::string::npos;
         });
}

TEST(PlaneTruths, AnglesOfATriangleFarFromTheOrigin) {
  Told told;
  told.graph.vertices = {{10, 20}, {14, 20}, {10, 23}};
  told.graph.segments = {{0, 1}, {1, 2}, {2, 0}};
  told.file.vertices = told.graph.vertices;
  for (const std::array<Index, 3>& corners :
       {std::array<Index, 3>{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}) {
    told.file.triangles = {corners};
    const oracles::VerifyReport report = verdict_on(told, false);
    const oracles::OracleReport* angles = report.find("angles");
    ASSERT_NE(angles, nullptr) << to_text(report);
    EXPECT_NEAR(angles->figures.at(0).second, std::atan2(3, 4) * 57.29577951308232, 1e-9);
    EXPECT_NEAR(angles->figures.at(1).second, 90, 1e-9);
  }
}

// An angle that cannot be promised is not demanded, and the report says so.
TEST(PlaneTruths, AnAngleThatWasNotReachedIsTold) {
  Told told = honest();
  told.how.promised.delta = 30;
  const oracles::VerifyReport report = verdict_on(told);
  const oracles::OracleReport* promise = report.find("promise");
  ASSERT_NE(promise, nullptr);
  EXPECT_TRUE(promise->passed()) << to_text(report);
  EXPECT_TRUE(std::ranges::any_of(promise->figures, [&](const auto& figure) {
    return figure.first == "delta reached" && figure.second == told.record.delta;
  }));
}

TEST(PlaneTruths, ReasonsOfDropsAreCounted) {
  const oracles::VerifyReport report = verdict_on(honest());
  const oracles::OracleReport* drops = report.find("refined-drops");
  ASSERT_NE(drops, nullptr);
  EXPECT_EQ(drops->figure("beside a narrow channel"), 1.0) << to_text(report);
  EXPECT_EQ(drops->figure("no room between doubles"), std::nullopt);
}

// What is not shown, or not kept where corners came back, stands in the first line.
TEST(PlaneTruths, SayFirstWhatIsNotShown) {
  Told told = honest();
  EXPECT_EQ(verdict_on(told).unproven, std::vector<std::string>{});
  told.how.promised.delta = 30;
  EXPECT_EQ(verdict_on(told).unproven, std::vector<std::string>{"--delta above 20.7 degrees"});
  told = honest();
  told.how.promised.max_edge = 0.125;
  for (const bool with_record : {true, false}) {
    const oracles::VerifyReport report = verdict_on(told, with_record);
    ASSERT_EQ(report.unproven.size(), 1U);
    EXPECT_TRUE(report.unproven[0].starts_with("--max-edge (")) << report.unproven[0];
    ASSERT_NE(report.find("edges"), nullptr);
    EXPECT_EQ(report.find("edges")->undecided, !with_record);
  }
  told = honest();
  told.graph.markers.assign(told.graph.segments.size(), 1);
  told.graph.markers[0] = 2;
  told.graph.regions = {{{0.25, 0.25}, 5}};
  told.file.lists_edges = false;
  told.file.edges.clear();
  told.file.markers.clear();
  told.file.segments.clear();
  told.file.attributes.clear();
  EXPECT_EQ(verdict_on(told, false).unproven,
            (std::vector<std::string>{"markers of the input (the file has none)",
                                      "attributes of regions (the file has none)"}));
}

TEST(PlaneLies, NameAVertexOfTheInputThatNothingReaches) {
  Told told = honest();
  told.graph.vertices.push_back({3, 1});
  const oracles::VerifyReport report = verdict_on(told, false);
  ASSERT_NE(report.find("conformity"), nullptr);
  EXPECT_FALSE(report.find("conformity")->passed()) << to_text(report);
}

TEST(PlaneLies, NamePointsThatTheInputHasAndTheRecordHasNot) {
  for (const std::size_t missing : {1U, 2U}) {
    Told told = honest();
    told.record.points.resize(told.graph.vertices.size() - missing);
    EXPECT_TRUE(says(verdict_on(told), "sidecar", "fewer points than input vertices"));
  }
}

// The tip of a slender triangle whose neighbours are all far away, except for the inside of a
// segment.
TEST(PlaneLies, AboutARadiusThatReachesToASegment) {
  PlanarGraph graph;
  graph.vertices = {{0, 0}, {8, -1}, {8, 1}, {-0.5, -9}, {-0.5, 9}};
  graph.segments = {{0, 1}, {1, 2}, {2, 0}, {3, 4}};
  Told told = run_of(honest_options(), graph);
  const oracles::VerifyReport good = verdict_on(told);
  ASSERT_TRUE(good.all_passed()) << to_text(good);
  const auto tip = std::ranges::find(told.record.corners, 0U, &PlaneRecord::Corner::vertex);
  ASSERT_NE(tip, told.record.corners.end());
  tip->distance = 0.2;  // 0.5 / 3 is what the segment leaves
  EXPECT_TRUE(says(verdict_on(told), "refined-chamfer-distance", "corner 0 is cut beyond a third"));
}

// A vertex lies on a segment; two edges of the refined mesh that end there are told as one.
TEST(PlaneLies, AboutAnEdgeOverAVertex) {
  PlanarGraph graph;
  graph.vertices = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 0}};
  graph.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  Told told = run_of(honest_options(), graph);
  const oracles::VerifyReport good = verdict_on(told);
  ASSERT_TRUE(good.all_passed()) << to_text(good);
  std::vector<Index> beside;  // on the segment, next to the vertex
  auto& edges = told.record.refined_edges;
  for (const auto& e : edges) {
    for (const std::size_t k : {0U, 1U}) {
      if (e.segment == 0 && e.vertices[k] == 4) beside.push_back(e.vertices[1 - k]);
    }
  }
  ASSERT_EQ(beside.size(), 2U);
  std::erase_if(edges, [](const auto& e) {
    return e.segment == 0 && (e.vertices[0] == 4 || e.vertices[1] == 4);
  });
  edges.push_back({{beside[0], beside[1]}, 0});
  EXPECT_TRUE(
      says(verdict_on(told), "refined-segments", "has an edge that passes through a vertex"));
}

// Segments cut a rectangle into two halves; parity does not decide what is inside.
TEST(PlaneLies, NameAFaceThatIsMissing) {
  PlanarGraph graph;
  graph.vertices = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}};
  graph.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 0}, {1, 4}};
  Told told = run_of(honest_options(), graph);
  ASSERT_TRUE(verdict_on(told).all_passed()) << to_text(verdict_on(told));
  Told half = told;
  half.file = {};
  half.file.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  half.file.triangles = {{0, 1, 2}, {2, 3, 0}};
  const oracles::VerifyReport report = verdict_on(half, false);
  EXPECT_TRUE(says(report, "conformity", "segment 1 is not tiled by edges")) << to_text(report);
  EXPECT_TRUE(says(report, "conformity", "segment 2 is not tiled by edges"));
  EXPECT_FALSE(says(report, "conformity", "segment 0 "));
  graph.holes = {{1.5, 0.25}};
  half.graph = graph;
  EXPECT_TRUE(verdict_on(half, false).all_passed()) << to_text(verdict_on(half, false));
}

// A vertex index that is too large by one.
TEST(PlaneLies, NamesTheTriangleThatRefersToNoVertex) {
  Told told = honest();
  told.file.triangles[2][1] = static_cast<Index>(told.file.vertices.size());
  const oracles::VerifyReport report = verdict_on(told, false);
  const oracles::OracleReport* complex = report.find("complex");
  ASSERT_NE(complex, nullptr);
  EXPECT_NE(std::find(complex->findings.begin(), complex->findings.end(),
                      "triangle 2 refers to no vertex"),
            complex->findings.end());
}

// The run was of a square. Sheared to one side or the other, a corner of one of its two triangles
// is in the disc of the opposite edge.
TEST(PlaneLies, NoCornerIsInTheDiscOfASegment) {
  PlanarGraph square;
  square.vertices = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  square.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  const Told run = run_of(honest_options(), square);
  ASSERT_TRUE(verdict_on(run).all_passed()) << to_text(verdict_on(run));
  ASSERT_EQ(run.file.triangles.size(), 2U);
  int caught = 0;
  for (const double shear : {-2.0, 2.0}) {
    Told told = run;
    for (const Index v : {2U, 3U}) {
      auto& [x, y] = told.graph.vertices[v];
      x += shear;
      y = 1;
      told.record.points[v].x = x;
      told.record.points[v].y = y;
      told.file.vertices[v] = told.graph.vertices[v];
    }
    caught += says(verdict_on(told), "refined-encroachment", "in the disc of an edge") ? 1 : 0;
  }
  EXPECT_GE(caught, 1);
}

TEST(PlaneLies, NoTriangleCoversThePointOfAHole) {
  Told told;
  told.graph.vertices = {{0, 0}, {4, 0}, {0, 4}};
  told.graph.segments = {{0, 1}, {1, 2}, {2, 0}};
  told.graph.holes = {{1, 1}};
  told.file.vertices = told.graph.vertices;
  for (const std::array<Index, 3>& corners :
       {std::array<Index, 3>{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}) {
    told.file.triangles = {corners};
    EXPECT_TRUE(says(verdict_on(told, false), "sides", "triangle 0 covers the point of a hole"))
        << to_text(verdict_on(told, false));
  }
}

// The area of a single ring is known from the input alone.
TEST(PlaneLies, AboutTheInsideOfASingleRingShowInItsArea) {
  PlanarGraph arrow;
  arrow.vertices = {{0, 0}, {4, 0}, {1, 1}, {0, 4}};
  arrow.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  Told told = run_of(honest_options(), arrow);
  const oracles::VerifyReport good = verdict_on(told);
  ASSERT_TRUE(good.all_passed()) << to_text(good);
  ASSERT_NE(good.find("exact-area"), nullptr);
  EXPECT_EQ(good.find("exact-area")->checked, told.record.final.size());
  some(told.record.final, Side::inside).side = Side::outside;
  const oracles::VerifyReport bad = verdict_on(told);
  ASSERT_NE(bad.find("exact-area"), nullptr);
  EXPECT_EQ(bad.find("exact-area")->violations, 1U);
}

TEST(PlaneLies, AboutTheVerticesOfAFileAlone) {
  Told told = honest();
  told.how.promised.max_vertices = static_cast<double>(told.file.vertices.size());
  const oracles::VerifyReport good = verdict_on(told, false);
  ASSERT_NE(good.find("promise"), nullptr);
  EXPECT_TRUE(good.all_passed()) << to_text(good);
  told.how.promised.max_vertices -= 1;
  EXPECT_TRUE(says(verdict_on(told, false), "promise", "vertices, promised were at most"));
}

// A square within a rectangle, with and without the sides exchanged. However far away the rectangle
// is, no vertex of the square is known worse for it.
TEST(PlaneLies, AboutSidesWithinARectangleFarAway) {
  PlanarGraph square;
  square.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  for (const double far : {4.0, 0x1p60}) {
    Told told;
    told.graph = square;
    told.how.promised.task = oracles::Task::plane;
    told.how.promised.region = delmesher::Region::hull;
    told.file.vertices = square.vertices;
    for (const auto& [x, y] : {std::array{-far, -far}, {far, -far}, {far, far}, {-far, far}}) {
      told.file.vertices.push_back({x, y});
    }
    told.file.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 0}, {5, 1, 0}, {5, 6, 1},
                           {6, 2, 1}, {6, 7, 2}, {7, 3, 2}, {7, 4, 3}, {4, 0, 3}};
    told.file.inside = {1, 1, 0, 0, 0, 0, 0, 0, 0, 0};
    const oracles::VerifyReport good = verdict_on(told, false);
    EXPECT_EQ(good.verdict, oracles::Verdict::exact) << to_text(good);
    for (auto& side : told.file.inside) side = side == 0;
    EXPECT_TRUE(says(verdict_on(told, false), "sides", "triangle 0 is inside")) << far;
  }
}

}  // namespace
}  // namespace tetproof::plane_lies_test
