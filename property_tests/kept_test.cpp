// Laws of a surface that is kept (Options::surface), decided by the oracles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "mesher/delmesher.h"
#include "oracles/base/vectors.h"
#include "oracles/mesh/kept.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::kept_test {
namespace {

using delmesher::Options;
using delmesher::Result;
using delmesher::StatusCode;
using delmesher::Surface;
using delmesher::SurfaceChoice;
using oracles::VerifyReport;

constexpr std::uint64_t kSeed = 20261129;

Options keeping() {
  Options options;
  options.want_exact = true;
  options.surface = SurfaceChoice::keep;
  options.strict = true;
  return options;
}

VerifyReport verified(const Surface& surface, const Result& result, const Options& options) {
  VerifyReport report;
  EXPECT_EQ(oracles::verify(
                samples::to_polyhedron(surface), samples::to_mesh(result.mesh), &result.exact,
                {.stage = oracles::Stage::final, .promised = oracles::promise_of(options)}, report),
            "");
  return report;
}

// Every triangle is one face, all vertices on the surface are the input's, and nothing deviates.
void expect_kept(const Surface& surface, const Options& options = keeping()) {
  const Result result = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.statistics.left_on_surface, 0U);
  EXPECT_EQ(result.mesh.boundary.size(), surface.triangles.size());
  const VerifyReport report = verified(surface, result, options);
  EXPECT_EQ(report.verdict, oracles::Verdict::exact) << to_text(report);
  const oracles::OracleReport* kept = report.find("kept");
  ASSERT_NE(kept, nullptr);
  EXPECT_EQ(kept->figure(oracles::kSplitTriangles), 0.0);
  EXPECT_EQ(kept->figure(oracles::kAddedVertices), 0.0);
}

// A ball of triangles of about this edge, of radius 1.
Surface ball(int rings) {
  Surface surface;
  surface.vertices.push_back({0, 0, 1});
  const int sides = 2 * rings;
  for (int ring = 1; ring < rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    for (int k = 0; k < sides; ++k) {
      const double turn = 2 * std::numbers::pi * k / sides;
      surface.vertices.push_back(
          {std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)});
    }
  }
  surface.vertices.push_back({0, 0, -1});
  const auto at = [&](int ring, int k) -> std::uint32_t {
    if (ring == 0) return 0;
    if (ring == rings) return static_cast<std::uint32_t>(surface.vertices.size() - 1);
    return static_cast<std::uint32_t>(1 + (ring - 1) * sides + k % sides);
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int k = 0; k < sides; ++k) {
      if (ring > 0) surface.triangles.push_back({at(ring, k), at(ring + 1, k), at(ring, k + 1)});
      if (ring + 1 < rings) {
        surface.triangles.push_back({at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1)});
      }
    }
  }
  return surface;
}

class Kept : public testing::TestWithParam<samples::NamedSurface> {};

TEST_P(Kept, EveryTriangleIsOneFace) {
  expect_kept(GetParam().surface);
}

INSTANTIATE_TEST_SUITE_P(Models, Kept, testing::ValuesIn(samples::surfaces(kSeed)),
                         [](const auto& tested) { return tested.param.name; });

TEST(KeptSurface, IsKeptOfRandomSolids) {
  for (int i = 0; i < samples::iterations(6); ++i) {
    const std::uint64_t seed = kSeed + static_cast<std::uint64_t>(i);
    SCOPED_TRACE(seed);
    expect_kept(samples::random_voxels(seed));
    expect_kept(samples::quantized_star(seed));
  }
}

// Points in the volume, graded: far fewer than in a grid of the edges of the surface, and enough
// for round tetrahedra.
TEST(KeptSurface, IsFilledWithFewRoundTetrahedra) {
  const Surface surface = ball(16);
  const Result result = delmesher::tetrahedralize(surface, keeping());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const auto& s = result.statistics.final;
  EXPECT_GT(s.vertices, surface.vertices.size());
  EXPECT_LT(s.tetrahedra, 6 * surface.triangles.size());
  EXPECT_GT(s.mean_gamma, 0.55);
}

// Edges inside follow what was asked for, though the surface stays.
TEST(KeptSurface, HasShorterEdgesInsideIfAskedFor) {
  const Surface surface = ball(8);
  Options options = keeping();
  const Result coarse = delmesher::tetrahedralize(surface, options);
  options.max_edge = 0.2;
  expect_kept(surface, options);
  const Result fine = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(coarse.status.ok() && fine.status.ok());
  EXPECT_GT(fine.mesh.tetrahedra.size(), 3 * coarse.mesh.tetrahedra.size());
}

double longest_edge(const Surface& surface) {
  double longest = 0;
  for (const auto& t : surface.triangles) {
    for (int i = 0; i < 3; ++i) {
      longest = std::max(
          longest, oracles::distance(surface.vertices[t[i]], surface.vertices[t[(i + 1) % 3]]));
    }
  }
  return longest;
}

// A bound where edges of the surface are within it.
TEST(KeptSurface, HasNoLongerEdgeThanAllowed) {
  const Surface surface = ball(8);
  for (const double part : {1.0, 1.2, 1.5}) {
    Options options = keeping();
    options.max_edge = part * longest_edge(surface);
    expect_kept(surface, options);
    const Result result = delmesher::tetrahedralize(surface, options);
    for (const auto& t : result.mesh.tetrahedra) {
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < i; ++j) {
          EXPECT_LE(oracles::distance(result.mesh.vertices[t[i]], result.mesh.vertices[t[j]]),
                    options.max_edge * (1 + 1e-12));
        }
      }
    }
  }
}

TEST(KeptSurface, TakesNoOptionThatDoesNothing) {
  const auto refused = [](auto change) {
    Options options = keeping();
    change(options);
    return delmesher::tetrahedralize(samples::wedge_and_slab(), options).status;
  };
  const auto status = refused([](Options& o) { o.tau = 0; });
  EXPECT_EQ(status.code, StatusCode::invalid_options);
  EXPECT_NE(status.message.find("tau"), std::string::npos) << status.message;
  for (const auto change : {+[](Options& o) { o.region = delmesher::Region::hull; },
                            +[](Options& o) { o.as_paper.link = true; },
                            +[](Options& o) { o.surface = SurfaceChoice::split; }}) {
    EXPECT_EQ(refused(change).code, StatusCode::invalid_options);
  }
}

// Edges in the volume are as short, if those of the surface are.
TEST(KeptSurface, IsBrokenByAnEdgeInTheVolumeThatIsTooLong) {
  const Surface surface = ball(8);
  const Result result = delmesher::tetrahedralize(surface, keeping());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const auto judged = [&](double longest, const delmesher::ExactRecord* record) {
    Options options = keeping();
    options.max_edge = longest;
    VerifyReport report;
    EXPECT_EQ(oracles::verify(samples::to_polyhedron(surface), samples::to_mesh(result.mesh),
                              record, {.promised = oracles::promise_of(options)}, report),
              "");
    return report;
  };
  const double longest = longest_edge(surface);
  for (const auto* record : {&result.exact, static_cast<const delmesher::ExactRecord*>(nullptr)}) {
    const VerifyReport broken = judged(longest, record);
    ASSERT_NE(broken.find("edges"), nullptr);
    EXPECT_GT(broken.find("edges")->violations, 0U) << to_text(broken);
    EXPECT_EQ(broken.verdict, oracles::Verdict::broken);
    // Beside a surface that has longer edges some have to be long, and the first line says so.
    const VerifyReport told = judged(longest / 2, record);
    EXPECT_NE(told.verdict, oracles::Verdict::broken) << to_text(told);
    ASSERT_EQ(told.unproven.size(), 1U);
    EXPECT_TRUE(told.unproven[0].starts_with("--max-edge (")) << told.unproven[0];
  }
}

// Of one that was not to be strict, the first line says how much of it is split.
TEST(KeptSurface, SaysWhatIsSplit) {
  const Surface surface = samples::to_surface(samples::cube().input);
  Options options = keeping();
  options.strict = false;
  Options split;
  split.max_edge = 0.4;
  const Result result = delmesher::tetrahedralize(surface, split);
  VerifyReport report;
  EXPECT_EQ(oracles::verify(samples::to_polyhedron(surface), samples::to_mesh(result.mesh), nullptr,
                            {.promised = oracles::promise_of(options)}, report),
            "");
  ASSERT_FALSE(report.unproven.empty());
  EXPECT_NE(report.unproven[0].find("triangles are split"), std::string::npos);
  ASSERT_NE(report.find("kept"), nullptr);
  EXPECT_GT(report.find("kept")->figure(oracles::kSplitTriangles), 0.0);
}

// --- SurfaceChoice::automatic

// A plate whose thickness alone would take tens of thousands of tetrahedra.
Surface plate() {
  Surface surface = samples::to_surface(samples::cube().input);
  for (auto& p : surface.vertices) p[2] *= 0.01;
  return surface;
}

Options automatic() {
  Options options;
  options.size = 0;
  options.want_exact = true;
  return options;
}

bool is_kept(const Result& result) {
  return result.statistics.ladder[delmesher::Rung::keep_surface] > 0;
}

TEST(AutomaticSurface, IsSplitWhereThatTakesFewTetrahedra) {
  const Surface surface = samples::to_surface(samples::cube().input);
  const Result result = delmesher::tetrahedralize(surface, automatic());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_FALSE(is_kept(result));
  EXPECT_EQ(result.statistics.tau, 1e-9);
  VerifyReport report;
  EXPECT_EQ(
      oracles::verify(samples::to_polyhedron(surface), samples::to_mesh(result.mesh), &result.exact,
                      {.stage = oracles::Stage::both, .promised = oracles::promise_of(automatic())},
                      report),
      "");
  EXPECT_EQ(report.verdict, oracles::Verdict::exact) << to_text(report);
  EXPECT_NE(report.find("refined-angles"), nullptr);
}

TEST(AutomaticSurface, IsKeptWhereItWouldTakeManyToSplitIt) {
  const Result result = delmesher::tetrahedralize(plate(), automatic());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(is_kept(result));
  EXPECT_GT(result.statistics.predicted_tetrahedra, 4 * 12);
  Options keep = automatic();
  keep.surface = SurfaceChoice::keep;
  EXPECT_EQ(result.mesh.tetrahedra, delmesher::tetrahedralize(plate(), keep).mesh.tetrahedra);
  const VerifyReport report = verified(plate(), result, automatic());
  EXPECT_EQ(report.verdict, oracles::Verdict::exact) << to_text(report);
  EXPECT_NE(report.find("kept"), nullptr);
}

// Stars, side by side: octahedra with a spike on each face.
Surface stars() {
  constexpr std::uint32_t kCopies = 12;
  constexpr double kTip = 1.3;
  Surface surface;
  for (std::uint32_t copy = 0; copy < kCopies; ++copy) {
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    const double x = 4.0 * copy;
    for (const double sign : {1.0, -1.0}) {
      surface.vertices.insert(surface.vertices.end(),
                              {{x + sign, 0, 0}, {x, sign, 0}, {x, 0, sign}});
    }
    for (std::uint32_t code = 0; code < 8; ++code) {
      const auto tip = static_cast<std::uint32_t>(surface.vertices.size());
      const auto along = [&](std::uint32_t k) { return (code >> k & 1U) != 0 ? -kTip : kTip; };
      surface.vertices.push_back({x + along(0), along(1), along(2)});
      std::array<std::uint32_t, 3> v;
      for (std::uint32_t k = 0; k < 3; ++k) v[k] = first + k + 3 * (code >> k & 1U);
      if (along(0) * along(1) * along(2) < 0) std::swap(v[0], v[1]);
      for (std::size_t k = 0; k < 3; ++k) surface.triangles.push_back({v[k], v[(k + 1) % 3], tip});
    }
  }
  return surface;
}

TEST(AutomaticSurface, IsKeptBeforeThereAreChamfersWhereTheyAreBoundToTakeMany) {
  bool has_chamfered = false;
  Options options;
  options.progress = [&](const delmesher::Progress& progress) {
    has_chamfered = has_chamfered || progress.phase == delmesher::Phase::chamfer;
    return true;
  };
  const Result result = delmesher::tetrahedralize(stars(), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(is_kept(result));
  EXPECT_FALSE(has_chamfered);
  options.surface = SurfaceChoice::split;
  EXPECT_TRUE(delmesher::tetrahedralize(stars(), options).status.ok());
  EXPECT_TRUE(has_chamfered);
}

TEST(AutomaticSurface, IsSplitForOptionsThatNeedIt) {
  for (const auto change : {+[](Options& o) { o.delta = 10; }, +[](Options& o) { o.tau = 1e-3; },
                            +[](Options& o) { o.acute = 70; }}) {
    Options options = automatic();
    change(options);
    const Result result = delmesher::tetrahedralize(plate(), options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_FALSE(is_kept(result));
  }
}

// Edges that are too long are halved, on the surface as well; triangles without such edges stay.
TEST(AutomaticSurface, IsKeptButForEdgesThatAreTooLong) {
  Surface surface = plate();
  for (const auto& p : ball(6).vertices) {
    surface.vertices.push_back({p[0] / 8 + 3, p[1] / 8, p[2] / 8});
  }
  for (const auto& [a, b, c] : ball(6).triangles)
    surface.triangles.push_back({a + 8, b + 8, c + 8});
  for (const double bound : {2.0, 0.7, 0.3, 0.13}) {
    for (const bool field : {false, true}) {
      Options options = automatic();
      if (field) {
        options.size_field = {{{0, 0, 0}, bound}};
      } else {
        options.max_edge = bound;
      }
      const Result result = delmesher::tetrahedralize(surface, options);
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      EXPECT_TRUE(is_kept(result)) << bound;
      EXPECT_EQ(result.statistics.left_on_surface, 0U);
      const VerifyReport report = verified(surface, result, options);
      EXPECT_EQ(report.verdict, oracles::Verdict::exact) << to_text(report);
      EXPECT_EQ(report.unproven.size(), 1U) << to_text(report);  // that it is kept
      const oracles::OracleReport* edges = report.find(field ? "sizes" : "edges");
      ASSERT_NE(edges, nullptr);
      EXPECT_GT(edges->checked, 0U);
      const oracles::OracleReport* kept = report.find("kept");
      ASSERT_NE(kept, nullptr);
      EXPECT_EQ(kept->figure(oracles::kLongTriangles), kept->figure(oracles::kSplitTriangles));
      if (!field) {  // of the plate all have an edge of 1 at least, of the ball none of 0.13
        EXPECT_EQ(kept->figure(oracles::kSplitTriangles), bound < 1 ? 12 : 0);
      }
    }
  }
}

// Without its refined mesh the record of a split surface is taken for one of a kept surface. Then
// the report says what is split.
TEST(AutomaticSurface, IsNoExcuseForAMissingRefinement) {
  Options options = automatic();
  options.surface = SurfaceChoice::split;
  options.max_edge = 0.5;
  const Surface surface = samples::to_surface(samples::cube().input);
  Result result = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  delmesher::ExactRecord& record = result.exact;
  record.refined.clear();
  record.refined_facets.clear();
  record.segments.clear();
  const VerifyReport report = verified(surface, result, automatic());
  EXPECT_FALSE(report.unproven.empty() && report.verdict == oracles::Verdict::exact)
      << to_text(report);
}

}  // namespace
}  // namespace tetproof::kept_test
