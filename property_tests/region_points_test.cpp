// Laws of points that tell of regions (Options::region_points), decided by the oracles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>

#include "property_tests/complexes.h"

namespace tetproof::region_points_test {
namespace {

using namespace complexes;  // NOLINT(google-build-using-namespace)
using delmesher::Regions;
using delmesher::Result;
using delmesher::StatusCode;

delmesher::RegionPoint point_of(const Cell& cell, int material) {
  return {{cell[0] + 0.5, cell[1] + 0.25, cell[2] + 0.75}, "m" + std::to_string(material)};
}

// As a file of TetGen has them.
Polyhedron with_points(const Surface& surface, const std::vector<delmesher::RegionPoint>& points) {
  Polyhedron input = samples::to_polyhedron(surface);
  for (const delmesher::RegionPoint& p : points) {
    const double volume = std::pow(p.max_edge, 3) / 6 / std::numbers::sqrt2;
    input.region_points.push_back({p.point, p.name, volume, p.is_hole});
  }
  return input;
}

MeshFile with_region_names(const Result& result) {
  MeshFile mesh = samples::to_mesh(result.mesh);
  std::map<std::string, int> count;
  for (std::size_t n = 0; n < result.regions.size(); ++n) {
    const std::string& name = result.regions[n].name;
    const int number = ++count[name];
    if (name.empty()) continue;
    mesh.names[{3, static_cast<std::int64_t>(n + 1)}] =
        number == 1 ? name : name + " " + std::to_string(number);
  }
  return mesh;
}

// Cells of five materials; a point in each cell of the second and the third, and holes in the
// fourth.
TEST(RegionPoints, NameRegionsAndLeaveHolesOut) {
  for (int i = 0; i < samples::iterations(6); ++i) {
    SCOPED_TRACE(i);
    std::mt19937_64 random(kSeed + 7 + static_cast<std::uint64_t>(i));
    Materials cells;
    Options options = all_regions();
    std::set<int> used;
    for (int x = 0; x < 3; ++x) {
      for (int y = 0; y < 3; ++y) {
        for (int z = 0; z < 3; ++z) {
          const int material = static_cast<int>(random() % 5);
          cells[{x, y, z}] = material;
          if (material < 2) continue;
          used.insert(material);
          options.region_points.push_back(point_of({x, y, z}, material));
          if (material != 4) continue;
          options.region_points.back().is_hole = true;
          options.region_points.back().name.clear();
        }
      }
    }
    if (used != std::set<int>{2, 3, 4}) continue;
    const Surface surface = walls_of(cells, 3, random);
    const Result result = delmesher::tetrahedralize(surface, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.warnings, std::vector<std::string>());
    double volume = 0, wanted = 0;
    for (std::size_t t = 0; t < result.mesh.tetrahedra.size(); ++t) {
      const auto& region = result.regions[static_cast<std::size_t>(result.mesh.regions[t] - 1)];
      EXPECT_FALSE(region.is_hole);
    }
    for (const auto& region : result.regions) {
      if (region.is_hole) {
        EXPECT_EQ(region.tetrahedra, 0U);
      }
      if (region.name == "m2" || region.name == "m3") volume += region.volume;
    }
    for (const auto& [cell, material] : cells) wanted += material == 2 || material == 3 ? 1 : 0;
    EXPECT_NEAR(volume, wanted, 1e-9);

    const Polyhedron input = with_points(surface, options.region_points);
    const MeshFile mesh = with_region_names(result);
    const VerifyReport good = verified(input, mesh);
    EXPECT_EQ(good.verdict, oracles::Verdict::exact) << to_text(good);
    const auto expect_broken = [](const VerifyReport& report, const char* oracle) {
      EXPECT_EQ(report.verdict, oracles::Verdict::broken) << to_text(report);
      ASSERT_NE(report.find(oracle), nullptr);
      EXPECT_FALSE(report.find(oracle)->passed()) << to_text(report);
    };
    // A region that is called like another material, and one without its name.
    MeshFile lie = mesh;
    std::string& name = lie.names.begin()->second;
    name = name.starts_with("m2") ? "m3" : "m2";
    expect_broken(verified(input, lie), "regions");
    lie = mesh;
    lie.names.erase(lie.names.begin());
    if (!lie.names.empty()) expect_broken(verified(input, lie), "regions");
    // Holes that are meshed, and what is no hole that is not.
    Options filled = options;
    for (auto& p : filled.region_points) p.is_hole = false;
    const Result full = delmesher::tetrahedralize(surface, filled);
    expect_broken(verified(input, with_region_names(full)), "parts");
    expect_broken(verified(with_points(surface, filled.region_points), mesh), "parts");
  }
}

TEST(RegionPoints, AreChosenByNameAndBoundEdges) {
  // A block of 4 x 4 x 4 cells, with one of 2 x 2 x 2 in it.
  Materials cells;
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      for (int z = 0; z < 4; ++z) {
        const bool inner = x % 3 != 0 && y % 3 != 0 && z % 3 != 0;
        cells[{x, y, z}] = inner ? 2 : 1;
      }
    }
  }
  std::mt19937_64 random(kSeed);
  const Surface surface = walls_of(cells, 4, random);
  Options options = all_regions();
  options.region_points = {point_of({0, 0, 0}, 1), point_of({1, 1, 1}, 2)};
  options.region_points[0].max_edge = 1.5;
  const Polyhedron input = with_points(surface, options.region_points);
  const Result fine = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(fine.status.ok());
  const VerifyReport good = verified(input, with_region_names(fine));
  EXPECT_EQ(good.verdict, oracles::Verdict::exact) << to_text(good);
  EXPECT_EQ(good.unproven, std::vector<std::string>());
  options.region_points[0].max_edge = 0;
  const Result coarse = delmesher::tetrahedralize(surface, options);
  EXPECT_EQ(verified(input, with_region_names(coarse)).verdict, oracles::Verdict::broken);

  options.regions = Regions::named;
  options.region_names = {"m2"};
  const Result inner = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(inner.status.ok());
  EXPECT_EQ(inner.regions[0].tetrahedra, 0U);
  EXPECT_NEAR(inner.regions[1].volume, 8, 1e-9);
  options.region_names = {"m3"};
  const Result none = delmesher::tetrahedralize(surface, options);
  EXPECT_EQ(none.status.code, StatusCode::invalid_options);
  EXPECT_EQ(none.status.message, "no region is called \"m3\": there are m1, m2");
}

TEST(RegionPoints, ThatAreNowhereOrContradictEachOther) {
  Builder builder;
  builder.box({0, 0, 0}, {2, 2, 2});
  builder.box({2, 0, 0}, {4, 2, 2});
  Options options = all_regions();
  options.region_points = {{{1, 1, 1}, "a"}, {{2, 1, 0.9}, "wall"}, {{9, 9, 9}, "out"}};
  options.region_points.push_back({{8, 8, 8}, "", 0, true});
  const Result result = delmesher::tetrahedralize(builder.surface(), options);
  ASSERT_TRUE(result.status.ok());
  ASSERT_EQ(result.warnings.size(), 2U);
  EXPECT_TRUE(result.warnings[0].starts_with("region point 2 lies in no region"))
      << result.warnings[0];
  EXPECT_TRUE(result.warnings[1].starts_with("region point 3 ")) << result.warnings[1];
  EXPECT_EQ(std::ranges::count(result.regions, "a", &delmesher::MeshRegion::name), 1);
  options.region_points = {{{1, 1, 1}, "a"}, {{3, 1, 1}, "b"}, {{1.5, 1, 1}, "a"}};
  EXPECT_TRUE(delmesher::tetrahedralize(builder.surface(), options).status.ok());
  options.region_points.push_back({{3.5, 1, 1}, "a"});
  const Result wrong = delmesher::tetrahedralize(builder.surface(), options);
  EXPECT_EQ(wrong.status.code, StatusCode::invalid_options);
  EXPECT_EQ(wrong.status.message,
            "region point 4 calls the region \"a\" that another one calls \"b\": is a wall missing "
            "between them?");
  delmesher::CheckOptions check;
  check.want_regions = true;
  check.region_points = options.region_points;
  const delmesher::SurfaceReport report = delmesher::check_surface(builder.surface(), check);
  EXPECT_EQ(std::ranges::count(report.warnings, wrong.status.message), 1);
}

// In other units, and beside the origin.
TEST(RegionPoints, MoveWithTheSurface) {
  for (const double scale : {1.0, 0x1p-100, 0x1p90, 0x1p-300, 0x1p300}) {
    for (const double away : {0.0, 0x1p30}) {
      Builder builder;
      builder.box({0, 0, 0}, {2, 2, 2});
      builder.box({2, 0, 0}, {4, 2, 2});
      Surface surface = builder.surface();
      Options options = all_regions();
      options.region_points = {{{1, 1, 1}, "a", 1.5}, {{3, 1, 1}, "b"}};
      const auto place = [&](std::array<double, 3>& p) {
        for (double& x : p) x = (x + away) * scale;
      };
      for (auto& p : surface.vertices) place(p);
      for (auto& p : options.region_points) {
        place(p.point);
        p.max_edge *= scale;
      }
      const Result result = delmesher::tetrahedralize(surface, options);
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      ASSERT_EQ(result.regions.size(), 2U);
      EXPECT_EQ(std::ranges::count(result.regions, "a", &delmesher::MeshRegion::name), 1);
      for (const auto& region : result.regions) {
        EXPECT_EQ(region.max_edge, region.name == "a" ? 1.5 * scale : 0);
      }
      MeshFile mesh = with_region_names(result);
      const Polyhedron input = with_points(surface, options.region_points);
      EXPECT_EQ(verified(input, mesh).verdict, oracles::Verdict::exact);
      std::swap(mesh.names[{3, 1}], mesh.names[{3, 2}]);
      EXPECT_EQ(verified(input, mesh).verdict, oracles::Verdict::broken);
    }
  }
}

}  // namespace
}  // namespace tetproof::region_points_test
