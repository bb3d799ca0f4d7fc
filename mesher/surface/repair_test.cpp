// Clean surfaces made dirty in many ways, and mended.
#include "mesher/surface/repair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "mesher/delmesher.h"

namespace delmesher::surface::repair_test {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Point = std::array<double, 3>;

double volume(const Surface& s) {
  double sum = 0;
  for (const auto& [i, j, k] : s.triangles) {
    const Point &a = s.vertices[i], &b = s.vertices[j], &c = s.vertices[k];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

// Multiples of 2^-20, so that middles of edges are exactly on them.
double grid(double x) {
  return std::round(x * 0x1p20) * 0x1p-20;
}

Surface cube() {
  Surface s;
  for (int v = 0; v < 8; ++v)
    s.vertices.push_back({double(v & 1), double(v >> 1 & 1), double(v >> 2)});
  s.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return s;
}

// n times n rectangles, each cut in two.
Surface torus(std::uint32_t n) {
  Surface s;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / n;
      const double r = 3 + std::cos(v);
      s.vertices.push_back({grid(r * std::cos(u)), grid(r * std::sin(u)), grid(std::sin(v))});
      const auto at = [n](std::uint32_t a, std::uint32_t b) { return a % n * n + b % n; };
      s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return s;
}

Surface ball() {
  Surface s;
  constexpr std::uint32_t kRings = 11, kSlices = 16;
  s.vertices = {{0, 0, 1}, {0, 0, -1}};
  for (std::uint32_t r = 0; r < kRings; ++r) {
    for (std::uint32_t k = 0; k < kSlices; ++k) {
      const double polar = std::numbers::pi * (r + 1) / (kRings + 1);
      const double around = 2 * std::numbers::pi * k / kSlices;
      s.vertices.push_back({grid(std::sin(polar) * std::cos(around)),
                            grid(std::sin(polar) * std::sin(around)), grid(std::cos(polar))});
    }
  }
  const auto at = [](std::uint32_t r, std::uint32_t k) { return 2 + r * kSlices + k % kSlices; };
  for (std::uint32_t k = 0; k < kSlices; ++k) {
    s.triangles.push_back({0, at(0, k), at(0, k + 1)});
    s.triangles.push_back({1, at(kRings - 1, k + 1), at(kRings - 1, k)});
    for (std::uint32_t r = 0; r + 1 < kRings; ++r) {
      s.triangles.push_back({at(r, k), at(r + 1, k), at(r + 1, k + 1)});
      s.triangles.push_back({at(r, k), at(r + 1, k + 1), at(r, k + 1)});
    }
  }
  return s;
}

// Every triangle gets vertices of its own, moved by up to `by`.
void tear(Surface& s, double by) {
  std::mt19937 random(7);
  const auto shift = [&] { return by * (static_cast<double>(random()) / 4294967295.0 * 2 - 1); };
  std::vector<Point> own;
  for (Triangle& t : s.triangles) {
    for (std::uint32_t& v : t) {
      const Point p = s.vertices[v];
      v = static_cast<std::uint32_t>(own.size());
      own.push_back({p[0] + shift(), p[1] + shift(), p[2] + shift()});
    }
  }
  s.vertices = own;
}

std::uint32_t add_middle(Surface& s, std::uint32_t a, std::uint32_t b) {
  Point m;
  for (std::size_t k = 0; k < 3; ++k) m[k] = (s.vertices[a][k] + s.vertices[b][k]) / 2;
  s.vertices.push_back(m);
  return static_cast<std::uint32_t>(s.vertices.size() - 1);
}

void remove_star(Surface& s, std::uint32_t v) {
  std::erase_if(s.triangles,
                [&](const Triangle& t) { return t[0] == v || t[1] == v || t[2] == v; });
}

struct Dirt {
  const char* name;
  std::function<void(Surface&)> add;
  RepairOptions options;
  double error;  // of the volume, relative, at most
};

std::vector<Dirt> all_dirt() {
  const RepairOptions plain, weld = {.weld = 1e-5}, fill = {.weld = 0, .fill = true};
  constexpr double kSame = 1e-12, kMoved = 1e-4;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  return {
      {"torn apart", [](Surface& s) { tear(s, 0); }, plain, kSame},
      {"torn and moved a little", [](Surface& s) { tear(s, 1e-6); }, weld, kMoved},
      {"a triangle twice", [](Surface& s) { s.triangles.push_back(s.triangles[3]); }, plain, kSame},
      {"a triangle and its back",
       [](Surface& s) {
         const auto [a, b, c] = s.triangles[3];
         s.triangles.push_back({a, c, b});
       },
       plain, kSame},
      {"a flap of two backs",
       [](Surface& s) {
         const auto [a, b, c] = s.triangles[3];
         const std::uint32_t m = add_middle(s, a, b);
         s.vertices[m][2] += 0.25;
         s.triangles.push_back({a, m, c});
         s.triangles.push_back({a, c, m});
       },
       plain, kSame},
      {"every fourth triangle turned round",
       [](Surface& s) {
         for (std::size_t t = 0; t < s.triangles.size(); t += 4) {
           std::swap(s.triangles[t][0], s.triangles[t][1]);
         }
       },
       plain, kSame},
      {"a triangle missing", [](Surface& s) { s.triangles.erase(s.triangles.begin() + 5); }, fill,
       kSame},
      {"two triangles missing",
       [](Surface& s) {
         const std::size_t other = s.triangles.size() == 12 ? 11 : s.triangles.size() / 2 + 5;
         s.triangles.erase(s.triangles.begin() + static_cast<std::ptrdiff_t>(other));
         s.triangles.erase(s.triangles.begin());
       },
       fill, kSame},
      {"a planar hole",
       [](Surface& s) {
         const auto [a, b, c] = s.triangles[2];
         const std::uint32_t m = add_middle(s, add_middle(s, a, b), c);
         s.triangles[2] = {c, a, m};
       },
       fill, kSame},
      {"an edge halved on one side, closed by a triangle without area",
       [](Surface& s) {
         const auto [a, b, c] = s.triangles[1];
         const std::uint32_t m = add_middle(s, a, b);
         s.triangles[1] = {a, m, c};
         s.triangles.push_back({m, b, c});
         s.triangles.push_back({a, b, m});
       },
       plain, kSame},
      {"an edge quartered so",
       [](Surface& s) {
         const auto [a, b, c] = s.triangles[1];
         const std::uint32_t m = add_middle(s, a, b), q = add_middle(s, a, m);
         s.triangles[1] = {a, q, c};
         for (const Triangle& t :
              {Triangle{q, m, c}, Triangle{m, b, c}, Triangle{a, b, q}, Triangle{q, b, m}}) {
           s.triangles.push_back(t);
         }
       },
       plain, kSame},
      {"triangles with a corner twice",
       [](Surface& s) {
         s.triangles.push_back({0, 0, 1});
         s.triangles.push_back({2, 2, 2});
       },
       plain, kSame},
      {"vertices of no triangle, one of them no number",
       [](Surface& s) {
         s.vertices.push_back({9, 9, 9});
         s.vertices.push_back({kNaN, 0, 0});
       },
       plain, kSame},
      {"corners out of range",
       [](Surface& s) {
         s.triangles.push_back({0, 1, 4000000000U});
       },
       plain, kSame},
      {"a seam, a little open",
       [](Surface& s) {
         const std::size_t half = s.vertices.size();
         for (std::size_t v = 0; v < half; ++v) {
           const Point p = s.vertices[v];
           s.vertices.push_back({p[0] + 1e-7, p[1], p[2]});
         }
         for (std::size_t t = 0; t < s.triangles.size() / 2; ++t) {
           for (std::uint32_t& v : s.triangles[t]) v += static_cast<std::uint32_t>(half);
         }
       },
       weld, kMoved},
  };
}

bool is_valid(const Surface& s) {
  return check_surface(s).status.ok();
}

TEST(Repair, MendsWhatWasMadeDirtyInFifteenWays) {
  const std::pair<const char*, Surface> models[] = {
      {"cube", cube()}, {"torus", torus(12)}, {"ball", ball()}};
  int mended = 0, all = 0;
  double worst = 0;
  for (const auto& [name, clean] : models) {
    ASSERT_TRUE(is_valid(clean)) << name;
    for (const Dirt& dirt : all_dirt()) {
      SCOPED_TRACE(std::string(name) + ", " + dirt.name);
      Surface dirty = clean;
      dirt.add(dirty);
      const bool harmless = std::string(dirt.name).starts_with("vertices of no");
      EXPECT_FALSE(is_valid(dirty));
      const RepairResult result = repair_surface(dirty, dirt.options);
      ++all;
      const bool valid = is_valid(result.surface);
      EXPECT_TRUE(valid);
      const double error = std::abs(volume(result.surface) / volume(clean) - 1);
      EXPECT_LE(error, dirt.error);
      mended += valid && error <= dirt.error ? 1 : 0;
      worst = std::max(worst, error);
      if (!harmless) {
        EXPECT_FALSE(result.done.empty());
      }
      // A second repair finds nothing to do.
      const RepairResult again = repair_surface(result.surface, dirt.options);
      EXPECT_EQ(again.done, std::vector<std::string>());
      EXPECT_EQ(again.surface.triangles, result.surface.triangles);
    }
  }
  std::printf("mended %d of %d, volume changed by %.2g at most\n", mended, all, worst);
}

TEST(Repair, LeavesACleanSurfaceAsItIs) {
  for (Surface clean : {cube(), torus(9), ball()}) {
    clean.labels.assign(clean.triangles.size(), 3);
    const RepairResult result = repair_surface(clean, {.weld = 1e-9, .fill = true});
    EXPECT_EQ(result.done, std::vector<std::string>());
    EXPECT_EQ(result.surface.vertices, clean.vertices);
    EXPECT_EQ(result.surface.triangles, clean.triangles);
    EXPECT_EQ(result.surface.labels, clean.labels);
  }
}

// A hole of six edges, not planar, but narrow beside the whole. What is cut off is less than a cap
// of 22.5 degrees, whose volume is pi h^2 (3 - h) / 3 with h = 1 - cos(22.5 degrees), 0.018.
TEST(Repair, FillsSmallHolesThatAreNotPlanar) {
  Surface two = ball();
  const auto n = static_cast<std::uint32_t>(two.vertices.size());
  const Surface one = two;
  for (const Point& p : one.vertices) two.vertices.push_back({p[0] + 16, p[1], p[2]});
  for (const auto& [a, b, c] : one.triangles) two.triangles.push_back({a + n, b + n, c + n});
  const double whole = volume(two);
  remove_star(two, 40);
  ASSERT_FALSE(is_valid(two));
  const RepairResult result = repair_surface(two, {.weld = 0, .fill = true});
  EXPECT_EQ(result.done, (std::vector<std::string>{"1 hole filled", "4 triangles added for them"}));
  EXPECT_TRUE(is_valid(result.surface));
  EXPECT_NEAR(volume(result.surface), whole, 0.018);
  EXPECT_NE(volume(result.surface), whole);
}

// A wide hole that is not planar is nobody's guess, and nothing is filled unasked.
TEST(Repair, DoesNotGuess) {
  Surface open = ball();
  std::erase_if(open.triangles, [&](const Triangle& t) {
    for (const std::uint32_t v : t) {
      if (open.vertices[v][2] < 0.5 + 0.2 * open.vertices[v][0]) return false;
    }
    return true;
  });
  ASSERT_LT(open.triangles.size(), ball().triangles.size());
  EXPECT_EQ(repair_surface(open, {.weld = 0, .fill = true}).done, std::vector<std::string>());
  Surface one = cube();
  one.triangles.pop_back();
  EXPECT_EQ(repair_surface(one).done, std::vector<std::string>());
}

TEST(Holes, AreRingsOfOpenEdges) {
  Surface s = ball();
  EXPECT_EQ(holes_of(s).open_edges, 0U);
  remove_star(s, 40);
  s.triangles.erase(s.triangles.begin());
  const Holes holes = holes_of(s);
  ASSERT_EQ(holes.holes.size(), 2U);
  EXPECT_EQ(holes.open_edges, 9U);
  std::multiset<std::size_t> sizes;
  for (const Hole& hole : holes.holes) sizes.insert(hole.corners.size());
  EXPECT_EQ(sizes, (std::multiset<std::size_t>{3, 6}));
}

// A hole whose side runs along an edge of another wall, and a fin: a triangle that sticks out.
TEST(Repair, HolesBesideEdgesOfThreeTriangles) {
  Surface fin = cube();
  fin.vertices.push_back({2, 0.5, 0});
  fin.triangles.push_back({1, 8, 3});  // at an edge of two others
  const RepairResult without = repair_surface(fin, {.weld = 0, .fill = true});
  EXPECT_EQ(without.done, std::vector<std::string>{"1 triangle that sticks out removed"});
  EXPECT_EQ(without.surface.triangles, cube().triangles);
  EXPECT_EQ(without.surface.vertices, cube().vertices);
  // Without a triangle of the top, and with a tetrahedron that stands on its diagonal: filled, both
  // close up, though they share an edge.
  Surface standing = cube();
  standing.triangles.erase(standing.triangles.begin() + 2);
  standing.vertices.push_back({0.25, 0.75, 2});
  standing.vertices.push_back({0.75, 0.25, 2});
  for (const Triangle& t : {Triangle{4, 8, 7}, {4, 7, 9}, {4, 9, 8}, {7, 8, 9}}) {
    standing.triangles.push_back(t);
  }
  ASSERT_EQ(holes_of(standing).holes.size(), 1U);
  const RepairResult filled = repair_surface(standing, {.weld = 0, .fill = true});
  EXPECT_EQ(filled.done, (std::vector<std::string>{"1 hole filled", "1 triangle added for them"}));
  EXPECT_EQ(holes_of(filled.surface).open_edges, 0U);
  EXPECT_TRUE(holes_of(filled.surface).holes.empty());
  // The tetrahedron: its opposite edges are at right angles, sqrt(2) and sqrt(1/2) long, 1 apart.
  EXPECT_NEAR(std::abs(volume(filled.surface) - 1), 1.0 / 6, 1e-12);
  // The rim of a wall that is whole is not a hole.
  Surface wall = cube();
  wall.triangles.push_back({0, 1, 7});
  wall.triangles.push_back({0, 7, 6});
  EXPECT_TRUE(holes_of(wall).holes.empty());
  EXPECT_TRUE(repair_surface(wall, {.weld = 0, .fill = true}).done.empty());
}

// Each triangle twice: one of each stays, and nothing is erased.
TEST(Repair, HalvesDoubleSidedSurfaces) {
  for (const bool turned : {true, false}) {
    Surface both = cube();
    for (auto [a, b, c] : cube().triangles) {
      turned ? both.triangles.push_back({a, c, b}) : both.triangles.push_back({a, b, c});
    }
    const RepairResult result = repair_surface(both);
    EXPECT_EQ(result.surface.triangles.size(), 12U);
    EXPECT_TRUE(is_valid(result.surface));
    EXPECT_EQ(result.done[0], "12 duplicate triangles dropped");
    // With a body that is as it should be beside it.
    Surface beside = both;
    for (auto [x, y, z] : cube().vertices) beside.vertices.push_back({x + 5, y, z});
    for (auto [a, b, c] : cube().triangles) beside.triangles.push_back({a + 8, b + 8, c + 8});
    EXPECT_TRUE(is_valid(repair_surface(beside).surface));
    EXPECT_EQ(repair_surface(beside).surface.triangles.size(), 24U);
    // An open one is not erased, either; it stays open.
    both.triangles.erase(both.triangles.begin() + 12);
    both.triangles.erase(both.triangles.begin());
    EXPECT_EQ(repair_surface(both).surface.triangles.size(), 11U);
  }
}

// Where a vertex lies on the edge of a triangle there is no hole to fill.
TEST(Repair, FillsNoSlits) {
  Surface slit = cube();
  slit.vertices.push_back({1, 0.5, 0.5});
  ASSERT_EQ(slit.triangles[10], (std::array<std::uint32_t, 3>{1, 3, 7}));
  slit.triangles[10] = {1, 3, 8};
  slit.triangles.push_back({3, 7, 8});
  const RepairResult result = repair_surface(slit, {.weld = 0, .fill = true});
  EXPECT_EQ(result.surface.triangles.size(), 13U);
  EXPECT_EQ(result.done, std::vector<std::string>());
}

TEST(WeldHint, TellsWhatIsAtOnePlace) {
  Surface torn = cube();
  for (const auto& v : cube().vertices) torn.vertices.push_back(v);
  for (std::uint32_t& v : torn.triangles[0]) v += 8;
  EXPECT_EQ(weld_hint(torn).closed, 6U);
  EXPECT_EQ(weld_hint(torn).distance, 0);
}

TEST(WeldHint, NamesTheDistanceThatCloses) {
  EXPECT_EQ(weld_hint(cube()).closed, 0U);
  Surface torn = cube();
  tear(torn, 1e-7);
  const WeldHint hint = weld_hint(torn);
  EXPECT_EQ(hint.closed, 36U);
  // Corners moved by 1e-7 in each coordinate are 3.5e-7 apart at most, and most more than 2e-8.
  EXPECT_GT(hint.distance, 2e-8);
  EXPECT_LE(hint.distance, 2e-6);
  EXPECT_TRUE(is_valid(repair_surface(torn, {.weld = hint.distance}).surface));
  Surface hole = cube();
  hole.triangles.pop_back();
  EXPECT_EQ(weld_hint(hole).closed, 0U);
}

}  // namespace
}  // namespace delmesher::surface::repair_test
