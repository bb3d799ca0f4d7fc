// Laws of vertices that no triangle has: they become vertices of the mesh. Decided by the oracles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "mesher/delmesher.h"
#include "oracles/mesh/loose_points.h"
#include "property_tests/complexes.h"

namespace tetproof::loose_points_test {
namespace {

using namespace complexes;  // NOLINT(google-build-using-namespace)
using delmesher::Result;
using delmesher::SurfaceChoice;
using Point = std::array<double, 3>;

struct Way {
  const char* name;
  Options options;
};

std::vector<Way> ways() {
  std::vector<Way> all = {{"auto", {}},
                          {"split", samples::split_surface()},
                          {"keep", {}},
                          {"as given", samples::split_surface()},
                          {"hull", samples::split_surface()},
                          {"unimproved", samples::split_surface()},
                          {"tolerance", {}},
                          {"regions", all_regions()}};
  all[2].options.surface = SurfaceChoice::keep;
  all[3].options.planar = 0;
  all[4].options.region = delmesher::Region::hull;
  all[5].options.improve = false;
  all[6].options.tolerance = -1e-3;
  all[0].options.size = 0;  // or points are vertices by chance
  for (Way& way : all) {
    way.options.want_exact =
        way.options.regions == delmesher::Regions::solid && way.options.tolerance == 0;
  }
  return all;
}

VerifyReport verified(const Surface& surface, const Result& result, const Options& options,
                      const std::vector<Point>& points = {}) {
  oracles::Promise promise = oracles::promise_of(options);
  promise.points = points;
  VerifyReport report;
  EXPECT_EQ(oracles::verify(samples::to_polyhedron(surface), samples::to_mesh(result.mesh),
                            options.want_exact ? &result.exact : nullptr,
                            {.stage = promise.keep || !options.want_exact ? oracles::Stage::final
                                                                          : oracles::Stage::both,
                             .promised = promise},
                            report),
            "");
  return report;
}

// In the box around the surface, and near its vertices.
std::vector<Point> points_around(const Surface& surface, std::mt19937_64& random) {
  Point low = surface.vertices[0], high = low;
  for (const Point& p : surface.vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  std::vector<Point> points(12);
  std::uniform_real_distribution<double> share(0, 1);
  for (std::size_t n = 0; n < points.size(); ++n) {
    for (std::size_t k = 0; k < 3; ++k) {
      points[n][k] = low[k] + share(random) * (high[k] - low[k]);
    }
    if (n % 3 != 0) continue;
    const Point& near = surface.vertices[random() % surface.vertices.size()];
    for (std::size_t k = 0; k < 3; ++k) points[n][k] = near[k] + (points[n][k] - near[k]) / 64;
  }
  return points;
}

TEST(LoosePoints, AreVerticesOfTheMesh) {
  std::uint64_t there = 0;
  for (int i = 0; i < samples::iterations(2); ++i) {
    std::mt19937_64 random(kSeed + static_cast<std::uint64_t>(i));
    for (const auto& [name, given] : samples::surfaces(kSeed + static_cast<std::uint64_t>(i))) {
      Surface surface = given;
      const std::vector<Point> points = points_around(given, random);
      surface.vertices.insert(surface.vertices.end(), points.begin(), points.end());
      for (const auto& [way, options] : ways()) {
        SCOPED_TRACE(name + ", " + way);
        const Result result = delmesher::tetrahedralize(surface, options);
        ASSERT_TRUE(result.status.ok()) << result.status.message;
        const VerifyReport report = verified(surface, result, options);
        EXPECT_TRUE(options.tolerance != 0 ? report.verdict != oracles::Verdict::broken
                                           : samples::as_promised(report))
            << to_text(report);
        const oracles::OracleReport* oracle = report.find("points");
        ASSERT_NE(oracle, nullptr);
        EXPECT_TRUE(oracle->promised);
        EXPECT_EQ(oracle->figure("on triangles"), std::nullopt) << to_text(report);
        const auto outside = static_cast<std::uint64_t>(oracle->figure("outside").value_or(0));
        there += oracle->checked - outside;
        EXPECT_EQ(outside > 0, std::ranges::any_of(result.warnings, [](const std::string& w) {
                    return w.find("left out: outside of the mesh") != std::string::npos;
                  }));
      }
    }
  }
  EXPECT_GT(there, 100U);
}

Surface box_with(const std::vector<Point>& points) {
  Builder builder;
  builder.box({0, 0, 0}, {4, 4, 4});
  Surface surface = builder.surface();
  surface.labels.clear();
  surface.vertices.insert(surface.vertices.end(), points.begin(), points.end());
  return surface;
}

// Twice at a place, on a vertex, a triangle, an edge, and outside.
TEST(LoosePoints, ThatAreNoVerticesAreSaid) {
  const std::vector<Point> points = {{1, 2, 3},
                                     {1, 2, 3},
                                     {4, 4, 4},
                                     {1, 1, 0},
                                     {0, 0, 1},
                                     {5, 1, 1},
                                     {1, 2, std::nextafter(3, 4)}};
  const Surface surface = box_with(points);
  for (const auto& [way, options] : ways()) {
    SCOPED_TRACE(way);
    const Result result = delmesher::tetrahedralize(surface, options);
    ASSERT_TRUE(result.status.ok());
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_TRUE(result.warnings[0].starts_with("3 points left out: ")) << result.warnings[0];
    for (const std::size_t n : {0U, 2U, 6U}) {
      EXPECT_EQ(std::ranges::count(result.mesh.vertices, points[n]), 1);
    }
    const VerifyReport report = verified(box_with({}), result, options, points);
    EXPECT_NE(report.verdict, oracles::Verdict::broken) << to_text(report);
    ASSERT_NE(report.find("points"), nullptr);
    EXPECT_EQ(report.find("points")->checked, points.size());
  }
}

TEST(LoosePoints, OfWhatIsNotWrittenAreLeftOut) {
  Builder builder;
  builder.box({0, 0, 0}, {4, 4, 4}, 1);
  builder.box({1, 1, 1}, {2, 2, 2}, 2);
  Surface surface = builder.surface();
  surface.vertices.insert(surface.vertices.end(), {{1.5, 1.25, 1.75}, {3, 3, 3}});
  Options options = all_regions();
  options.regions = delmesher::Regions::largest;
  const Result result = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(result.status.ok());
  EXPECT_EQ(std::ranges::count(result.mesh.vertices, surface.vertices[16]), 0);
  EXPECT_EQ(std::ranges::count(result.mesh.vertices, surface.vertices[17]), 1);
  EXPECT_EQ(result.warnings,
            std::vector<std::string>{"1 point left out: outside of the mesh, or on "
                                     "a triangle (the first is number 16, counted "
                                     "from 0)"});
}

// In other units, and beside the origin.
TEST(LoosePoints, MoveWithTheSurface) {
  for (const double scale : {1.0, 0x1p-100, 0x1p90}) {
    for (const double away : {0.0, 0x1p30}) {
      Surface surface = box_with({{1, 2, 3}, {2.5, 2, 1}});
      for (Point& p : surface.vertices) {
        for (double& x : p) x = (x + away) * scale;
      }
      Options options;
      options.want_exact = true;
      const Result result = delmesher::tetrahedralize(surface, options);
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      const VerifyReport report = verified(surface, result, options);
      EXPECT_EQ(report.verdict, oracles::Verdict::exact) << to_text(report);
    }
  }
}

TEST(LoosePoints, AreMissedByTheOracle) {
  const std::vector<Point> points = {{1, 2, 3}};
  const Surface bare = box_with({}), with = box_with(points);
  for (const auto& [way, options] : ways()) {
    SCOPED_TRACE(way);
    const auto expect_broken = [&](const VerifyReport& report) {
      EXPECT_EQ(report.verdict, oracles::Verdict::broken) << to_text(report);
      ASSERT_NE(report.find("points"), nullptr);
      EXPECT_FALSE(report.find("points")->passed());
    };
    Options alone = options;
    alone.want_exact = false;
    const Result without = delmesher::tetrahedralize(bare, alone);
    expect_broken(verified(bare, without, alone, points));
    Result result = delmesher::tetrahedralize(with, alone);
    EXPECT_NE(verified(bare, result, alone, points).verdict, oracles::Verdict::broken);
    (*std::ranges::find(result.mesh.vertices, points[0]))[0] = std::nextafter(1, 2);
    expect_broken(verified(bare, result, alone, points));
    // Of vertices of the input alone nobody has promised anything in a file of any origin.
    const VerifyReport report = verified(with, without, alone);
    if (options.regions == delmesher::Regions::solid) {
      EXPECT_NE(report.verdict, oracles::Verdict::broken) << to_text(report);
      EXPECT_EQ(std::ranges::count(report.unproven, "points of no triangle (1 are no vertices)"),
                1);
    } else {
      expect_broken(report);
    }
  }
}

}  // namespace
}  // namespace tetproof::loose_points_test
