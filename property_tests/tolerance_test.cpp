// Meshes within a tolerance, as the oracles judge them; and meshes of surfaces that differ from the
// input by what a tolerance does not allow.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "mesher/delmesher.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::tolerance_test {
namespace {

using delmesher::Options;
using delmesher::Result;
using delmesher::Surface;
using oracles::Verdict;
using oracles::VerifyReport;
using Point = std::array<double, 3>;

constexpr std::uint64_t kSeed = 20261129;
constexpr double kTolerance = 0.05;

Options within(double tolerance) {
  Options options;
  options.tolerance = tolerance;
  return options;
}

// Cells of a grid of any spacing; the sides of the solid have the labels 1 to 6, or those of
// `label`.
struct Grid {
  std::vector<std::vector<double>> at;
  std::function<bool(int, int, int)> solid = [](int, int, int) { return true; };
  std::function<int(int side, const Point& low)> label = [](int side, const Point&) {
    return side + 1;
  };
};

Surface surface_of(const Grid& grid) {
  Surface surface;
  std::map<std::array<int, 3>, std::uint32_t> number;
  const auto vertex = [&](const std::array<int, 3>& i) {
    const auto [at, fresh] = number.try_emplace(i, surface.vertices.size());
    if (fresh) surface.vertices.push_back({grid.at[0][i[0]], grid.at[1][i[1]], grid.at[2][i[2]]});
    return at->second;
  };
  const auto is_solid = [&](const std::array<int, 3>& i) {
    for (int axis = 0; axis < 3; ++axis) {
      if (i[axis] < 0 || i[axis] + 1 >= std::ssize(grid.at[axis])) return false;
    }
    return grid.solid(i[0], i[1], i[2]);
  };
  const auto cells = [&](int axis) { return static_cast<int>(grid.at[axis].size()) - 1; };
  for (int x = 0; x < cells(0); ++x) {
    for (int y = 0; y < cells(1); ++y) {
      for (int z = 0; z < cells(2); ++z) {
        if (!is_solid({x, y, z})) continue;
        for (int side = 0; side < 6; ++side) {
          const int axis = side / 2, up = side % 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
          std::array<int, 3> beside = {x, y, z}, low = {x, y, z};
          beside[axis] += up == 1 ? 1 : -1;
          if (is_solid(beside)) continue;
          low[axis] += up;
          std::array<int, 3> b = low, c = low, d = low;
          ++b[u], ++c[u], ++c[v], ++d[v];
          if (up == 0) std::swap(b, d);
          for (const auto& [p, q] : {std::pair(b, c), std::pair(c, d)}) {
            surface.triangles.push_back({vertex(low), vertex(p), vertex(q)});
            surface.labels.push_back(
                grid.label(side, {grid.at[0][low[0]], grid.at[1][low[1]], grid.at[2][low[2]]}));
          }
        }
      }
    }
  }
  return surface;
}

std::vector<double> steps(int n, double to = 1) {
  std::vector<double> at;
  for (int i = 0; i <= n; ++i) at.push_back(to * i / n);
  return at;
}

Surface cube() {
  return surface_of({.at = {steps(1), steps(1), steps(1)}});
}

// n by 2n points around an axis; `radius` by the two angles.
Surface sphere(int n, const std::function<double(double, double)>& radius) {
  Surface surface;
  const int around = 2 * n;
  const auto place = [&](double theta, double phi) {
    const double r = radius(theta, phi);
    surface.vertices.push_back({r * std::sin(theta) * std::cos(phi),
                                r * std::sin(theta) * std::sin(phi), r * std::cos(theta)});
  };
  place(0, 0);
  for (int i = 1; i < n; ++i) {
    for (int j = 0; j < around; ++j) {
      place(std::numbers::pi * i / n, 2 * std::numbers::pi * j / around);
    }
  }
  place(std::numbers::pi, 0);
  const auto last = static_cast<std::uint32_t>(surface.vertices.size()) - 1;
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(1 + (i - 1) * around + j % around);
  };
  for (int j = 0; j < around; ++j) {
    surface.triangles.push_back({0, at(1, j), at(1, j + 1)});
    surface.triangles.push_back({last, at(n - 1, j + 1), at(n - 1, j)});
    for (int i = 1; i + 1 < n; ++i) {
      surface.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      surface.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return surface;
}

Surface noisy_sphere(int n, double noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> some(1 - noise, 1 + noise);
  return sphere(n, [&](double, double) { return some(random); });
}

Surface torus(int n, double thickness) {
  Surface surface;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / n;
      const double r = 1 + thickness * std::cos(v);
      surface.vertices.push_back({r * std::cos(u), r * std::sin(u), thickness * std::sin(v)});
    }
  }
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(i % n * n + j % n); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      surface.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      surface.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return surface;
}

void add(const Surface& other, bool turned, Surface& surface) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (auto triangle : other.triangles) {
    for (auto& v : triangle) v += first;
    if (turned) std::swap(triangle[0], triangle[1]);
    surface.triangles.push_back(triangle);
  }
}

VerifyReport judged(const Surface& input, const Surface& meshed, const Options& asked,
                    const Options& promised) {
  const Result result = delmesher::tetrahedralize(meshed, asked);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  VerifyReport report;
  EXPECT_EQ(oracles::verify(samples::to_polyhedron(input), samples::to_mesh(result.mesh), nullptr,
                            {.promised = oracles::promise_of(promised)}, report),
            "");
  return report;
}

std::set<std::string> failures(const VerifyReport& report) {
  std::set<std::string> names;
  for (const oracles::OracleReport& oracle : report.oracles) {
    if (!oracle.passed() && oracle.promised) names.insert(oracle.name);
  }
  return names;
}

// The oracles that do not take an exact mesh of `other` for one of the input within the tolerance.
std::set<std::string> failures(const Surface& input, const Surface& other) {
  return failures(judged(input, other, {}, within(kTolerance)));
}

using Names = std::set<std::string>;

struct Model {
  std::string name;
  Surface surface;
};

void PrintTo(const Model& model, std::ostream* stream) {
  *stream << model.name;
}

std::vector<Model> models() {
  Surface shells = sphere(12, [](double, double) { return 1; });
  add(sphere(12, [](double, double) { return 0.97; }), true, shells);
  Surface near = sphere(10, [](double, double) { return 1; });
  Surface beside = near;
  for (Point& p : beside.vertices) p[0] += 2.002;
  add(beside, false, near);
  return {{"smooth_sphere", sphere(16, [](double, double) { return 1; })},
          {"noisy_sphere", noisy_sphere(12, 0.02, kSeed)},
          {"rough_sphere", noisy_sphere(8, 0.2, kSeed)},
          {"near_shells", shells},
          {"near_spheres", near},
          {"torus", torus(14, 0.3)},
          {"thin_torus", torus(12, 0.02)},
          {"box_with_labels", surface_of({.at = {steps(5), steps(4), steps(3)}})},
          {"thin_plate", surface_of({.at = {steps(8), steps(8), steps(1, 1e-3)}})},
          {"needle", surface_of({.at = {steps(3, 100), steps(1), steps(1)}})},
          {"plate_with_slots",
           surface_of({.at = {{0, 1, 1.01, 2, 2.5, 3}, {0, 1, 1.02, 2}, {0, 0.5}},
                       .solid = [](int x, int y, int) { return y != 1 || x % 2 == 0; }})},
          {"labels_in_a_plane",
           surface_of({.at = {steps(8), steps(8), steps(1)},
                       .label = [](int, const Point& p) { return p[0] + p[1] < 0.9 ? 1 : 2; }})},
          {"voxels", samples::random_voxels(kSeed)},
          {"star", samples::quantized_star(kSeed)},
          {"fin", samples::finned_cube(0.03, 1e-3)},
          {"wedge_and_slab", samples::wedge_and_slab()}};
}

class WithinTolerance : public testing::TestWithParam<Model> {};

TEST_P(WithinTolerance, MeshesKeepTheirPromise) {
  const Surface& surface = GetParam().surface;
  for (const double share : {3e-2, 1e-2, 1e-3}) {
    const VerifyReport report = judged(surface, surface, within(-share), within(-share));
    EXPECT_EQ(report.verdict, Verdict::deviating) << share << to_text(report);
    EXPECT_FALSE(oracles::failed(report, {.promised = oracles::promise_of(within(-share))}));
  }
}

INSTANTIATE_TEST_SUITE_P(OfGeneratedSurfaces, WithinTolerance, testing::ValuesIn(models()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Tolerance, AnExactMeshIsWithinIt) {
  for (const Model& model : models()) {
    EXPECT_EQ(failures(judged(model.surface, model.surface, {}, within(-1e-3))), Names())
        << model.name;
  }
}

// Everything is nearer than the tolerance.
TEST(Tolerance, ShellsAndHandlesStay) {
  const auto plate = [](bool hole) {
    return surface_of({.at = {{0, 0.5, 0.54, 1}, {0, 0.5, 0.54, 1}, {0, 0.04}},
                       .solid = [hole](int x, int y, int) { return !hole || x != 1 || y != 1; },
                       .label = [](int, const Point&) { return 0; }});
  };
  // The lines of the hole are as near to the edges of the mesh, which has the same grid.
  EXPECT_EQ(failures(plate(true), plate(false)), Names{"envelope-topology"});
  EXPECT_TRUE(failures(plate(false), plate(true)).contains("envelope-topology"));

  Surface two = cube();
  two.labels.clear();
  const Surface one = two;
  samples::add_box(two, {1.005, 0.975, 0.975}, {1.02, 0.985, 0.985});
  EXPECT_EQ(failures(two, one), Names{"envelope-topology"});
  EXPECT_TRUE(failures(one, two).contains("envelope-topology"));

  Surface hollow = one, hole;
  samples::add_box(hole, {0.975, 0.975, 0.975}, {0.985, 0.985, 0.985});
  add(hole, true, hollow);
  EXPECT_EQ(failures(hollow, one), Names{"envelope-topology"});
  // Not even in the place of another one.
  EXPECT_TRUE(failures(hollow, two).contains("envelope-topology"));
}

TEST(Tolerance, LabelsStay) {
  Surface swapped = cube();
  for (auto& label : swapped.labels) label = label == 1 ? 2 : label == 2 ? 1 : label;
  EXPECT_EQ(failures(cube(), swapped), Names{"envelope-labels"});
  Surface fewer = cube();
  for (auto& label : fewer.labels) label = std::min(label, 5);
  EXPECT_EQ(failures(cube(), fewer), Names{"envelope-labels"});
  EXPECT_EQ(failures(fewer, cube()), Names{"envelope-labels"});
  // Borders in a plane.
  const auto halves = [](double at) {
    return surface_of(
        {.at = {{0, at, 1}, steps(1), steps(1)},
         .label = [at](int side, const Point& p) { return side == 5 && p[0] >= at ? 7 : 1; }});
  };
  EXPECT_EQ(failures(halves(0.5), halves(0.5 + 0.8 * kTolerance)), Names());
  EXPECT_EQ(failures(halves(0.5), halves(0.5 + 1.5 * kTolerance)),
            (Names{"envelope-labels", "envelope-lines"}));
}

// A box with a roof, of slopes of 25 degrees.
Surface roof(double ridge) {
  const double height = std::tan(25 * std::numbers::pi / 180);
  Surface surface;
  for (const double y : {0.0, 1.0}) {
    for (const Point& p :
         {Point{-1, y, -1}, {1, y, -1}, {1, y, 0}, {ridge, y, height}, {-1, y, 0}}) {
      surface.vertices.push_back(p);
    }
  }
  surface.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {5, 7, 6}, {5, 8, 7}, {5, 9, 8}};
  for (std::uint32_t i = 0; i < 5; ++i) {
    const std::uint32_t j = (i + 1) % 5;
    surface.triangles.push_back({j, i, i + 5});
    surface.triangles.push_back({j, i + 5, j + 5});
  }
  return surface;
}

TEST(Tolerance, LinesAndCornersStay) {
  EXPECT_EQ(failures(roof(0), roof(0.9 * kTolerance)), Names());
  EXPECT_EQ(failures(roof(0), roof(1.5 * kTolerance)), Names{"envelope-lines"});
  // Where no line was.
  const std::vector<double> narrow = {0, 0.46, 0.5, 0.54, 1};
  const Surface flat =
      surface_of({.at = {narrow, narrow, steps(1)}, .label = [](int, const Point&) { return 0; }});
  Surface spiked = flat;
  for (Point& p : spiked.vertices) {
    if (p == Point{0.5, 0.5, 1}) p[2] += 0.9 * kTolerance;
  }
  EXPECT_EQ(failures(flat, spiked), Names{"envelope-lines"});

  Surface whole = cube();
  whole.labels.clear();
  const auto cut = [&](double by) {
    Surface surface = whole;
    const auto corner = static_cast<std::uint32_t>(
        std::ranges::find(surface.vertices, Point{0, 0, 0}) - surface.vertices.begin());
    std::map<std::uint32_t, std::uint32_t> on;  // by the other end of an edge
    std::vector<std::array<std::uint32_t, 3>> made;
    const auto place = [&](std::uint32_t v) {
      const auto [at, fresh] = on.try_emplace(v, surface.vertices.size());
      if (fresh) {
        Point p = surface.vertices[v];
        const double length = std::hypot(p[0], p[1], p[2]);
        for (double& x : p) x *= by / length;
        surface.vertices.push_back(p);
      }
      return at->second;
    };
    std::map<std::uint32_t, std::uint32_t> next;  // around the cut
    for (auto t : surface.triangles) {
      const auto at = std::ranges::find(t, corner);
      if (at == t.end()) {
        made.push_back(t);
        continue;
      }
      std::rotate(t.begin(), at, t.end());
      const std::uint32_t p = place(t[1]), q = place(t[2]);
      made.push_back({p, t[1], t[2]});
      made.push_back({p, t[2], q});
      next[q] = p;
    }
    const std::uint32_t first = next.begin()->first;
    for (std::uint32_t a = next[first], b = next[a]; b != first; a = b, b = next[b]) {
      made.push_back({first, b, a});
    }
    surface.triangles = made;
    return surface;
  };
  EXPECT_EQ(failures(whole, cut(0.9 * kTolerance)), Names());
  EXPECT_EQ(failures(whole, cut(1.2 * kTolerance)), Names{"envelope-lines"});
}

// A fin that stands on a side: to its longest edge, which bends by 45 degrees, belong edges of the
// mesh, unless the fin is lower than the tolerance.
TEST(Tolerance, LinesStayUnlessLowTrianglesMakeThem) {
  for (const double high : {10 * kTolerance, 0.5 * kTolerance, 1e-6}) {
    Surface s;
    s.vertices = {{0, 0, 0},   {40, 0, 0},  {40, 30, 0},
                  {0, 30, 0},  //
                  {0, 0, 5},   {40, 0, 5},  {40, 30, 5},
                  {0, 30, 5},  //
                  {10, 10, 5}, {30, 10, 5}, {20, 10 + high, 5 + high}};
    s.triangles = {{0, 2, 1}, {0, 3, 2},  {0, 1, 5}, {0, 5, 4},  {1, 2, 6},  {1, 6, 5},
                   {2, 3, 7}, {2, 7, 6},  {3, 0, 4}, {3, 4, 7},  {4, 5, 8},  {5, 9, 8},
                   {5, 6, 9}, {6, 7, 10}, {7, 4, 8}, {7, 8, 10}, {6, 10, 9}, {8, 9, 10}};
    const Result result = delmesher::tetrahedralize(s, within(kTolerance));
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.statistics.lines_lost, 0U);
    std::map<double, std::uint32_t> on_line;  // by x
    for (std::uint32_t v = 0; v < result.mesh.vertices.size(); ++v) {
      const Point& p = result.mesh.vertices[v];
      if (p[1] == 10 && p[2] == 5) on_line[p[0]] = v;
    }
    if (high < kTolerance) {
      EXPECT_TRUE(on_line.empty());
      continue;
    }
    ASSERT_TRUE(on_line.contains(10) && on_line.contains(30));
    std::set<std::array<std::uint32_t, 2>> edges;
    for (const auto& t : result.mesh.boundary) {
      for (std::size_t k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
    }
    for (auto at = on_line.find(10); at->first < 30; ++at) {
      EXPECT_TRUE(edges.contains({at->second, std::next(at)->second})) << at->first;
    }
  }
}

TEST(Tolerance, NothingIsFartherAway) {
  const auto moved = [](double by) {
    Surface surface = surface_of(
        {.at = {steps(4), steps(4), steps(4)}, .label = [](int, const Point&) { return 0; }});
    for (Point& p : surface.vertices) {
      if (p == Point{0.5, 0.5, 1}) p[2] += by;
    }
    return surface;
  };
  const Names farther = {"envelope"};  // there is one label
  EXPECT_EQ(failures(moved(0), moved(0.9 * kTolerance)), Names());
  EXPECT_EQ(failures(moved(0), moved(1.5 * kTolerance)), farther);
  EXPECT_EQ(failures(moved(0), moved(-1.5 * kTolerance)), farther);
}

// A file that lists no labels, or some.
TEST(Tolerance, LabelsThatAreNotListedAreNotProven) {
  const Surface surface = cube();
  const Result result = delmesher::tetrahedralize(surface, within(kTolerance));
  ASSERT_TRUE(result.status.ok());
  oracles::MeshFile mesh = samples::to_mesh(result.mesh);
  const oracles::VerifyOptions options = {.promised = oracles::promise_of(within(kTolerance))};
  VerifyReport report;
  const auto judge = [&] {
    EXPECT_EQ(oracles::verify(samples::to_polyhedron(surface), mesh, nullptr, options, report), "");
  };
  judge();
  EXPECT_EQ(failures(report), Names());
  mesh.boundary.pop_back();
  mesh.labels.pop_back();
  judge();
  EXPECT_EQ(failures(report), Names{"envelope-labels"});
  mesh.boundary.clear();
  mesh.labels.clear();
  judge();
  EXPECT_EQ(failures(report), Names());
  EXPECT_NE(std::ranges::find(report.unproven, "labels"), report.unproven.end());
}

}  // namespace
}  // namespace tetproof::tolerance_test
