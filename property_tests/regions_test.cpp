// Laws of meshes of complexes (Regions::all), decided by the oracles; and what the oracles make of
// such meshes when they are damaged.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <queue>
#include <random>
#include <set>
#include <string>

#include "property_tests/complexes.h"
#include "property_tests/lie.h"

namespace tetproof::regions_test {
namespace {

using namespace complexes;  // NOLINT(google-build-using-namespace)
using complexes::verified;  // besides those here
using delmesher::Regions;
using delmesher::Result;
using delmesher::StatusCode;

// Volumes of the regions that there should be, the largest first.
void expect_regions(const Surface& surface, std::vector<double> volumes) {
  const Result result = delmesher::tetrahedralize(surface, all_regions());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  std::ranges::sort(volumes, std::greater());
  ASSERT_EQ(result.regions.size(), volumes.size());
  for (std::size_t n = 0; n < volumes.size(); ++n) {
    EXPECT_NEAR(result.regions[n].volume, volumes[n], 1e-9 * volumes[0]);
  }
  EXPECT_EQ(result.statistics.left_on_surface, 0U);
  const VerifyReport report =
      verified(samples::to_polyhedron(surface), samples::to_mesh(result.mesh));
  EXPECT_EQ(report.verdict, oracles::Verdict::exact) << to_text(report);
}

// The volumes of what equal cells that share sides make, but for what reaches the border.
std::vector<double> volumes_of(const Materials& materials, int n) {
  std::map<Cell, bool> seen;
  std::vector<double> volumes;
  const auto flood = [&](const Cell& start) {
    double volume = 0;
    bool bounded = true;
    std::queue<Cell> queue;
    queue.push(start);
    seen[start] = true;
    while (!queue.empty()) {
      const Cell cell = queue.front();
      queue.pop();
      ++volume;
      for (int k = 0; k < 6; ++k) {
        Cell next = cell;
        next[k / 2] += k % 2 != 0 ? 1 : -1;
        if (next[k / 2] < -1 || next[k / 2] > n) {
          bounded = false;
        } else if (at(materials, next) == at(materials, cell) && !seen[next]) {
          seen[next] = true;
          queue.push(next);
        }
      }
    }
    if (bounded) volumes.push_back(volume);
  };
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z) {
        if (!seen[{x, y, z}]) flood({x, y, z});
      }
    }
  }
  return volumes;
}

TEST(AllRegions, OfMaterialsInAGrid) {
  for (int i = 0; i < samples::iterations(8); ++i) {
    SCOPED_TRACE(i);
    std::mt19937_64 random(kSeed + static_cast<std::uint64_t>(i));
    const int n = 2 + i % 4, materials = 1 + i % 3;
    Materials cells;
    for (int x = 0; x < n; ++x) {
      for (int y = 0; y < n; ++y) {
        for (int z = 0; z < n; ++z) {
          cells[{x, y, z}] = static_cast<int>(random() % static_cast<unsigned>(materials + 1));
        }
      }
    }
    const std::vector<double> volumes = volumes_of(cells, n);
    if (!volumes.empty()) expect_regions(walls_of(cells, n, random), volumes);
  }
}

// Lengths 1 and root 2 meet at 45 degrees, eight in a plane: points halving them in turn lie on
// each other's spheres.
TEST(AllRegions, OfACheckerboard) {
  constexpr int kSize = 6;
  std::mt19937_64 random(kSeed);
  Materials cells;
  for (int x = 0; x < kSize; ++x) {
    for (int y = 0; y < kSize; ++y) {
      for (int z = 0; z < kSize; ++z) cells[{x, y, z}] = 1 + (x + y + z) % 2;
    }
  }
  expect_regions(walls_of(cells, kSize, random), std::vector<double>(kSize * kSize * kSize, 1));
}

// In one of a few ulp there is no room for a point that leaves an edge.
TEST(AllRegions, OfThinLayers) {
  for (const double thickness : {0.5, 1e-3, 1e-6, 1e-9}) {
    SCOPED_TRACE(thickness);
    Builder builder;
    builder.box({0, 0, 0}, {1, 1, 1}, 1);
    builder.box({0, 0, 1}, {1, 1, 1 + thickness}, 2);
    builder.box({0, 0, 1 + thickness}, {1, 1, 3}, 3);
    expect_regions(builder.surface(), {1, thickness, 2 - thickness});
  }
}

// Sheets round an edge, each cut off by one triangle above and one below to the next.
TEST(AllRegions, OfSheetsRoundAnEdge) {
  for (const int sheets : {3, 5, 16, 64}) {
    SCOPED_TRACE(sheets);
    Builder builder;
    std::vector<double> volumes;
    const double turn = 2 * std::numbers::pi / sheets;
    const auto apex = [&](int k) -> std::array<double, 3> {
      return {std::cos(turn * (k % sheets)), std::sin(turn * (k % sheets)), 0.5};
    };
    for (int k = 0; k < sheets; ++k) {
      builder.triangle({0, 0, 0}, {0, 0, 1}, apex(k));
      builder.triangle({0, 0, 0}, apex(k), apex(k + 1));
      builder.triangle({0, 0, 1}, apex(k), apex(k + 1));
      volumes.push_back(std::sin(turn) / 6);
    }
    expect_regions(builder.surface(), volumes);
  }
}

// A crack that ends inside, one that hangs on a wall, and one that is outside of everything.
TEST(AllRegions, WithSheets) {
  Builder builder;
  builder.box({0, 0, 0}, {4, 4, 4});
  builder.square({1, 1, 2}, {2, 1, 2}, {2, 3, 2.5}, {1, 3, 2.5});
  builder.triangle({0, 0, 4}, {4, 4, 4}, {2, 2, 3});
  const std::size_t inside = builder.surface().triangles.size();
  expect_regions(builder.surface(), {64});
  builder.triangle({5, 5, 5}, {6, 5, 5}, {5, 6, 5});
  expect_regions(builder.surface(), {64});
  const Result result = delmesher::tetrahedralize(builder.surface(), all_regions());
  EXPECT_EQ(result.mesh.boundary.size(), inside);
  // Listed as they are given.
  for (std::size_t n = 0; n < inside; ++n) {
    const auto corner = [&](std::size_t k) {
      return result.mesh.vertices[result.mesh.boundary[n][k]];
    };
    const auto& given = builder.surface().triangles[result.mesh.boundary_facets[n]];
    std::array<std::array<double, 3>, 3> face = {corner(0), corner(1), corner(2)};
    std::rotate(face.begin(), std::ranges::find(face, builder.surface().vertices[given[0]]),
                face.end());
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(face[k], builder.surface().vertices[given[k]]);
  }
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_NE(result.warnings[0].find("1 triangles are left out"), std::string::npos);
}

// Triangles of one plane outside of all regions, hanging on a body: there is nothing to restore.
TEST(AllRegions, WithFlatSheetsOutside) {
  Builder builder;
  builder.box({0, 0, 0}, {4, 4, 4});
  builder.square({4, 0, 0}, {8, 0, 0}, {8, 4, 0}, {4, 4, 0});
  expect_regions(builder.surface(), {64});
  const Result result = delmesher::tetrahedralize(builder.surface(), all_regions());
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_NE(result.warnings[0].find("2 triangles are left out"), std::string::npos);
}

TEST(AllRegions, HaveTheLabelOfTheSmallestSolidAround) {
  Builder builder;
  builder.box({0, 0, 0}, {4, 4, 4}, 7);
  builder.box({1, 1, 1}, {2, 2, 2}, 3);
  builder.box({4, 0, 0}, {6, 4, 4}, 9);
  const Result result = delmesher::tetrahedralize(builder.surface(), all_regions());
  ASSERT_TRUE(result.status.ok());
  ASSERT_EQ(result.regions.size(), 3U);
  EXPECT_EQ(result.regions[0].label, 7);
  EXPECT_EQ(result.regions[1].label, 9);
  EXPECT_EQ(result.regions[2].label, 3);
  // A label whose triangles are not closed bounds nothing.
  Surface torn = builder.surface();
  for (std::size_t t = 0; t < torn.triangles.size(); ++t) {
    if (torn.labels[t] == 3) torn.labels[t] = static_cast<int>(30 + t);
  }
  const Result other = delmesher::tetrahedralize(torn, all_regions());
  ASSERT_EQ(other.regions.size(), 3U);
  EXPECT_EQ(other.regions[2].label, 7);
}

TEST(AllRegions, NeedARegion) {
  Builder builder;
  builder.square({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  EXPECT_EQ(delmesher::tetrahedralize(builder.surface(), all_regions()).status.code,
            StatusCode::invalid_surface);
  builder.triangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  const Result result = delmesher::tetrahedralize(builder.surface(), all_regions());
  EXPECT_EQ(result.status.code, StatusCode::invalid_surface);
  EXPECT_NE(result.status.message.find("bound no region"), std::string::npos);
}

// Solids of cells: for each material all sides, so that walls are given twice.
Surface solids_of(const Materials& materials) {
  Builder builder;
  for (const auto& [cell, material] : materials) {
    for (int side = 0; side < 6; ++side) {
      const int axis = side / 2;
      Cell next = cell;
      next[axis] += side % 2 != 0 ? 1 : -1;
      if (at(materials, next) == material) continue;
      std::array<std::array<double, 3>, 4> corner;
      for (int k = 0; k < 4; ++k) {
        Cell c = cell;
        c[axis] += side % 2;
        c[(axis + 1) % 3] += k == 1 || k == 2 ? 1 : 0;
        c[(axis + 2) % 3] += k >= 2 ? 1 : 0;
        corner[k] = {double(c[0]), double(c[1]), double(c[2])};
      }
      builder.square(corner[0], corner[1], corner[2], corner[3], material);
    }
  }
  return builder.surface();
}

// A cube of 1 with one of 2 in it, and one of 3 beside it that is as large.
Materials three_materials() {
  constexpr int kSize = 6;
  Materials cells;
  for (int x = 0; x < 2 * kSize; ++x) {
    for (int y = 0; y < kSize; ++y) {
      for (int z = 0; z < kSize; ++z) {
        const bool core = x > 1 && x < 4 && y > 1 && y < 4 && z > 1 && z < 4;
        cells[{x, y, z}] = x >= kSize ? 3 : core ? 2 : 1;
      }
    }
  }
  return cells;
}

Options with_names() {
  Options options = all_regions();
  options.label_names = {{1, "shell"}, {2, "core"}, {3, "block"}};
  return options;
}

VerifyReport verified(const Surface& surface, const Result& result, const Options& promised) {
  Polyhedron input = samples::to_polyhedron(surface);
  input.names_read = true;
  for (const auto& [label, name] : with_names().label_names) input.names[{2, label}] = name;
  VerifyReport report;
  EXPECT_EQ(oracles::verify(input, samples::to_mesh(result.mesh), nullptr,
                            {.promised = oracles::promise_of(promised)}, report),
            "");
  return report;
}

// By names, or the largest; each promise is kept by its own mesh, and by no other one.
TEST(SomeRegions, AreThoseThatArePromised) {
  const Surface surface = solids_of(three_materials());
  std::vector<Options> choices(5, with_names());
  const std::vector<std::vector<std::string>> names = {
      {}, {"core"}, {"shell"}, {"core", "block"}, {}};
  for (std::size_t n = 1; n < 4; ++n) {
    choices[n].regions = Regions::named;
    choices[n].region_names = names[n];
  }
  choices[4].regions = Regions::largest;
  std::vector<Result> results;
  for (const Options& choice : choices) {
    results.push_back(delmesher::tetrahedralize(surface, choice));
    ASSERT_TRUE(results.back().status.ok()) << results.back().status.message;
    ASSERT_EQ(results.back().regions.size(), 3U);
  }
  const std::vector<std::set<int>> written = {{1, 2, 3}, {3}, {2}, {1, 3}, {1}};
  for (std::size_t n = 0; n < choices.size(); ++n) {
    const std::vector<std::int32_t>& regions = results[n].mesh.regions;
    EXPECT_EQ(std::set<int>(regions.begin(), regions.end()), written[n]) << n;
    for (std::size_t r = 0; r < 3; ++r) {
      EXPECT_EQ(results[n].regions[r].tetrahedra > 0, written[n].contains(static_cast<int>(r) + 1));
    }
    for (std::size_t m = 0; m < choices.size(); ++m) {
      const VerifyReport report = verified(surface, results[n], choices[m]);
      EXPECT_EQ(report.verdict, n == m ? oracles::Verdict::exact : oracles::Verdict::broken)
          << n << " as " << m << "\n"
          << to_text(report);
      if (n == m) continue;
      const oracles::OracleReport* parts = report.find("parts");
      ASSERT_NE(parts, nullptr);
      EXPECT_FALSE(parts->passed());
    }
  }
}

// The largest part has a cavity, and what is around it has a smaller volume.
TEST(SomeRegions, TheLargestIsMeasuredWithoutCavities) {
  Builder builder;
  builder.box({0, 0, 0}, {5, 5, 5}, 1);
  builder.box({0.5, 0.5, 0.5}, {4.5, 4.5, 4.5}, 2);
  Options options = with_names();
  options.regions = Regions::largest;
  const Result result = delmesher::tetrahedralize(builder.surface(), options);
  ASSERT_TRUE(result.status.ok());
  EXPECT_NEAR(result.regions[0].volume, 64, 1e-9);
  EXPECT_EQ(result.mesh.boundary.size(), 12U);
  const VerifyReport good = verified(builder.surface(), result, options);
  EXPECT_EQ(good.verdict, oracles::Verdict::exact) << to_text(good);
  Options around = with_names();
  around.regions = Regions::named;
  around.region_names = {"shell"};
  const Result other = delmesher::tetrahedralize(builder.surface(), around);
  EXPECT_EQ(verified(builder.surface(), other, options).verdict, oracles::Verdict::broken);
  EXPECT_EQ(verified(builder.surface(), other, around).verdict, oracles::Verdict::exact);
}

// Of two cubes that are equal but for roundings either may be meant; of others the larger one.
TEST(SomeRegions, TheLargestIsOneOfThoseThatAreEqual) {
  for (const double side : {0.1, 0.1001}) {
    Builder builder;
    builder.box({0, 0, 0}, {0.1, 0.1, 0.1}, 1);
    builder.box({0.2, 0.2, 0.2}, {0.2 + side, 0.2 + side, 0.2 + side}, 2);
    Options options = with_names();
    options.regions = Regions::largest;
    const Result result = delmesher::tetrahedralize(builder.surface(), options);
    ASSERT_TRUE(result.status.ok());
    EXPECT_EQ(verified(builder.surface(), result, options).verdict, oracles::Verdict::exact);
    Options first = with_names();
    first.regions = Regions::named;
    first.region_names = {"shell"};
    const Result other = delmesher::tetrahedralize(builder.surface(), first);
    EXPECT_EQ(verified(builder.surface(), other, options).verdict,
              side == 0.1 ? oracles::Verdict::exact : oracles::Verdict::broken);
  }
}

TEST(SomeRegions, NamesOfNothingAreNotPromised) {
  const Surface surface = solids_of(three_materials());
  Options options = with_names();
  options.regions = Regions::named;
  options.region_names = {"core"};
  const Result result = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(result.status.ok());
  Options promised = options;
  promised.region_names.emplace_back("copper");
  EXPECT_EQ(verified(surface, result, promised).verdict, oracles::Verdict::broken);
  promised = options;
  promised.region_sizes = {{"copper", 1}};
  EXPECT_EQ(verified(surface, result, promised).verdict, oracles::Verdict::broken);
}

TEST(SomeRegions, UnknownNamesAreErrorsThatTellTheKnownOnes) {
  const Surface surface = solids_of(three_materials());
  Options options = with_names();
  options.regions = Regions::named;
  options.region_names = {"core", "copper"};
  const Result result = delmesher::tetrahedralize(surface, options);
  EXPECT_EQ(result.status.code, StatusCode::invalid_options);
  EXPECT_EQ(result.status.message, "no region is called \"copper\": there are block, core, shell");
  options = with_names();
  options.region_sizes = {{"copper", 0.5}};
  EXPECT_EQ(delmesher::tetrahedralize(surface, options).status.code, StatusCode::invalid_options);
  options.regions = Regions::solid;
  EXPECT_NE(delmesher::tetrahedralize(surface, options).status.message.find("needs --regions"),
            std::string::npos);
}

TEST(SomeRegions, HaveTheirOwnSizes) {
  const Surface surface = solids_of(three_materials());
  Options options = with_names();
  options.region_sizes = {{"block", 1.5}};
  const Result result = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const VerifyReport report = verified(surface, result, options);
  EXPECT_EQ(report.verdict, oracles::Verdict::exact) << to_text(report);
  EXPECT_TRUE(report.unproven.empty());
  // Elsewhere edges are longer.
  options.region_sizes = {{"block", 1.5}, {"shell", 1.5}};
  const VerifyReport wrong = verified(surface, result, options);
  EXPECT_EQ(wrong.verdict, oracles::Verdict::broken);
  ASSERT_NE(wrong.find("edges"), nullptr);
  EXPECT_FALSE(wrong.find("edges")->passed());
  const Result finer = delmesher::tetrahedralize(surface, options);
  EXPECT_EQ(verified(surface, finer, options).verdict, oracles::Verdict::exact);
  EXPECT_GT(finer.mesh.tetrahedra.size(), result.mesh.tetrahedra.size());
}

TEST(Check, ListsRegionsWallsAndLeaks) {
  Surface surface = solids_of(three_materials());
  delmesher::CheckOptions options;
  options.want_regions = true;
  const delmesher::ComplexReport report = delmesher::check_surface(surface, options).complex;
  ASSERT_EQ(report.regions.size(), 3U);
  EXPECT_NEAR(report.regions[1].volume, 216 - 8, 1e-9);
  EXPECT_EQ(report.regions[1].label, 1);
  std::map<std::array<std::int32_t, 2>, double> area;
  for (const auto& wall : report.walls) area[wall.regions] = wall.area;
  const std::map<std::array<std::int32_t, 2>, double> expected = {
      {{0, 1}, 5 * 36}, {{0, 2}, 5 * 36}, {{1, 2}, 36}, {{2, 3}, 24}};
  EXPECT_EQ(area, expected);
  EXPECT_TRUE(report.open.empty());
  // Without one of its triangles the core is one region with the shell.
  const auto torn = std::ranges::find(surface.labels, 2) - surface.labels.begin();
  const auto gone = surface.triangles[static_cast<std::size_t>(torn)];
  for (std::size_t t = surface.triangles.size(); t-- > 0;) {  // it is given twice
    if (!std::ranges::is_permutation(surface.triangles[t], gone)) continue;
    surface.triangles.erase(surface.triangles.begin() + static_cast<std::ptrdiff_t>(t));
    surface.labels.erase(surface.labels.begin() + static_cast<std::ptrdiff_t>(t));
  }
  const delmesher::ComplexReport leaky = delmesher::check_surface(surface, options).complex;
  ASSERT_EQ(leaky.regions.size(), 2U);
  ASSERT_EQ(leaky.open.size(), 2U);  // the core, and the shell as it was given around it
  EXPECT_EQ(leaky.open[1].label, 2);
  EXPECT_EQ(leaky.open[1].region, leaky.open[0].region);
}

TEST(Check, LooksForRegionsLast) {
  Builder builder;
  for (int n = 0; n < 40; ++n) builder.box({3.0 * n, 0, 0}, {3.0 * n + 2, 2, 2}, n % 2 + 1);
  std::size_t calls = 0, most = 1'000'000;
  delmesher::CheckOptions options;
  options.threads = 1;
  options.progress = [&](const delmesher::Progress&) { return ++calls <= most; };
  const delmesher::SurfaceReport without = delmesher::check_surface(builder.surface(), options);
  most = calls;
  calls = 0;
  options.want_regions = true;
  const delmesher::SurfaceReport stopped = delmesher::check_surface(builder.surface(), options);
  EXPECT_EQ(stopped.status.code, StatusCode::interrupted);
  EXPECT_TRUE(stopped.complex.regions.empty());
  EXPECT_EQ(stopped.facets, without.facets);
  EXPECT_EQ(stopped.facets, 240U);
  EXPECT_GT(stopped.smallest_local_feature_size, 0);
  most = 1'000'000;
  const delmesher::SurfaceReport whole = delmesher::check_surface(builder.surface(), options);
  EXPECT_EQ(whole.complex.regions.size(), 40U);
}

TEST(AllRegions, AreNotRefinedNorRecordedYet) {
  Builder builder;
  builder.box({0, 0, 0}, {1, 1, 1});
  Options options = all_regions();
  options.surface = delmesher::SurfaceChoice::split;
  EXPECT_EQ(delmesher::tetrahedralize(builder.surface(), options).status.code,
            StatusCode::invalid_options);
  options = all_regions();
  options.want_exact = true;
  EXPECT_EQ(delmesher::tetrahedralize(builder.surface(), options).status.code,
            StatusCode::invalid_options);
}

// --- damage

struct Told {
  Polyhedron input;
  MeshFile mesh;
};

// Two boxes beside each other, the second with one inside, and a sheet in the first; with names.
const Told& honest() {
  static const Told told = [] {
    Builder builder;
    builder.box({0, 0, 0}, {4, 4, 4}, 1);
    builder.box({4, 0, 0}, {8, 4, 4}, 2);
    builder.box({5, 1, 1}, {6, 2, 2}, 3);
    builder.square({1, 1, 2}, {2, 1, 2}, {2, 3, 2.5}, {1, 3, 2.5}, 4);
    const Result result = delmesher::tetrahedralize(builder.surface(), all_regions());
    EXPECT_TRUE(result.status.ok());
    Told made{samples::to_polyhedron(builder.surface()), samples::to_mesh(result.mesh)};
    const std::map<int, std::string> names = {{1, "left"}, {2, "right"}, {3, "core"}};
    for (const auto& [label, name] : names) made.input.names[{2, label}] = name;
    for (std::size_t n = 0; n < result.regions.size(); ++n) {
      made.mesh.names[{3, static_cast<std::int64_t>(n + 1)}] =
          names.at(result.regions[n].label.value_or(0));
    }
    return made;
  }();
  return told;
}

void drop_tetrahedra(Told& told, const std::function<bool(std::size_t)>& goes) {
  MeshFile kept = told.mesh;
  kept.tetrahedra.clear();
  kept.regions.clear();
  for (std::size_t t = 0; t < told.mesh.tetrahedra.size(); ++t) {
    if (goes(t)) continue;
    kept.tetrahedra.push_back(told.mesh.tetrahedra[t]);
    kept.regions.push_back(told.mesh.regions[t]);
  }
  told.mesh = kept;
}

std::int64_t region_called(const Told& told, const std::string& name) {
  for (const auto& [key, text] : told.mesh.names) {
    if (text == name) return key.second;
  }
  return 0;
}

void drop_region(Told& told, const char* name) {
  const std::int64_t region = region_called(told, name);
  drop_tetrahedra(told, [&](std::size_t t) { return told.mesh.regions[t] == region; });
}

using Damage = LieAbout<Told>;

const Damage kDamages[] = {
    {"an inner region left out", "parts", [](Told& t) { drop_region(t, "core"); }},
    {"a region beside another left out", "parts", [](Told& t) { drop_region(t, "left"); }},
    {"a tetrahedron left out", "parts",
     [](Told& t) { drop_tetrahedra(t, [](std::size_t n) { return n == 5; }); }},
    {"a tetrahedron turned over", "orientation",
     [](Told& t) { std::swap(t.mesh.tetrahedra[3][0], t.mesh.tetrahedra[3][1]); }},
    {"a second mesh on top", "complex",
     [](Told& t) {
       const auto first = static_cast<oracles::Index>(t.mesh.vertices.size());
       const MeshFile copy = t.mesh;
       t.mesh.vertices.insert(t.mesh.vertices.end(), copy.vertices.begin(), copy.vertices.end());
       for (oracles::Tet tet : copy.tetrahedra) {
         for (auto& v : tet) v += first;
         t.mesh.tetrahedra.push_back(tet);
       }
       t.mesh.regions.insert(t.mesh.regions.end(), copy.regions.begin(), copy.regions.end());
       t.mesh.tetrahedra.push_back(t.mesh.tetrahedra.front());
       t.mesh.regions.push_back(t.mesh.regions.front());
     }},
    {"a mesh over it with vertices of its own", "parts",
     [](Told& t) {
       const auto first = static_cast<oracles::Index>(t.mesh.vertices.size());
       t.mesh.vertices.insert(t.mesh.vertices.end(),
                              {{1, 1, 0.5}, {2, 1, 0.5}, {1, 2, 0.5}, {1, 1, 1}});
       t.mesh.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
       t.mesh.regions.push_back(t.mesh.regions.front());
     }},
    {"two regions with one number", "regions",
     [](Told& t) {
       const std::int64_t one = region_called(t, "core"), other = region_called(t, "right");
       std::ranges::replace(t.mesh.regions, one, other);
     }},
    {"the largest region with another number, and its name", "regions",
     [](Told& t) {
       const std::int64_t one = region_called(t, "core"), other = region_called(t, "right");
       for (std::int64_t& region : t.mesh.regions) {
         region = region == one ? other : region == other ? one : region;
       }
       std::swap(t.mesh.names[{3, one}], t.mesh.names[{3, other}]);
     }},
    {"a tetrahedron of another region", "regions",
     [](Told& t) { t.mesh.regions[7] = t.mesh.regions[7] == 1 ? 2 : 1; }},
    {"names of two regions exchanged", "regions",
     [](Told& t) {
       std::swap(t.mesh.names[{3, region_called(t, "core")}],
                 t.mesh.names[{3, region_called(t, "left")}]);
     }},
    {"the region around called like what is in it", "regions",
     [](Told& t) {
       t.mesh.names[{3, region_called(t, "right")}] = "core";
     }},
    {"a sheet that the mesh does not have", "parts",
     [](Told& t) {
       const auto v = static_cast<oracles::Index>(t.input.vertices.size());
       t.input.vertices.insert(t.input.vertices.end(), {{1, 1, 1}, {2, 1, 1}, {1, 2, 1}});
       t.input.triangles.push_back({v, v + 1, v + 2});
       t.input.labels.push_back(4);
     }},
    {"a wall that is not in the input", "regions",
     [](Told& t) {
       for (std::size_t n = t.input.triangles.size(); n-- > 0;) {
         if (t.input.labels[n] != 3) continue;
         t.input.triangles.erase(t.input.triangles.begin() + static_cast<std::ptrdiff_t>(n));
         t.input.labels.erase(t.input.labels.begin() + static_cast<std::ptrdiff_t>(n));
       }
     }},
    {"a listed triangle with the label of another", "boundary-list",
     [](Told& t) { t.mesh.labels.front() = t.mesh.labels.front() == 2 ? 3 : 2; }},
    {"a triangle not listed", "boundary-list",
     [](Told& t) {
       t.mesh.boundary.pop_back();
       t.mesh.labels.pop_back();
       t.mesh.facets.pop_back();
     }},
    {"a triangle listed twice", "boundary-list",
     [](Told& t) {
       t.mesh.boundary.push_back(t.mesh.boundary.front());
       t.mesh.labels.push_back(t.mesh.labels.front());
       t.mesh.facets.push_back(t.mesh.facets.front());
     }},
    {"a corner of the wall moved", "parts",
     [](Told& t) {
       const auto corner = std::ranges::find(t.mesh.vertices, oracles::Position{4, 0, 0});
       (*corner)[0] = std::nextafter(4, 5);
     }},
    {"an input that crosses itself", "input",
     [](Told& t) {
       const auto v = static_cast<oracles::Index>(t.input.vertices.size());
       t.input.vertices.insert(t.input.vertices.end(), {{9, 1, 1}, {7, 1, 1}, {8, 2, 1}});
       t.input.triangles.push_back({v, v + 1, v + 2});
       t.input.labels.push_back(4);
     }},
};

class RegionDamage : public testing::TestWithParam<Damage> {};

TEST_P(RegionDamage, IsCaughtByTheOracleMeantForIt) {
  Told told = honest();
  const VerifyReport good = verified(told.input, told.mesh);
  ASSERT_EQ(good.verdict, oracles::Verdict::exact) << to_text(good);
  GetParam().tell(told);
  const VerifyReport report = verified(told.input, told.mesh);
  const oracles::OracleReport* oracle = report.find(GetParam().oracle);
  if (oracle == nullptr && std::string(GetParam().oracle) == "input") {
    GTEST_SKIP() << "CGAL is not there";
  }
  ASSERT_NE(oracle, nullptr) << to_text(report);
  EXPECT_FALSE(oracle->passed() || oracle->undecided) << to_text(report);
  EXPECT_EQ(report.verdict, oracles::Verdict::broken);
}

INSTANTIATE_TEST_SUITE_P(All, RegionDamage, testing::ValuesIn(kDamages), test_name<Damage>);

// A wall that is given once for each body, with its label: each way round has one of them.
TEST(AllRegions, TurnedTrianglesAndLabelsOfTheOtherSideAreSaidFirst) {
  Builder builder;
  builder.box({0, 0, 0}, {2, 2, 2}, 1);
  builder.box({2, 0, 0}, {4, 2, 2}, 2);
  const Surface surface = builder.surface();
  const Result result = delmesher::tetrahedralize(surface, all_regions());
  ASSERT_TRUE(result.status.ok());
  const Polyhedron input = samples::to_polyhedron(surface);
  const MeshFile good = samples::to_mesh(result.mesh);
  EXPECT_EQ(verified(input, good).unproven, std::vector<std::string>());
  const auto is_of_wall = [&](const oracles::Face& face) {
    return std::ranges::all_of(face, [&](oracles::Index v) { return good.vertices[v][0] == 2; });
  };
  const auto n = static_cast<std::size_t>(std::ranges::find_if(good.boundary, is_of_wall) -
                                          good.boundary.begin());
  ASSERT_LT(n, good.boundary.size());
  const std::vector<std::string> said = {"listed triangles are as in the input (1 are not)"};
  MeshFile mesh = good;
  mesh.labels[n] = 3 - mesh.labels[n];
  EXPECT_EQ(verified(input, mesh).unproven, said);
  std::swap(mesh.boundary[n][0], mesh.boundary[n][1]);  // the other side, with its label
  EXPECT_EQ(verified(input, mesh).unproven, std::vector<std::string>());
  mesh = good;
  std::swap(mesh.boundary[n][0], mesh.boundary[n][1]);
  EXPECT_EQ(verified(input, mesh).unproven, said);
  mesh = good;
  std::swap(mesh.boundary.front()[0], mesh.boundary.front()[1]);
  EXPECT_EQ(verified(input, mesh).unproven, said);
}

// Vertices are left where more than two triangles meet, and on a wall. Rounded or not, faces stand
// for a triangle; farther off they do not, nor where a tetrahedron is missing.
TEST(AllRegions, MayHaveVerticesLeftOnTriangles) {
  Builder builder;
  builder.box({0, 0, 0}, {2, 2, 2}, 1);
  builder.box({2, 0, 0}, {4, 2, 2}, 2);
  const Polyhedron input = samples::to_polyhedron(builder.surface());
  const Surface split = cut_at(cut_at(builder.surface(), {2, 0, 0}, {2, 0, 2}, {2, 0, 1}),
                               {2, 0, 0}, {2, 2, 2}, {2, 1, 1});
  const Result result = delmesher::tetrahedralize(split, all_regions());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const MeshFile mesh = samples::to_mesh(result.mesh);
  for (const oracles::Position& left : {oracles::Position{2, 0, 1}, {2, 1, 1}}) {
    for (const double off : {0.0, 0x1p-51, -0x1p-51, 0x1p-49, 0x1p-46, -0x1p-46}) {
      for (std::size_t k = 0; k < (left[1] == 0 ? 2 : 1); ++k) {
        MeshFile rounded = mesh;
        const auto number = static_cast<std::size_t>(std::ranges::find(rounded.vertices, left) -
                                                     rounded.vertices.begin());
        ASSERT_LT(number, rounded.vertices.size());
        rounded.vertices[number][k] += off;
        const VerifyReport report = verified(input, rounded);
        const bool near = std::fabs(off) <= 0x1p-48;  // 4 ulp of 4
        EXPECT_EQ(report.verdict, off == 0 ? oracles::Verdict::exact
                                  : near   ? oracles::Verdict::rounded
                                           : oracles::Verdict::broken)
            << off << "\n"
            << to_text(report);
        if (!near) continue;
        EXPECT_EQ(report.deviation > 0, off != 0);
        EXPECT_EQ(report.unproven, std::vector<std::string>{"--regions (4 triangles are split)"});
        Told told{input, rounded};
        const auto has_it = [&](const oracles::Tet& tet) {
          return std::ranges::count(tet, static_cast<oracles::Index>(number)) > 0;
        };
        const auto first = std::ranges::find_if(rounded.tetrahedra, has_it);
        drop_tetrahedra(told, [&](std::size_t t) {
          return t == static_cast<std::size_t>(first - rounded.tetrahedra.begin());
        });
        EXPECT_EQ(verified(told.input, told.mesh).verdict, oracles::Verdict::broken);
      }
    }
  }
}

// A vertex so near to a corner that it may be on either of two sides.
TEST(AllRegions, AreUndecidedWhereVerticesAreNearTwoSides) {
  Builder builder;
  builder.box({0, 0, 0}, {2, 2, 2}, 1);
  builder.box({2, 0, 0}, {4, 2, 2}, 2);
  for (const double off : {0x1p-49, 0x1p-46}) {
    const Surface split = cut_at(builder.surface(), {2, 0, 0}, {2, 0, 2}, {2, 0, off});
    const Result result = delmesher::tetrahedralize(split, all_regions());
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    const VerifyReport report =
        verified(samples::to_polyhedron(builder.surface()), samples::to_mesh(result.mesh));
    const bool near = off <= 0x1p-48;  // 4 ulp of 4
    EXPECT_EQ(report.verdict, near ? oracles::Verdict::undecided : oracles::Verdict::exact)
        << to_text(report);
    // What is wrong elsewhere is known.
    Told told{samples::to_polyhedron(builder.surface()), samples::to_mesh(result.mesh)};
    const auto is_apart = [&](const oracles::Tet& tet) {
      return std::ranges::all_of(tet, [&](oracles::Index v) {
        return told.mesh.vertices[v] != oracles::Position{2, 0, 0} &&
               told.mesh.vertices[v] != oracles::Position{2, 0, off};
      });
    };
    const auto apart = std::ranges::find_if(told.mesh.tetrahedra, is_apart);
    ASSERT_NE(apart, told.mesh.tetrahedra.end());
    const auto number = static_cast<std::size_t>(apart - told.mesh.tetrahedra.begin());
    drop_tetrahedra(told, [&](std::size_t t) { return t == number; });
    EXPECT_EQ(verified(told.input, told.mesh).verdict, oracles::Verdict::broken);
    const Told whole{samples::to_polyhedron(builder.surface()), samples::to_mesh(result.mesh)};
    Told numbered = whole;
    numbered.mesh.regions[number] = 3;
    EXPECT_EQ(verified(numbered.input, numbered.mesh).verdict, oracles::Verdict::broken);
    Told labelled = whole;
    for (std::size_t n = 0; n < labelled.mesh.boundary.size(); ++n) {
      const oracles::Face& face = labelled.mesh.boundary[n];
      if (std::ranges::all_of(face, [&](auto v) { return whole.mesh.vertices[v][0] == 0; })) {
        labelled.mesh.labels[n] = 2;
      }
    }
    EXPECT_EQ(verified(labelled.input, labelled.mesh).verdict, oracles::Verdict::broken);
    Told hollow = whole;
    hollow.input.region_points.push_back({.point = {1, 1, 1}, .is_hole = true});
    EXPECT_EQ(verified(hollow.input, hollow.mesh).verdict, oracles::Verdict::broken);
  }
}

}  // namespace
}  // namespace tetproof::regions_test
