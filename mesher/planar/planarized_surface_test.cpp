#include "mesher/planar/planarized_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <utility>

#include "mesher/base/control.h"
#include "mesher/geometry/vector.h"
#include "mesher/planar/flatness.h"
#include "mesher/planar/group_planes.h"
#include "mesher/planar/planar_growth.h"
#include "mesher/surface/test_surfaces.h"
#include "mesher/surface/topology.h"
#include "mesher/surface/validity.h"

namespace delmesher::planar::planarized_surface_test {
namespace {

using namespace surface::test_surfaces;  // NOLINT(google-build-using-namespace)

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// The corners of some triangles, and the directed edges that no two of them share.
std::pair<std::set<VertexId>, std::set<std::pair<VertexId, VertexId>>> outline(
    const Triangles& triangles, const std::vector<std::uint32_t>& members) {
  std::set<VertexId> corners;
  std::set<std::pair<VertexId, VertexId>> sides;
  for (const std::uint32_t t : members) {
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      corners.insert(a);
      if (sides.erase({b, a}) == 0) sides.emplace(a, b);
    }
  }
  return {corners, sides};
}

std::vector<double> shortest_edges(const Surface& s) {
  std::vector<double> shortest(s.vertices.size(), HUGE_VAL);
  for (const auto& t : s.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = t[k], b = t[(k + 1) % 3];
      const double length = distance(s.vertices[a], s.vertices[b]);
      shortest[a] = std::min(shortest[a], length);
      shortest[b] = std::min(shortest[b], length);
    }
  }
  return shortest;
}

// The planarized surface's topology, checked: every facet exactly planar by its own triangles'
// predicates, with the corners and the outline that its triangles have as given, every vertex where
// it was up to the noise, and moved only where a facet of several triangles needs it, by a quarter
// of its shortest edge at most.
struct Grouped {
  Limits limits;
  Control control{limits};
  PlanarizedSurface planarized;
  PointStore points;
  Predicates predicates{points};
  SurfaceTopology topology;

  Grouped(const Surface& s, double noise, Retriangulate retriangulate = Retriangulate::yes) {
    const ValidityResult validity = check_validity(s, true, control);
    EXPECT_TRUE(validity.report.status.ok()) << validity.report.status.message;
    planarized = planarize(s, noise, control, retriangulate);
    topology = planarized_topology(s, planarized, points, predicates);
    const std::vector<double> shortest = shortest_edges(s);
    for (VertexId v = 0; v < s.vertices.size(); ++v) {
      const double moved = distance(points.nearest(v), s.vertices[v]);
      EXPECT_LE(moved, planarized.displacement);
      EXPECT_LE(moved, shortest[v] / 4);
      if (planarized.planes_of.empty() || planarized.planes_of[v][0] == kNone) {
        EXPECT_TRUE(points.is_explicit(v));
      }
    }
    for (const auto& triangles : topology.facet_triangles) {
      EXPECT_EQ(outline(topology.triangles, triangles), outline(s.triangles, triangles));
      const auto& [a, b, c] = topology.triangles[triangles.front()];
      for (const std::uint32_t t : triangles) {
        for (const VertexId v : topology.triangles[t]) {
          EXPECT_EQ(predicates.orient3d(a, b, c, v), 0);
        }
      }
    }
    std::set<VertexId> flattened;
    for (const auto& triangles : topology.facet_triangles) {
      if (triangles.size() == 1) continue;
      for (const std::uint32_t t : triangles) {
        flattened.insert(topology.triangles[t].begin(), topology.triangles[t].end());
      }
    }
    for (VertexId v = 0; v < s.vertices.size(); ++v) {
      EXPECT_TRUE(points.is_explicit(v) || flattened.contains(v)) << "needlessly moved: " << v;
    }
    EXPECT_LE(planarized.deviation, noise);
  }
  std::size_t facets() const { return topology.facet_triangles.size(); }
};

Grouped grouped(const Surface& s) {
  Limits limits;
  Control control{limits};
  return Grouped(s, 2 * flatness(s, control));
}

// (3, -4, 12) . x = 7 contains (1, -1, 0), and whatever integers solve it, as far away as they are;
// a neighbouring double of any coordinate is off it, by less than roundings of the products.
TEST(GroupPlanes, APointIsOnAPlaneToTheLastDigitOrNot) {
  const PlaneEquation plane{{3, -4, 12}, {{{1, -1, 0}}}};
  const double far = 0x1p40;
  const Vec3 along = {4 * far + 1, 3 * far - 1, 0}, beyond = {1 - 4 * far, -1, far};
  const PlaneEquation spanned{{3, -4, 12}, {{{1, -1, 0}, {5, 2, 0}, {-3, -1, 1}}}, true};
  for (const PlaneEquation& p : {plane, spanned}) {
    for (const Vec3& on : {p.through[0], Vec3{5, 2, 0}, Vec3{-3, -1, 1}, along, beyond}) {
      EXPECT_TRUE(exactly_on(p, on));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double towards : {-HUGE_VAL, HUGE_VAL}) {
          Vec3 off = on;
          off[axis] = std::nextafter(off[axis], towards);
          EXPECT_FALSE(exactly_on(p, off)) << off[0] << ' ' << off[1] << ' ' << off[2];
        }
      }
    }
  }
}

// The exact coordinates and the denominator: their limbs, signs and exponents.
std::vector<std::vector<Word>> digits_of(const PointStore& points, VertexId v) {
  ExactPosition x;
  points.exact(v, x);
  std::vector<std::vector<Word>> result;
  for (const ExactCoordinate& c :
       {x.coordinate[0], x.coordinate[1], x.coordinate[2], x.denominator}) {
    result.emplace_back(c.limbs, c.limbs + std::abs(c.size));
    result.back().push_back(static_cast<Word>(c.size));
    result.back().push_back(static_cast<Word>(c.exponent));
  }
  return result;
}

// Only those that differ by a plane are others, whatever numbers the planes have.
TEST(PlanarGroups, PointsOfAnEarlierPlanarizedSurfaceAreThePointsOfThis) {
  const Surface s = box({0, 0, 0}, {1, 2, 3});
  const PlaneEquation a{{1, 0x1p-20, 0}, {{{0.1, 0.2, 0.3}}}}, b{{0, 1, 0x1p-30}, {{{0, 0, 0}}}},
      c{{0x1p-25, 0, 1}, {{{0, 0, 0.7}}}}, d{{0x1p-25, 0, 1}, {{{0, 0, 0.6}}}};
  PlanarizedSurface first, second;
  first.planes = {a, b, c};
  second.planes = {d, c, a, b};
  const std::array<std::uint32_t, 3> stays = {kNone, kNone, kNone};
  first.planes_of.assign(s.vertices.size(), stays);
  second.planes_of = first.planes_of;
  first.planes_of[0] = first.planes_of[1] = first.planes_of[2] = {0, 1, 2};
  second.planes_of[0] = second.planes_of[3] = {2, 3, 1};
  second.planes_of[1] = {2, 3, 0};
  PointStore earlier, anew, reused;
  add_vertices(s, first, earlier);
  add_vertices(s, second, anew);
  add_vertices(s, second, reused, earlier);
  ASSERT_EQ(reused.size(), anew.size());
  for (VertexId v = 0; v < anew.size(); ++v) {
    EXPECT_EQ(reused.nearest(v), anew.nearest(v));
    EXPECT_EQ(reused.definition(v).corner, anew.definition(v).corner);
    EXPECT_EQ(digits_of(reused, v), digits_of(anew, v));
  }
}

TEST(PlanarGroups, NothingMovesThatIsPlanar) {
  for (const Surface& s : {box({0, 0, 0}, {1, 2, 3}, 3), box({0.1, 0.2, 0.3}, {1.7, 2.1, 3.3}, 2),
                           tetrahedron({0, 0, 0}, {1, 0.3, 0.1}, {0, 1, 0.7}, {0.2, 0.1, 1})}) {
    const Grouped g(s, 1e-9);
    EXPECT_TRUE(g.planarized.planes.empty());
    EXPECT_EQ(g.planarized.groups, 0U);
  }
}

TEST(PlanarGroups, FacesOfARotatedBoxAreSix) {
  for (const std::uint32_t n : {1U, 2U, 5U}) {
    const Surface s = rotated(box({0, 0, 0}, {1, 2, 3}, n));
    EXPECT_GT(Grouped(s, 0).facets(), 6U);  // without, they are not
    const Grouped g = grouped(s);
    EXPECT_EQ(g.facets(), 6U);
    EXPECT_EQ(g.planarized.groups, 6U);
    EXPECT_LT(g.planarized.displacement, 1e-14);
    const Grouped f = grouped(in_single_precision(s));
    EXPECT_EQ(f.facets(), 6U);
    EXPECT_LT(f.planarized.displacement, 1e-5);
    EXPECT_EQ(grouped(in_decimals(s, 1e-6)).facets(), 6U);
  }
}

// Rounding of sums over so many triangles would put the planes off by more than the noise.
TEST(PlanarGroups, ThousandsOfTrianglesAreOneFace) {
  EXPECT_EQ(grouped(rotated(box({0, 0, 0}, {1, 2, 3}, 40))).facets(), 6U);
}

Surface shifted(Surface s, const Point& by) {
  for (Point& p : s.vertices) {
    for (std::size_t i = 0; i < 3; ++i) p[i] += by[i];
  }
  return s;
}

// The plane of the first triangles of a face is off by the noise, and ends somewhere in the middle.
TEST(PlanarGroups, FinelyDividedFacesAreWhole) {
  for (const std::uint32_t n : {5, 10, 20, 30}) {
    const Surface s = scaled(box({0, 0, 0}, {1, 2, 3}, n), 10);
    EXPECT_EQ(grouped(in_decimals(rotated(s), 1e-4)).facets(), 6U) << n;
    EXPECT_EQ(grouped(in_decimals(rotated(s, 0, 0, 0.5), 1e-4)).facets(), 6U) << n;
    EXPECT_EQ(grouped(in_single_precision(shifted(rotated(s), {90, -200, 40}))).facets(), 6U) << n;
  }
}

// A lid that is flat except for noise, on walls that are exactly: vertices of the rim are the
// meeting points of noisy planes and exact ones, whose equations come from areas.
TEST(PlanarGroups, AreTheSameInAllUnits) {
  Surface s = box({0, 0, 0}, {1, 1, 1}, 4);
  for (std::size_t v = 0; v < s.vertices.size(); ++v) {
    Point& p = s.vertices[v];
    if (p[2] == 1) p[2] += 1e-9 * static_cast<double>(v % 3);
  }
  for (const int exponent : {0, -20, -47, 30}) {
    const Grouped g = grouped(scaled(s, std::ldexp(1.0, exponent)));
    EXPECT_EQ(g.facets(), 6U) << "in units of 2^" << exponent;
    EXPECT_EQ(g.planarized.groups, 1U) << "in units of 2^" << exponent;
  }
}

// A wish, not noise: a ridge of 0.05 degrees across a plate.
TEST(PlanarGroups, AFlatRidgeStays) {
  const std::vector<std::array<double, 2>> plate = {{0, 0}, {1, 0},  {1, 1},
                                                    {0, 1}, {-1, 1}, {-1, 0}};
  const double slope = std::tan(0.05 / 2 * std::acos(-1.0) / 180);
  const Surface s = prism(plate, [&](double x, double) { return 0.1 - slope * std::fabs(x); });
  for (const Surface& t : {rotated(s), in_single_precision(rotated(s))}) {
    EXPECT_EQ(grouped(t).facets(), 7U);  // bottom, two slopes, four sides
  }
}

TEST(PlanarGroups, ACylinderKeepsItsFacets) {
  const Surface s = prism(ellipse(1000), 1);
  for (const Surface& t : {s, rotated(s)}) EXPECT_EQ(grouped(t).facets(), 1002U);
  // Facets at a third of a degree, whose planes single precision knows to a hundredth of that.
  EXPECT_GE(grouped(in_single_precision(rotated(s))).facets(), 1002U);
}

TEST(PlanarGroups, AStepOfTwiceTheNoiseStays) {
  const double step = 1e-6;
  // A staircase of one step: the sides of x > 1 are higher by it.
  Surface s = box({0, 0, 0}, {2, 1, 1}, 2);
  for (Point& p : s.vertices) {
    if (p[2] == 1 && p[0] > 1) p[2] += step;
  }
  const std::size_t before = Grouped(rotated(s), 0).facets();
  EXPECT_LE(before, 48U);
  const Grouped above = Grouped(rotated(s), step * 4), below = Grouped(rotated(s), step / 8);
  EXPECT_EQ(above.facets(), 6U);
  EXPECT_EQ(below.facets(), 7U);  // flat up to x = 1, a slope beyond
}

// Each facet is coplanar with the next within the noise, all of them together are not.
TEST(PlanarGroups, ABendIsNoPlane) {
  std::vector<std::array<double, 2>> arc;
  const int n = 40;
  for (int i = 0; i <= n; ++i) {
    const double x = -1 + 2.0 * i / n;
    arc.push_back({x, 1e-6 * x * x - 1});
  }
  arc.push_back({1, 1});
  arc.push_back({-1, 1});
  const double noise = 1e-8;
  const Grouped g(rotated(prism(arc, 1)), noise);
  // Two caps, three flat sides, and the arc of height 1e-6 in pieces of at most 2e-8: at least
  // sqrt(1e-6 / 4e-8) = 5.
  EXPECT_GE(g.facets(), 10U);
  EXPECT_LT(g.facets(), 5U + n);
}

// In thousandths of about a hundred, or integers up to a hundred thousand.
Surface twice_rounded(const Surface& s, double unit) {
  return rotated(in_decimals(rotated(s), unit), 1.9, 0.4, 0.2);
}

TEST(PlanarGroups, OfCoordinatesThatWereRoundedTwice) {
  const Surface s = scaled(box({0, 0, 0}, {1, 2, 3}, 5), 25);
  EXPECT_GT(Grouped(twice_rounded(s, 1e-3), 0).facets(), 100U);
  EXPECT_EQ(grouped(twice_rounded(s, 1e-3)).facets(), 6U);
  EXPECT_EQ(grouped(in_single_precision(twice_rounded(s, 1e-3))).facets(), 6U);
  EXPECT_EQ(grouped(in_decimals(rotated(scaled(s, 1e3)), 1)).facets(), 6U);
}

// Few groups are left then of very many, and one that is left over says nothing about features.
TEST(PlanarGroups, OfFewFacesOneMayBeLeftOver) {
  for (int n = 0; n < 12; ++n) {
    const Surface s = scaled(box({0, 0, 0}, {1, 2, 3}, 12), 25 + n);
    const std::size_t triangles = s.triangles.size();  // 1728
    ASSERT_GT(Grouped(twice_rounded(s, 1e-3), 0).facets(), triangles / 2);
    EXPECT_LE(grouped(twice_rounded(s, 1e-3)).facets(), triangles / 40) << n;
  }
}

// A ridge of 0.05 degrees, and a slope that is off by ten units, on faces of many triangles whose
// noise is two units.
TEST(PlanarGroups, NoiseOfTwoRoundingsSwallowsNoFeatures) {
  const Surface s = scaled(box({0, 0, 0}, {1, 2, 3}, 8), 25);
  const double ridge = 25 * std::tan(0.05 * std::acos(-1.0) / 180), unit = 1e-3;
  for (const double height : {ridge, 10 * unit}) {
    Surface bent = s;
    for (Point& p : bent.vertices) {
      if (p[2] == 75) p[2] += height * (1 - std::fabs(p[0] / 12.5 - 1));
    }
    EXPECT_EQ(grouped(twice_rounded(bent, unit)).facets(), 7U);
    EXPECT_EQ(grouped(in_decimals(rotated(scaled(bent, 1 / unit)), 1)).facets(), 7U);
  }
}

// A rounded edge of 60 facets, whose bends begin at twice the noise and grow by a twentieth.
TEST(PlanarGroups, FilletsThatBeginWhereNoiseEnds) {
  const double unit = 1e-3, width = 1.5;
  Polygon section = {{0, 0}};
  double direction = 0;
  for (int i = 0; i < 60; ++i) {
    const auto [x, y] = section.back();
    section.push_back({x + width * std::cos(direction), y + width * std::sin(direction)});
    direction += 3 * 1.5 * unit / width * std::pow(1.05, i);
  }
  const Surface s = prism(section, 30);
  ASSERT_EQ(Grouped(s, 0).facets(), 63U);
  for (const Surface& twice : {twice_rounded(s, unit), in_single_precision(twice_rounded(s, unit)),
                               in_decimals(rotated(scaled(s, 1 / unit)), 1)}) {
    ASSERT_GT(Grouped(twice, 0).facets(), 200U);
    const std::size_t facets = grouped(twice).facets();
    EXPECT_GE(facets, 55U);
    EXPECT_LE(facets, 70U);
  }
}

TEST(PlanarGroups, LabelsSeparate) {
  Surface s = rotated(box({0, 0, 0}, {1, 2, 3}, 2));
  s.labels.assign(s.triangles.size(), 1);
  s.labels[0] = 2;
  EXPECT_EQ(grouped(s).facets(), 7U);
}

// A box whose lid is flat exactly up to x = 0.75, with a label of its own, and flat except for
// noise beyond. The two share a plane: that of the flat part does not move, yet vertices of the
// other have to go there.
Surface lid_in_two_parts() {
  Surface s = box({0, 0, 0}, {1, 1, 1}, 4);
  for (const auto& corners : s.triangles) {
    s.labels.push_back(std::ranges::all_of(
        corners, [&](VertexId v) { return s.vertices[v][2] == 1 && s.vertices[v][0] <= 0.75; }));
  }
  for (std::size_t v = 0; v < s.vertices.size(); ++v) {
    Point& p = s.vertices[v];
    if (p[2] == 1 && p[0] == 1) p[2] += 1e-9 * static_cast<double>(v % 3);
  }
  return s;
}

TEST(PlanarGroups, AFlatFacetLendsItsPlaneToANoisyOne) {
  const Grouped g = grouped(lid_in_two_parts());
  EXPECT_EQ(g.facets(), 7U);
  EXPECT_EQ(g.planarized.groups, 1U);
}

// The same with needles in the wall at x = 1 along its edge with the lid.
Surface lid_beside_needles() {
  Surface s = lid_in_two_parts();
  for (std::size_t t = 0, n = s.triangles.size(); t < n; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = s.triangles[t][k], b = s.triangles[t][(k + 1) % 3],
                     c = s.triangles[t][(k + 2) % 3];
      const Point &p = s.vertices[a], &q = s.vertices[b];
      const bool on_the_edge = p[0] == 1 && q[0] == 1 && p[2] >= 1 && q[2] >= 1;
      if (!on_the_edge || s.vertices[c][2] > 0.9 || s.vertices[c][0] != 1) continue;
      const auto m = static_cast<VertexId>(s.vertices.size());
      s.vertices.push_back({1, (p[1] + q[1]) / 2, std::min(p[2], q[2]) - 5e-10});
      s.triangles[t] = {a, b, m};
      s.triangles.push_back({b, c, m});
      s.triangles.push_back({c, a, m});
      s.labels.resize(s.triangles.size(), 0);
      break;
    }
  }
  return s;
}

// They become part of the lid, and leave no trace of themselves there by flips. Flipped facets have
// to be planar.
TEST(PlanarGroups, NeedlesBesideALentPlaneKeepTheOutlines) {
  const Grouped g = grouped(lid_beside_needles());
  EXPECT_EQ(g.facets(), 7U);
  EXPECT_FALSE(g.planarized.triangles.empty());
}

// A needle belongs to the facet that it was handed to, also when its former one is taken apart.
TEST(PlanarGroups, ANeedleHasOneGroup) {
  const Surface s = lid_beside_needles();
  Limits limits;
  Control control{limits};
  const MeasuredSurface surface(s);
  PlanarGrowth growth(surface, 1e-8, 1e-16, control);
  growth.grow_all();
  const auto is_lid = [&](std::uint32_t g) {
    const auto& members = growth.groups()[g].triangles;
    const std::uint32_t largest =
        *std::ranges::max_element(members, {}, [&](std::uint32_t t) { return surface.size(t); });
    return surface.area(largest)[2] > std::fabs(surface.area(largest)[0]);
  };
  std::vector<std::uint32_t> needles;
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    if (std::fabs(surface.area(t)[0]) > surface.area(t)[2] && surface.size(t) < 1e-8) {
      needles.push_back(t);
      ASSERT_TRUE(is_lid(growth.group_of(t))) << t;
    }
  }
  ASSERT_FALSE(needles.empty());
  std::vector<std::uint32_t> before;
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) before.push_back(growth.group_of(t));
  for (const std::uint32_t g : std::set<std::uint32_t>(before.begin(), before.end())) {
    if (growth.is_group(g) && !is_lid(g)) growth.take_apart(g, 1000);
  }
  for (const std::uint32_t t : needles) EXPECT_EQ(growth.group_of(t), before[t]);
  std::vector<int> times(s.triangles.size());
  for (std::uint32_t g = 0; g < growth.groups().size(); ++g) {
    for (const std::uint32_t t : growth.groups()[g].triangles) {
      ++times[t];
      EXPECT_EQ(growth.group_of(t), g);
    }
  }
  EXPECT_EQ(std::ranges::count(times, 1), std::ssize(times));
}

// A lid in columns of given places and heights; two at one place are a riser. The floor's columns
// are at other places, so that no side is degenerate.
Surface terraces(const std::vector<double>& places, const std::vector<double>& heights,
                 std::uint32_t rows) {
  const auto n = static_cast<std::uint32_t>(places.size()), m = rows + 1;
  Surface s;
  for (const bool up : {false, true}) {
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = 0; j < m; ++j) {
        const double y = static_cast<double>(j) / rows;
        s.vertices.push_back(up ? Point{places[i], y, heights[i]}
                                : Point{places.back() * i / (n - 1), y, 0});
      }
    }
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    s.triangles.push_back({a, b, c});
    s.triangles.push_back({a, c, d});
  };
  const std::uint32_t top = n * m;
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = 0; j + 1 < m; ++j) {
      const std::uint32_t a = i * m + j, b = a + m;
      quad(a, a + 1, b + 1, b);
      quad(top + a, top + b, top + b + 1, top + a + 1);
    }
    const std::uint32_t a = i * m, b = a + m, c = a + m - 1, d = b + m - 1;
    quad(a, b, top + b, top + a);
    quad(d, c, top + c, top + d);
  }
  for (std::uint32_t j = 0; j + 1 < m; ++j) {
    const std::uint32_t a = j, b = (n - 1) * m + j;
    quad(a + 1, a, top + a, top + a + 1);
    quad(b, b + 1, top + b + 1, top + b);
  }
  return s;
}

// Layers closer than the bound with upright risers, thin plates and thin columns, of one to three
// labels, as given and rotated: whatever is made of them, facets keep their outlines.
TEST(PlanarGroups, LayersWithinTheBoundKeepTheirOutlines) {
  std::mt19937 random(20);
  const auto any = [&] { return static_cast<std::uint32_t>(random()); };
  const auto unit = [&] { return any() * 0x1p-32; };
  std::uint64_t groups = 0;
  for (int round = 0; round < 300; ++round) {
    const double bound = std::exp2(-12 - 12 * unit());
    std::vector<double> places = {0}, heights = {unit() < 0.2 ? 4 * bound : 1};
    for (int i = 0; i < 7; ++i) {
      const double kind = unit();
      const bool riser = kind < 0.3 && places[places.size() - 1] > 0;
      places.push_back(places.back() + (riser ? 0 : kind < 0.5 ? bound * 8 * unit() : unit()));
      const bool again = !riser && kind < 0.8;
      heights.push_back(again ? heights.back() : heights[0] + bound * (2 * unit() - 1));
    }
    Surface s = terraces(places, heights, 1 + any() % 3);
    // Triangles come column by column.
    const std::size_t labels = 1 + any() % 3, n = s.triangles.size();
    for (std::size_t t = 0; t < n; ++t) {
      s.labels.push_back(static_cast<std::int32_t>(t * labels / n));
    }
    if (any() % 2 == 0) s = rotated(s);
    Limits limits;
    Control control{limits};
    if (!check_validity(s, false, control).report.status.ok()) continue;
    groups += Grouped(s, bound).planarized.groups;
    if (HasFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(groups, 300U);
}

// Four planes at each vertex: not all quadrangles can be planar, and the rest is valid.
TEST(PlanarGroups, VerticesOfFourPlanes) {
  const std::uint32_t rings = 9, around = 12;
  Surface s;
  const double pi = std::acos(-1.0);
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      const double u = 2 * pi * i / rings, v = 2 * pi * j / around;
      const double r = 3 + std::cos(v);
      s.vertices.push_back({r * std::cos(u), r * std::sin(u), std::sin(v)});
    }
  }
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      const auto at = [&](std::uint32_t di, std::uint32_t dj) {
        return (i + di) % rings * around + (j + dj) % around;
      };
      s.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
      s.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  }
  const Grouped g = grouped(rotated(s));
  EXPECT_LE(g.facets(), 2 * rings * around);
  EXPECT_GE(g.facets(), rings * around);
}

// A flat face cut at a rounded point of an edge: the needle beside it has a height of noise.
TEST(PlanarGroups, AFaceSplitAtARoundedPoint) {
  Surface s = rotated(box({0, 0, 0}, {1, 2, 3}));
  // The edge between the two triangles of the first face, and the neighbour across another edge.
  const auto [a, b, c] = s.triangles[0];
  Point p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = s.vertices[a][i] * 0.3 + s.vertices[b][i] * 0.7;
  const auto middle = static_cast<std::uint32_t>(s.vertices.size());
  s.vertices.push_back(p);
  for (std::size_t t = 0; t < 12; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      auto& corners = s.triangles[t];
      const std::uint32_t from = corners[k], to = corners[(k + 1) % 3];
      if (!((from == a && to == b) || (from == b && to == a))) continue;
      auto second = corners;
      second[k] = middle;
      corners[(k + 1) % 3] = middle;
      s.triangles.push_back(second);
      break;
    }
  }
  EXPECT_EQ(grouped(s).facets(), 6U);
}

// A vault on a floor: 6 by 6 parallelograms, as the heights are sums of one along x and one along
// y, of which those in the column `wide` are 40 times as long as wide. Inside, four planes meet at
// every vertex.
Surface vault(std::uint32_t wide) {
  constexpr std::uint32_t n = 6, row = n + 1, top = row * row;
  Surface s;
  for (const int up : {0, 1}) {
    double x = 0;
    for (std::uint32_t i = 0; i <= n; ++i) {
      for (std::uint32_t j = 0; j <= n; ++j) {
        const double height = 1 - (i - 3.0) * (i - 3.0) / 64 - (j - 3.0) * (j - 3.0) / 128;
        s.vertices.push_back({x, static_cast<double>(j), up * height});
      }
      x += i == wide ? 40 : 1;
    }
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    s.triangles.push_back({a, b, c});
    s.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * row + j, b = a + row;
      quad(a, a + 1, b + 1, b);
      quad(top + a, top + b, top + b + 1, top + a + 1);
    }
    const std::uint32_t first = i * row, last = first + n;
    quad(first, first + row, top + first + row, top + first);
    quad(last + row, last, top + last, top + last + row);
    quad(i + 1, i, top + i, top + i + 1);
    quad(n * row + i, n * row + i + 1, top + n * row + i + 1, top + n * row + i);
  }
  return s;
}

// A parallelogram that gives up its plane makes room at four vertices, so that half of the 25
// inside are more than enough. Long ones do not: their halves would be needles.
TEST(PlanarGroups, FewGiveWayWhereFourPlanesMeet) {
  const Surface given = vault(2);
  const Grouped straight = grouped(given);
  EXPECT_EQ(straight.facets(), 36U + 5U);
  const Surface s = rotated(given);
  const Grouped g = grouped(s);
  EXPECT_GT(g.planarized.groups, 0U);
  EXPECT_LE(g.facets(), 36U + 5U + 12U);
  std::size_t long_ones = 0;
  for (const auto& triangles : g.topology.facet_triangles) {
    if (triangles.size() != 2) continue;
    const auto& [a, b, c] = given.triangles[triangles[0]];
    const double x = given.vertices[a][0];
    const bool on_top = a >= 49 && b >= 49 && c >= 49;
    if (on_top && x == 2) ++long_ones;
  }
  EXPECT_EQ(long_ones, 6U);
}

// A pyramid over a rotated fan of five triangles in single precision, found by a search. With a
// bound as small as the noise the fan loses triangles in its middle, and the last one of them is
// left alone: nothing is won by moving its corners 5 and 6.
TEST(PlanarGroups, ATriangleLeftAloneStays) {
  Surface s;
  s.vertices = {
      {0.485367686, -0.221289679, -0.814925194},  {0.209953785, 0.447912812, -0.545126796},
      {-0.106133163, 0.733466089, -0.0645364597}, {0.106953137, -0.0839258805, -0.167113781},
      {-0.337795973, -0.164374113, 0.67996186},   {-0.0768741071, -0.859858274, 0.446148336},
      {0.280940741, -0.745236814, -0.253030658},  {2.64569664, 0.573575437, 1.30050027}};
  for (std::uint32_t k = 1; k < 6; ++k) s.triangles.push_back({0, k + 1, k});
  for (std::uint32_t k = 0; k < 7; ++k) s.triangles.push_back({k, (k + 1) % 7, 7});
  s = in_single_precision(s);
  const Grouped g(s, 2.248e-8, Retriangulate::no);  // four times its largest small bend
  EXPECT_EQ(g.planarized.groups, 1U);
  EXPECT_TRUE(g.points.is_explicit(5) && g.points.is_explicit(6));
}

// With a vertex near the first of the edge's two, so many parts of its length away.
Surface with_split_edge(Surface s, VertexId v, VertexId u, double share) {
  const auto w = static_cast<VertexId>(s.vertices.size());
  Point p;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = s.vertices[v][i] + (s.vertices[u][i] - s.vertices[v][i]) * share;
  }
  s.vertices.push_back(p);
  for (std::size_t t = 0, n = s.triangles.size(); t < n; ++t) {
    auto half = s.triangles[t];
    if (std::ranges::find(half, v) == half.end() || std::ranges::find(half, u) == half.end()) {
      continue;
    }
    std::ranges::replace(half, v, w);
    std::ranges::replace(s.triangles[t], u, w);
    s.triangles.push_back(half);
  }
  return s;
}

// A group that is flat to doubles is so for a smaller bound as well; a group that single precision
// has bent by more than that would fall apart.
TEST(PlanarGroups, ASmallerBoundLeavesWholeWhatIsFlatEnough) {
  const Surface doubles = rotated(box({0, 0, 0}, {1, 1, 1}, 4));
  for (const bool single : {false, true}) {
    const Surface s = single ? in_single_precision(doubles) : doubles;
    Limits limits;
    Control control{limits};
    const MeasuredSurface surface(s);
    PlanarGrowth growth(surface, 1e-6, 1e-16, control);
    growth.grow_all();
    ASSERT_EQ(growth.groups().size(), 6U);
    const std::size_t size = growth.groups()[0].triangles.size();
    EXPECT_EQ(growth.take_apart(0, 2), !single);
    if (single) {
      EXPECT_EQ(growth.groups().size(), 6U);  // as before
      EXPECT_EQ(growth.groups()[0].triangles.size(), size);
      EXPECT_EQ(growth.group_of(growth.groups()[0].triangles[3]), 0U);
    }
    // With triangles that had left it.
    if (!single) {
      growth.detach(growth.groups()[6].triangles[3]);
      EXPECT_EQ(growth.groups()[6].triangles.size(), size - 1);
      EXPECT_TRUE(growth.take_apart(6, 2));
      EXPECT_EQ(growth.groups()[7].triangles.size(), size);
    }
  }
}
// A ridge that is lower than the bound, but higher than twice the noise (2^-20 of the diagonal):
// the plates on both sides of it become one bent group and the rest of one plate, whose planes meet
// far from their common edge. To take the bent one apart is better than to take triangles out of
// the other.
TEST(PlanarGroups, AFacetThatGrewAcrossARidgeFallsIntoTwo) {
  constexpr std::uint32_t kRows = 8;
  Surface s = box({0, 0, 0}, {10, 6, 1}, kRows);
  for (Point& p : s.vertices) {
    if (p[2] == 1) p[2] -= 1.15e-5 * std::fabs(p[1] - 3);
  }
  ASSERT_EQ(Grouped(rotated(s), 1e-10).facets(), 7U);
  for (const Surface& t : {rotated(s), in_single_precision(rotated(s))}) {
    EXPECT_EQ(grouped(t).facets(), 7U);
  }
}

// Terraces of a height below the bound: one group as long as nothing is wrong with it, but their
// risers are too narrow for their vertices to move as far.
TEST(PlanarGroups, StepsBelowTheBoundDoNotShatterWhatIsBesideThem) {
  const std::vector<double> places = {0, 1, 2, 2 + 1e-6, 3, 4, 4 + 1e-6, 5, 6},
                            heights = {1,        1,        1,        1 + 2e-6, 1 + 2e-6,
                                       1 + 2e-6, 1 + 4e-6, 1 + 4e-6, 1 + 4e-6};
  const Surface s = terraces(places, heights, 6);
  const std::size_t before = Grouped(s, 0).facets();
  EXPECT_EQ(before, 10U);
  EXPECT_EQ(grouped(s).facets(), before);
  EXPECT_EQ(grouped(rotated(s)).facets(), before);
}

// Edges shorter than the noise leave their ends no room to move. That is not a reason to give up
// the whole face around them.
TEST(PlanarGroups, EdgesShorterThanTheNoiseCostTheirOwnTrianglesAlone) {
  constexpr std::uint32_t kSquares = 16;  // the short edges have others between them
  const Surface given = box({0, 0, 0}, {1, 2, 3}, kSquares);
  const Surface s = in_single_precision(rotated(given));
  ASSERT_EQ(grouped(s).facets(), 6U);
  for (const double every : {0.5, 0.25}) {
    Surface split = s;
    std::set<VertexId> ends;
    for (VertexId v = 0; v < given.vertices.size(); ++v) {
      const auto& [x, y, z] = given.vertices[v];
      const auto is_inside = [&](double share) {
        return share > 0 && share < 1 && std::fmod(share, every) == 0;
      };
      if (z != 3 || !is_inside(x) || !is_inside(y / 2)) continue;
      ends.insert(v);
      ends.insert(static_cast<VertexId>(split.vertices.size()));
      split = with_split_edge(split, v, v + 1, 1e-6);
    }
    const Grouped g = grouped(split);
    const auto at_ends =
        static_cast<std::size_t>(std::ranges::count_if(split.triangles, [&](const auto& t) {
          return std::ranges::any_of(t, [&](VertexId v) { return ends.contains(v); });
        }));
    EXPECT_GT(g.facets(), 6U);
    EXPECT_LE(g.facets(), 6U + at_ends);
  }
}

// A thin plate whose corners are cut off, by eight units in the last place. The planes there are
// off by a tenth of a radian, so that the corners of the plate move by several units. The faces
// around them stay whole, and so do the cuts.
TEST(PlanarGroups, CutsOfAFewUnitsLeaveFacesWhole) {
  constexpr double kUnit = 5e-4, kSide = 150, kCut = 3e-3;
  Polygon plate = {{kSide + 50, 0}};
  for (const auto& [c, s] : {std::array{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
    for (const auto& [x, y] : {std::array{kSide, kSide - kCut}, {kSide - kCut, kSide}}) {
      plate.push_back({c * x - s * y, s * x + c * y});
    }
  }
  const Surface s = prism(plate, 3);
  ASSERT_EQ(Grouped(s, 0).facets(), 11U);
  for (int n = 0; n < 6; ++n) {
    const Surface rounded = in_decimals(rotated(s, 0.3 + n, 0.7, 1.1), kUnit);
    ASSERT_GT(Grouped(rounded, 0).facets(), 25U);
    EXPECT_EQ(grouped(rounded).facets(), 11U) << n;
  }
}

// Every step goes over all vertices, so each consults the caller many times on a surface of many.
TEST(PlanarGroups, EveryStepOfThePlanesCanBeStopped) {
  const Surface s = in_single_precision(rotated(box({0, 0, 0}, {1, 2, 3}, 8)));
  bool go_on = true;
  Limits limits;
  limits.progress = [&](const Progress&) { return go_on; };
  Control control{limits};
  MeasuredSurface surface(s);
  PlanarGrowth growth(surface, 1e-6, 1e-16, control);
  growth.grow_all();
  GroupPlanes planes(surface, growth, control);
  const std::vector<std::function<void()>> steps = {[&] { planes.fit(); }, [&] { planes.share(); },
                                                    [&] { planes.spread_moves(); },
                                                    [&] { planes.relieve_vertices(); }};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    go_on = false;
    EXPECT_THROW(steps[i](), Stopped) << "step " << i;
    go_on = true;
    steps[i]();
  }
}

}  // namespace
}  // namespace delmesher::planar::planarized_surface_test
