// Laws of walls whose two sides part (Options::split_walls), decided by the oracles and counted;
// and what the oracles make of such meshes when they are damaged.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>

#include "property_tests/complexes.h"
#include "property_tests/lie.h"

namespace tetproof::split_walls_test {
namespace {

using namespace complexes;  // NOLINT(google-build-using-namespace)
using delmesher::Result;
using delmesher::SplitWalls;
using delmesher::StatusCode;

Options splitting(const std::vector<std::string>& names = {}) {
  Options options = all_regions();
  options.split_walls = names.empty() ? SplitWalls::all : SplitWalls::named;
  options.split_wall_names = names;
  return options;
}

// As files have them.
struct Told {
  Polyhedron input;
  MeshFile mesh;
  Options options;
};

Told told(const Surface& surface, const Result& result, const Options& options) {
  Told made{samples::to_polyhedron(surface), samples::to_mesh(result.mesh), options};
  made.input.names_read = made.mesh.has_names = true;
  for (const auto& [label, name] : options.label_names) made.input.names[{2, label}] = name;
  for (const auto& [label, name] : result.wall_names) made.mesh.names[{2, label}] = name;
  return made;
}

VerifyReport verified(const Told& t) {
  VerifyReport report;
  EXPECT_EQ(oracles::verify(t.input, t.mesh, nullptr, {.promised = oracles::promise_of(t.options)},
                            report),
            "");
  return report;
}

Result meshed(const Surface& surface, const Options& options) {
  Result result = delmesher::tetrahedralize(surface, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  const VerifyReport report = verified(told(surface, result, options));
  EXPECT_EQ(report.verdict, oracles::Verdict::exact) << to_text(report);
  return result;
}

std::size_t places(const Result& result) {
  return std::set<std::array<double, 3>>(result.mesh.vertices.begin(), result.mesh.vertices.end())
      .size();
}

// How many regions have each vertex.
std::size_t shared_vertices(const Result& result) {
  std::vector<std::set<std::int32_t>> regions(result.mesh.vertices.size());
  for (std::size_t t = 0; t < result.mesh.tetrahedra.size(); ++t) {
    for (const std::uint32_t v : result.mesh.tetrahedra[t]) {
      regions[v].insert(result.mesh.regions[t]);
    }
  }
  return static_cast<std::size_t>(
      std::ranges::count_if(regions, [](const auto& of) { return of.size() > 1; }));
}

// Where all of a grid is filled, no vertex is left in common.
TEST(SplitWalls, PartAllRegionsOfAGrid) {
  for (int i = 0; i < samples::iterations(6); ++i) {
    SCOPED_TRACE(i);
    std::mt19937_64 random(kSeed + static_cast<std::uint64_t>(i));
    const int n = 2 + i % 3;
    Materials cells;
    for (int x = 0; x < n; ++x) {
      for (int y = 0; y < n; ++y) {
        for (int z = 0; z < n; ++z) cells[{x, y, z}] = 1 + static_cast<int>(random() % 3);
      }
    }
    const Surface surface = walls_of(cells, n, random);
    const Result whole = meshed(surface, all_regions());
    const Result split = meshed(surface, splitting());
    EXPECT_EQ(split.mesh.tetrahedra.size(), whole.mesh.tetrahedra.size());
    EXPECT_EQ(places(split), whole.mesh.vertices.size());
    EXPECT_EQ(shared_vertices(split), 0U);
    EXPECT_EQ(split.statistics.final.vertices, whole.mesh.vertices.size());
  }
}

// With empty cells, and sides that hang together elsewhere.
TEST(SplitWalls, PartWhatWallsAlonePart) {
  for (int i = 0; i < samples::iterations(8); ++i) {
    SCOPED_TRACE(i);
    std::mt19937_64 random(kSeed + 100 + static_cast<std::uint64_t>(i));
    Materials cells;
    for (int x = 0; x < 3; ++x) {
      for (int y = 0; y < 3; ++y) {
        for (int z = 0; z < 3; ++z) cells[{x, y, z}] = static_cast<int>(random() % 4);
      }
    }
    const Surface surface = walls_of(cells, 3, random);
    const Result first = delmesher::tetrahedralize(surface, splitting());
    if (!first.status.ok()) continue;
    meshed(surface, splitting());
    if (first.wall_names.empty()) continue;
    const Result some = meshed(surface, splitting({first.wall_names.begin()->second}));
    EXPECT_EQ(some.wall_names.size(), 2U);
    EXPECT_LE(some.mesh.vertices.size(), first.mesh.vertices.size());
  }
}

// Three boxes in a row, the second beside both.
Surface row(Builder builder = {}) {
  builder.box({0, 0, 0}, {2, 2, 2}, 1);
  builder.box({2, 0, 0}, {4, 2, 2}, 2);
  builder.box({4, 0, 0}, {6, 2, 2}, 3);
  return builder.surface();
}
Options named(Options options) {
  options.label_names = {{1, "copper"}, {2, "air"}, {3, "iron"}, {4, "crack"}};
  return options;
}

TEST(SplitWalls, AreChosenByNames) {
  for (const char* name : {"copper|air", "air|copper", "copper"}) {
    const Result result = meshed(row(), named(splitting({name})));
    EXPECT_EQ(result.mesh.vertices.size(), places(result) + 4);
    using Names = std::map<std::int32_t, std::string>;
    EXPECT_EQ(result.wall_names, (Names{{5, "copper|air"}, {6, "air|copper"}}));
    for (const auto& [label, side] : result.wall_names) {
      EXPECT_EQ(std::ranges::count(result.mesh.boundary_labels, label), 2);
    }
    // Two triangles twice, all as facets of their own.
    EXPECT_EQ(result.mesh.boundary.size(), 3U * 12 - 4 + 2);
    const std::set<std::uint32_t> facets(result.mesh.boundary_facets.begin(),
                                         result.mesh.boundary_facets.end());
    EXPECT_EQ(facets.size(), result.mesh.boundary.size());
  }
  const Result both = meshed(row(), named(splitting({"copper|air", "iron"})));
  EXPECT_EQ(both.mesh.vertices.size(), places(both) + 8);
  Result none = delmesher::tetrahedralize(row(), named(splitting({"copper|iron"})));
  EXPECT_EQ(none.status.code, StatusCode::invalid_options);
  EXPECT_EQ(none.status.message,
            "no wall is called \"copper|iron\": there are air|iron, copper|air");
  Options solid = splitting();
  solid.regions = delmesher::Regions::solid;
  none = delmesher::tetrahedralize(row(), solid);
  EXPECT_EQ(none.status.message, "--split-walls needs --regions");
}

// A sheet with a vertex within: it alone is doubled.
Surface cracked() {
  Builder builder;
  builder.box({0, 0, 0}, {4, 4, 4}, 1);
  const std::array<double, 3> middle = {2, 2, 2.25};
  const std::array<std::array<double, 3>, 4> corner = {
      {{1, 1, 2}, {3, 1, 2}, {3, 3, 2.5}, {1, 3, 2}}};
  for (std::size_t k = 0; k < 4; ++k) builder.triangle(corner[k], corner[(k + 1) % 4], middle, 4);
  return builder.surface();
}

TEST(SplitWalls, OfSheetsStaySingleOnTheBorder) {
  const Result result = meshed(cracked(), named(splitting({"crack"})));
  EXPECT_EQ(result.mesh.vertices.size(), places(result) + 1);
  const std::array<double, 3> middle = {2, 2, 2.25};
  EXPECT_EQ(std::ranges::count(result.mesh.vertices, middle), 2);
  EXPECT_EQ(result.mesh.boundary.size(), 12U + 8);
  std::set<std::string> names;
  for (const auto& [label, name] : result.wall_names) names.insert(name);
  EXPECT_EQ(names, (std::set<std::string>{"crack|back", "crack|front"}));
  // Without one within nothing can part.
  Builder builder;
  builder.box({0, 0, 0}, {4, 4, 4}, 1);
  builder.square({1, 1, 2}, {2, 1, 2}, {2, 3, 2.5}, {1, 3, 2.5}, 4);
  const Result flat = meshed(builder.surface(), splitting());
  EXPECT_EQ(flat.mesh.vertices.size(), places(flat));
  EXPECT_TRUE(flat.wall_names.empty());
  EXPECT_EQ(flat.mesh.boundary.size(), 14U);
}

// --- damage

const Told& honest() {
  static const Told made = [] {
    Builder builder;
    const std::array<double, 3> middle = {5, 1, 1.25};
    const std::array<std::array<double, 3>, 4> corner = {
        {{4.5, 0.5, 1}, {5.5, 0.5, 1}, {5.5, 1.5, 1}, {4.5, 1.5, 1.5}}};
    for (std::size_t k = 0; k < 4; ++k) builder.triangle(corner[k], corner[(k + 1) % 4], middle, 4);
    const Surface surface = row(builder);
    const Options options = named(splitting({"copper|air", "crack"}));
    return told(surface, delmesher::tetrahedralize(surface, options), options);
  }();
  return made;
}

std::vector<oracles::Index> at(const Told& t, const oracles::Position& p) {
  std::vector<oracles::Index> found;
  for (oracles::Index v = 0; v < t.mesh.vertices.size(); ++v) {
    if (t.mesh.vertices[v] == p) found.push_back(v);
  }
  return found;
}

std::size_t listed(const Told& t, const std::string& set) {
  for (std::size_t n = 0; n < t.mesh.boundary.size(); ++n) {
    const auto name = t.mesh.names.find({2, t.mesh.labels[n]});
    if (name != t.mesh.names.end() && name->second == set) return n;
  }
  return 0;
}

void replace(Told& t, oracles::Index from, oracles::Index to) {
  for (auto& tet : t.mesh.tetrahedra) std::ranges::replace(tet, from, to);
  for (auto& face : t.mesh.boundary) std::ranges::replace(face, from, to);
}

using Damage = LieAbout<Told>;
constexpr oracles::Position kOnWall = {2, 0, 0}, kInCrack = {5, 1, 1.25};

const Damage kDamages[] = {
    {"a vertex of a wall is not doubled", "split-walls",
     [](Told& t) {
       const auto both = at(t, kOnWall);
       replace(t, both[1], both[0]);
     }},
    {"a vertex of a sheet is not doubled", "split-walls",
     [](Told& t) {
       const auto both = at(t, kInCrack);
       replace(t, both[1], both[0]);
     }},
    {"only the spare vertex is left", "split-walls",
     [](Told& t) { t.mesh.vertices.push_back(t.mesh.vertices[at(t, kOnWall)[0]]); }},
    {"a vertex is torn on no wall", "split-walls",
     [](Told& t) {
       const auto v = at(t, {0, 0, 0})[0];
       t.mesh.vertices.push_back(t.mesh.vertices[v]);
       for (auto& tet : t.mesh.tetrahedra) {
         const auto corner = std::ranges::find(tet, v);
         if (corner == tet.end()) continue;
         *corner = static_cast<oracles::Index>(t.mesh.vertices.size() - 1);
         break;
       }
     }},
    {"a vertex on the border of a sheet is doubled", "split-walls",
     [](Told& t) {
       const auto v = at(t, {4.5, 0.5, 1})[0];
       t.mesh.vertices.push_back(t.mesh.vertices[v]);
       const auto copy = static_cast<oracles::Index>(t.mesh.vertices.size() - 1);
       const auto middle = at(t, kInCrack)[0];
       for (auto& tet : t.mesh.tetrahedra) {
         if (std::ranges::count(tet, middle) > 0) std::ranges::replace(tet, v, copy);
       }
     }},
    {"another wall is split, too", "split-walls",
     [](Told& t) {
       const Options options = named(splitting({"copper|air", "iron|air", "crack"}));
       const Surface surface = samples::to_surface(t.input);
       t = told(surface, delmesher::tetrahedralize(surface, options), t.options);
     }},
    {"one wall is not split", "split-walls",
     [](Told& t) {
       t.options = named(splitting({"copper|air", "iron|air", "crack"}));
     }},
    {"a wall that is not there", "split-walls",
     [](Told& t) { t.options.split_wall_names.push_back("copper|iron"); }},
    {"the two sides are a rounding apart", "split-walls",
     [](Told& t) { t.mesh.vertices[at(t, kOnWall)[1]][0] = std::nextafter(2, 3); }},
    {"a side is not listed", "split-walls",
     [](Told& t) {
       const auto n = static_cast<std::ptrdiff_t>(listed(t, "air|copper"));
       t.mesh.boundary.erase(t.mesh.boundary.begin() + n);
       t.mesh.labels.erase(t.mesh.labels.begin() + n);
       t.mesh.facets.erase(t.mesh.facets.begin() + n);
     }},
    {"one side is listed for both", "split-walls",
     [](Told& t) {
       const std::size_t n = listed(t, "air|copper"), m = listed(t, "copper|air");
       t.mesh.boundary[m] = t.mesh.boundary[n];
     }},
    {"a side is seen from within", "split-walls",
     [](Told& t) {
       auto& face = t.mesh.boundary[listed(t, "crack|front")];
       std::swap(face[0], face[1]);
     }},
    {"the names of the sides are exchanged", "split-walls",
     [](Told& t) {
       for (auto& [key, name] : t.mesh.names) {
         if (key.first != 2) continue;
         name = name == "crack|front" ? "crack|back" : name == "crack|back" ? "crack|front" : name;
       }
     }},
    {"a listed triangle has a vertex of the other side", "split-walls",
     [](Told& t) {
       const auto both = at(t, kOnWall);
       for (auto& face : t.mesh.boundary) {
         const auto corner = std::ranges::find(face, both[0]);
         if (corner == face.end()) continue;
         *corner = both[1];
         break;
       }
     }},
    {"a tetrahedron left out", "parts", [](Told& t) {
       t.mesh.tetrahedra.erase(t.mesh.tetrahedra.begin() + 3);
       t.mesh.regions.erase(t.mesh.regions.begin() + 3);
     }}};

class SplitDamage : public testing::TestWithParam<Damage> {};

TEST_P(SplitDamage, IsCaughtByTheOracleMeantForIt) {
  Told lie = honest();
  const VerifyReport good = verified(lie);
  ASSERT_EQ(good.verdict, oracles::Verdict::exact) << to_text(good);
  GetParam().tell(lie);
  const VerifyReport report = verified(lie);
  const oracles::OracleReport* oracle = report.find(GetParam().oracle);
  ASSERT_NE(oracle, nullptr) << to_text(report);
  EXPECT_FALSE(oracle->passed() || oracle->undecided) << to_text(report);
  EXPECT_EQ(report.verdict, oracles::Verdict::broken);
}

INSTANTIATE_TEST_SUITE_P(All, SplitDamage, testing::ValuesIn(kDamages), test_name<Damage>);

// A vertex is left on a wall, so that two of its triangles are two faces each.
TEST(SplitWalls, KnowTrianglesInParts) {
  const Options options = named(splitting({"copper|air"}));
  const Surface given = row();
  const Surface parts = cut_at(given, {2, 0, 0}, {2, 2, 2}, {2, 1, 1});
  const Result result = delmesher::tetrahedralize(parts, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const Told good = told(given, result, options);
  const VerifyReport report = verified(good);
  EXPECT_EQ(report.verdict, oracles::Verdict::exact) << to_text(report);
  EXPECT_EQ(report.unproven, std::vector<std::string>{"--regions (2 triangles are split)"});
  // One vertex there, or the sets of both sides exchanged.
  Told joined = good;
  const auto both = at(joined, {2, 1, 1});
  replace(joined, both[1], both[0]);
  EXPECT_EQ(verified(joined).verdict, oracles::Verdict::broken);
  Told exchanged = good;
  for (auto& [key, name] : exchanged.mesh.names) {
    if (key.first != 2) continue;
    name = name == "copper|air" ? "air|copper" : name == "air|copper" ? "copper|air" : name;
  }
  EXPECT_EQ(verified(exchanged).verdict, oracles::Verdict::broken);
}

// Nobody asked for it.
TEST(SplitWalls, AreBrokenIfNotPromised) {
  Told lie = honest();
  lie.options = named(all_regions());
  EXPECT_EQ(verified(lie).verdict, oracles::Verdict::broken);
}

}  // namespace
}  // namespace tetproof::split_walls_test
