// Facets that are planar except for rounding, from surface to verdict: rotated and jittered solids
// keep every promise with as few facets as before, and with --planar 0 the surface as given.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "mesher/surface/test_surfaces.h"
#include "property_tests/planar/runs.h"

namespace tetproof::planar {
namespace {

using namespace oracles;  // NOLINT
namespace test_surfaces = delmesher::surface::test_surfaces;
using delmesher::Options;
using delmesher::Surface;

double as_it_is(double x) {
  return x;
}
double to_six_digits(double x) {
  return std::round(x * 1e6) / 1e6;
}
double to_five_digits(double x) {
  return std::round(x * 1e5) / 1e5;
}
double to_single_far_away(double x) {
  return to_single(x + 500);
}

struct Rounding {
  const char* name;
  double (*round)(double);
};
void PrintTo(const Rounding& rounding, std::ostream* out) {
  *out << rounding.name;
}

class Rotated : public testing::TestWithParam<Rounding> {};
INSTANTIATE_TEST_SUITE_P(By, Rotated,
                         testing::Values(Rounding{"doubles", as_it_is},
                                         Rounding{"single", to_single},
                                         Rounding{"decimals", to_six_digits},
                                         Rounding{"few_decimals", to_five_digits},
                                         Rounding{"far_single", to_single_far_away}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(Rotated, PartsKeepTheirFacetsAndEveryPromise) {
  // The first is verified with its record, which takes the longest.
  const std::vector<Surface> parts = {stairs(), samples::random_voxels(3)};
  for (const Surface& part : parts) {
    const Told straight = run_of(part), turned = run_of(rotated(part, GetParam().round));
    EXPECT_EQ(straight.statistics.planar_groups, 0U);
    EXPECT_GT(turned.statistics.planar_groups, 0U);
    EXPECT_GT(turned.statistics.given_facets, straight.statistics.facets);
    EXPECT_EQ(turned.statistics.facets, straight.statistics.facets);
    EXPECT_FALSE(turned.record.planes.empty());
    // Half as many again would be no surprise for other coordinates; facets of noise cost ten times
    // as much.
    EXPECT_LT(turned.statistics.final.tetrahedra, 2 * straight.statistics.final.tetrahedra);
    for (const bool with_record : {&part == &parts.front(), false}) {
      const VerifyReport report = verdict_on(turned, with_record);
      EXPECT_FALSE(failed(report, {.promised = turned.promise})) << to_text(report);
      EXPECT_TRUE(!with_record || samples::as_promised(report)) << to_text(report);
    }
    // All vertices are in the mesh as given.
    std::vector<Position> written = turned.sample.mesh.vertices;
    std::sort(written.begin(), written.end());
    for (const Position& p : turned.sample.input.vertices) {
      EXPECT_TRUE(std::binary_search(written.begin(), written.end(), p));
    }
  }
}

// Facets that were flat still are, up to the changes of their vertices, and nothing else changes.
void expect_the_facets_of(const Surface& part, const Surface& changed) {
  const Told straight = run_of(part), told = run_of(changed);
  EXPECT_GT(told.statistics.planar_groups, 0U);
  EXPECT_GT(told.statistics.given_facets, straight.statistics.facets);
  EXPECT_EQ(told.statistics.facets, straight.statistics.facets);
  const VerifyReport report = verdict_on(told);
  const OracleReport* again = report.find("exact-second-kernel");
  ASSERT_NE(again, nullptr);
  EXPECT_GT(again->checked, told.record.points.size() + told.record.final.size());
  EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
}

TEST(Jittered, ByAnUlpFacetsStay) {
  Surface jittered = stairs();
  std::mt19937 random(11);
  for (auto& p : jittered.vertices) {
    for (double& x : p) {
      const auto step = static_cast<int>(random() % 3) - 1;
      if (step != 0) x = std::nextafter(x, step * HUGE_VAL);
    }
  }
  expect_the_facets_of(stairs(), jittered);
}

TEST(Split, AtRoundedPointsFacetsStay) {
  Surface split = rotated(stairs(), as_it_is);
  std::mt19937 random(12);
  for (int n = 0; n < 12; ++n) {
    const std::size_t t = random() % split.triangles.size();
    const auto [a, b, c] = split.triangles[t];
    const double u = 0.2 + 0.1 * static_cast<double>(random() % 4), v = 0.17;
    std::array<double, 3> p{};
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] =
          u * split.vertices[a][i] + v * split.vertices[b][i] + (1 - u - v) * split.vertices[c][i];
    }
    const auto m = static_cast<std::uint32_t>(split.vertices.size());
    split.vertices.push_back(p);
    split.triangles[t] = {a, b, m};
    split.triangles.push_back({b, c, m});
    split.triangles.push_back({c, a, m});
  }
  expect_the_facets_of(stairs(), split);
}

// Refined as with planar facets, and put back: the surface as given, at hardly more tetrahedra.
TEST_P(Rotated, WithPlanarZeroTheSurfaceIsKeptToTheLastBit) {
  const Told straight = run_of(stairs()), told = run_of(rotated(stairs(), GetParam().round), 0);
  EXPECT_GT(told.statistics.planar_groups, 0U);
  EXPECT_FALSE(told.record.planes.empty());
  EXPECT_LT(told.statistics.final.tetrahedra, 3 * straight.statistics.final.tetrahedra);
  std::set<std::uint32_t> refined, final;
  for (const auto& face : told.record.refined_facets) refined.insert(face[3]);
  for (const auto& face : told.record.final_facets) final.insert(face[3]);
  EXPECT_EQ(final.size(), told.statistics.given_facets);
  EXPECT_LT(refined.size(), final.size());
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
  EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
  // More than was promised is a pass, too.
  Told more = told;
  more.promise.planar = delmesher::kPlanarAuto;
  const VerifyReport of_more = verdict_on(more);
  EXPECT_TRUE(samples::as_promised(of_more)) << to_text(of_more);
}

// The record's list of facets is that of the planarized surface, where fewer triangles are facets.
TEST(PlanarZero, LabelsAreThoseOfTheSurfaceAsGiven) {
  Surface labelled = rotated(stairs(), to_single);
  labelled.labels.assign(labelled.triangles.size(), 7);
  const Told told = run_of(labelled, 0);
  EXPECT_LT(told.record.facets.size(), told.statistics.given_facets);
  EXPECT_EQ(std::ranges::count(told.sample.mesh.labels, 7),
            static_cast<std::ptrdiff_t>(told.sample.mesh.boundary.size()));
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
}

// Its two ends are fans of needles on an ellipse.
Surface flat_prism(std::uint32_t n, double height, double width) {
  return test_surfaces::prism(test_surfaces::ellipse(n, width), height);
}

struct Part {
  Surface surface;
  std::uint64_t most;  // tetrahedra
};

// The mesh went back to the surface as given, by local operations or by another tetrahedrization.
void expect_kept(const Part& part, std::uint64_t tetrahedrized_again = 0) {
  const Told told = run_of(part.surface, 0);
  EXPECT_EQ(told.statistics.ladder[delmesher::Rung::tetrahedrize_again], tetrahedrized_again);
  EXPECT_FALSE(told.statistics.planar_given_up);
  EXPECT_FALSE(told.record.planes.empty());
  EXPECT_LT(told.statistics.final.tetrahedra, part.most);
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
  EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
}

// There are edges that cross a facet's edge at which tetrahedra are flatter than the surface bends
// there, or that vertices were moved by more than those are thick.
TEST(PlanarZero, EdgesComeBackThroughFlatTetrahedra) {
  for (const Part& part : {Part{rotated(flat_prism(12, 0.5, 0.3), as_it_is), 120},
                           Part{rotated(flat_prism(16, 2, 1), as_it_is), 200},
                           Part{rotated(flat_prism(12, 2, 0.05), to_single), 1200}}) {
    expect_kept(part);
  }
}

// The cavity of a crossing reaches other faces of the facet, or there is no room for one before
// vertices of the facet have moved, or other edges have come back. The last takes 9 925 tetrahedra
// with every bend refined.
TEST(PlanarZero, EdgesComeBackOverOtherFacesOfTheirFacet) {
  for (const Part& part : {Part{rotated(flat_prism(12, 0.1, 0.05), as_it_is), 500},
                           Part{rotated(flat_prism(8, 0.1, 0.05), as_it_is), 450},
                           Part{rotated(flat_prism(16, 2, 0.3), to_single), 600},
                           Part{rotated(flat_prism(16, 0.02, 0.05), as_it_is), 3000},
                           Part{rotated(flat_prism(36, 0.05, 0.5), to_single), 1000}}) {
    expect_kept(part);
  }
}

// Some edges find no place. With every bend refined these take 60 236 and 27 072 tetrahedra.
TEST(PlanarZero, WhereEdgesFindNoPlaceTheSurfaceIsTetrahedrizedAgain) {
  for (const Part& part : {Part{rotated(flat_prism(32, 0.02, 0.02), to_single), 500},
                           Part{rotated(flat_prism(20, 0.5, 0.05), to_single), 1000}}) {
    expect_kept(part, 1);
  }
}

// With all of the points that their return takes, these have 1 828, 394 and 703 tetrahedra.
TEST(PlanarZero, PointsOnEdgesThatCameBackAreSpared) {
  for (const Part& part : {Part{rotated(flat_prism(16, 0.02, 0.05), as_it_is), 1000},
                           Part{rotated(flat_prism(16, 2, 0.3), to_single), 380},
                           Part{rotated(flat_prism(24, 0.1, 0.05), to_single), 600}}) {
    expect_kept(part);
  }
}

// Where no neighbour on its edge can replace a point, it goes into the volume. Else these have
// about 1 800, 940, 830 and 680 tetrahedra.
TEST(PlanarZero, PointsOnEdgesThatCameBackGoIntoTheVolume) {
  for (const Part& part : {Part{rotated(flat_prism(24, 0.02, 0.05), as_it_is), 500},
                           Part{rotated(flat_prism(24, 0.1, 0.05), as_it_is), 350},
                           Part{rotated(flat_prism(24, 0.1, 0.05), to_single), 300},
                           Part{rotated(flat_prism(16, 0.1, 0.05), to_single), 400}}) {
    expect_kept(part);
  }
}

// Between edges that come back, tetrahedra may be positive as doubles, but not exactly.
// Tetrahedrized again, these take 2 682 and 3 712 tetrahedra.
TEST(PlanarZero, FlatTetrahedraFitTheSurfaceAsGiven) {
  for (const Part& part : {Part{rotated(flat_prism(8, 0.02, 1), as_it_is), 2600},
                           Part{rotated(flat_prism(24, 0.02, 1), as_it_is), 3200}}) {
    expect_kept(part);
  }
}

// What comes back makes no edge longer than what is wanted, and fits into a mesh of the hull.
TEST(PlanarZero, KeepsLongestEdgeAndHull) {
  for (const double max_edge : {0.7, 0.3}) {
    for (const delmesher::Region region : {delmesher::Region::interior, delmesher::Region::hull}) {
      Options options;
      options.planar = 0;
      options.max_edge = max_edge;
      options.region = region;
      const Told told = run_with(rotated(stairs(), to_single), options);
      EXPECT_GT(told.statistics.planar_groups, 0U) << "refined without planar facets";
      const VerifyReport report = verdict_on(told);
      EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
    }
  }
}

}  // namespace
}  // namespace tetproof::planar
