#include "mesher/output/statistics.h"
#include "mesher/output/cosines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "mesher/output/cosines.h"

namespace delmesher::output::statistics_test {
namespace {

using Points = std::vector<std::array<double, 3>>;
using Tets = std::vector<std::array<std::uint32_t, 4>>;

MeshStatistics of(const Points& points, const Tets& tets = {{0, 1, 2, 3}}) {
  const Limits options;
  Control control(options);
  return mesh_statistics(points, tets, {}, points.size(), tets.size(), control);
}

std::uint64_t total(const std::array<std::uint64_t, 12>& histogram) {
  return std::accumulate(histogram.begin(), histogram.end(), std::uint64_t{0});
}

Points scaled(Points points, double factor) {
  for (auto& p : points) {
    for (double& x : p) x *= factor;
  }
  return points;
}

void expect_finite(const MeshStatistics& s) {
  for (const double a :
       {s.min_face_angle, s.max_face_angle, s.min_dihedral, s.max_dihedral, s.mean_min_face_angle,
        s.mean_max_face_angle, s.mean_min_dihedral, s.mean_max_dihedral}) {
    EXPECT_GE(a, 0);  // false for NaN
    EXPECT_LE(a, 180);
  }
}

const Points kRegular = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
const Points kCorner = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const double kRegularDihedral = std::acos(1.0 / 3) * 180 / M_PI;

TEST(Statistics, RegularTetrahedron) {
  const MeshStatistics s = of(kRegular);
  EXPECT_NEAR(s.min_face_angle, 60, 1e-12);
  EXPECT_NEAR(s.max_face_angle, 60, 1e-12);
  EXPECT_NEAR(s.min_dihedral, kRegularDihedral, 1e-12);
  EXPECT_NEAR(s.max_dihedral, kRegularDihedral, 1e-12);
  EXPECT_NEAR(s.mean_min_dihedral, kRegularDihedral, 1e-12);
  EXPECT_NEAR(s.mean_max_face_angle, 60, 1e-12);
  EXPECT_EQ(s.dihedral_histogram[4], 6U);
  EXPECT_EQ(total(s.dihedral_histogram), 6U);
  EXPECT_EQ(total(s.face_angle_histogram), 12U);
  EXPECT_EQ(s.tetrahedra, 1U);
  EXPECT_EQ(s.vertices, 4U);
}

TEST(Statistics, OrthogonalCorner) {
  const MeshStatistics s = of(kCorner);
  EXPECT_NEAR(s.min_face_angle, 45, 1e-12);
  EXPECT_EQ(s.max_face_angle, 90);
  EXPECT_EQ(s.max_dihedral, 90);
  EXPECT_NEAR(s.min_dihedral, std::atan(std::sqrt(2.0)) * 180 / M_PI, 1e-12);
  EXPECT_NEAR(s.mean_min_face_angle, (3 * 45 + 60) / 4.0, 1e-12);
  EXPECT_NEAR(s.mean_max_face_angle, (3 * 90 + 60) / 4.0, 1e-12);
  EXPECT_EQ(s.dihedral_histogram[6], 3U);  // 90 opens the seventh bin
  EXPECT_EQ(s.dihedral_histogram[3], 3U);
}

// Three vertices close together and one far away: whichever of them is given first, the dihedral
// angles are the same, though computed from the far one the volume would lose half of its digits.
TEST(Statistics, OrderOfCornersDoesNotCostDigits) {
  const double far = 0x1.5555555555555p20;
  const Points given = {{0.1, 0.2, 0.3}, {1.1, 0.3, 0.1}, {0.3, 1.2, 0.4}, {far, far / 3, far / 7}};
  std::array<std::uint32_t, 4> order = {0, 1, 2, 3};
  const MeshStatistics first = of(given);
  do {
    Points points;
    for (const std::uint32_t i : order) points.push_back(given[i]);
    const MeshStatistics s = of(points);
    EXPECT_NEAR(s.min_dihedral, first.min_dihedral, 1e-11);
    EXPECT_NEAR(s.max_dihedral, first.max_dihedral, 1e-11);
    EXPECT_NEAR(s.min_face_angle, first.min_face_angle, 1e-11);
    EXPECT_NEAR(s.mean_min_dihedral, first.mean_min_dihedral, 1e-11);
  } while (std::next_permutation(order.begin(), order.end()));
}

// Each lane has its own tetrahedron, and all lanes are used; degenerate tetrahedra are left to the
// robust formulas.
TEST(CosineBatch, EveryLaneHasItsTetrahedron) {
  constexpr std::size_t n = CosineBatch::kLanes;
  Points points;
  Tets tets;
  for (std::uint32_t l = 0; l < n; ++l) {  // regular and corners in turn, of different sizes
    const Points p = scaled(l % 2 == 0 ? kRegular : kCorner, l + 1);
    points.insert(points.end(), p.begin(), p.end());
    tets.push_back({4 * l, 4 * l + 1, 4 * l + 2, 4 * l + 3});
  }
  CosineBatch batch;
  batch.measure(points, tets);
  const auto near = [](double found, double expected) { EXPECT_NEAR(found, expected, 1e-15); };
  for (std::size_t l = 0; l < n; ++l) {
    SCOPED_TRACE(l);
    EXPECT_TRUE(batch.ordinary[l]);
    const bool regular = l % 2 == 0;
    for (std::size_t e = 0; e < 6; ++e) {
      near(batch.dihedral[e][l], regular ? 1.0 / 3 : e < 3 ? 0 : std::sqrt(1.0 / 3));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      near(batch.face[0][k][l], 0.5);
      for (std::size_t f = 1; f < 4; ++f) {
        near(batch.face[f][k][l], regular ? 0.5 : k == 0 ? 0 : std::sqrt(0.5));
      }
    }
  }
  tets.pop_back();
  batch.measure(points, tets);
  EXPECT_TRUE(batch.ordinary[n - 2]);
  EXPECT_FALSE(batch.ordinary[n - 1]);
}

TEST(CosineBatch, ExtremesAreNotOrdinary) {
  CosineBatch batch;
  const auto ordinary = [&](const Points& points, const Tets& tets = {{0, 1, 2, 3}}) {
    batch.measure(points, tets);
    return batch.ordinary[0];
  };
  for (const double scale : {1e-20, 1e-3, 1.0, 1e20}) EXPECT_TRUE(ordinary(scaled(kCorner, scale)));
  for (const double scale : {0.0, 1e-320, 1e-160, 1e-80, 1e80, 1e160, 1e300}) {
    EXPECT_FALSE(ordinary(scaled(kCorner, scale))) << scale;
    EXPECT_FALSE(ordinary(scaled(kRegular, scale))) << scale;
  }
  // One edge, one height and one vertex of next to nothing, whichever vertices they are at.
  for (const double tiny : {0.0, 1e-300, 1e-170, 1e-155, 1e-100, 1e-40, 1e-5, 0.01}) {
    Tets tet = {{0, 1, 2, 3}};
    do {
      EXPECT_FALSE(ordinary({{0, 0, 0}, {tiny, 0, 0}, {0, 1, 0}, {0, 0, 1}}, tet)) << tiny;
      EXPECT_FALSE(ordinary({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, tiny}}, tet)) << tiny;
      EXPECT_FALSE(ordinary({{0, 0, 0}, {1, 0, 0}, {0.5, tiny, 0}, {0, 0, 1}}, tet)) << tiny;
    } while (std::next_permutation(tet[0].begin(), tet[0].end()));
  }
}

// The corner of a cube: inscribed sphere of radius 1 / (3 + sqrt 3), circumsphere of radius
// sqrt(3) / 2, squared edges of 9, squared doubled areas of 6. Tiny and huge ones, and one whose
// edges are not comparable, take the robust formulas.
TEST(Statistics, ShapesByHand) {
  const double gamma = 3 / (3 + std::sqrt(3.0)) / (std::sqrt(3.0) / 2), sicn = 6 / std::sqrt(54.0);
  for (const double scale : {1.0, 1e-3, 1e-200, 1e200, 1e-307, 1.7e307}) {
    SCOPED_TRACE(scale);
    MeshStatistics s = of(scaled(kRegular, scale), {{0, 2, 1, 3}});
    for (const double value : {s.min_gamma, s.mean_gamma, s.gamma_1_percent, s.min_sicn}) {
      EXPECT_NEAR(value, 1, 1e-14);
    }
    s = of(scaled(kCorner, scale));
    EXPECT_NEAR(s.mean_gamma, gamma, 1e-14);
    EXPECT_NEAR(s.mean_sicn, sicn, 1e-14);
    s = of(scaled(kCorner, scale), {{1, 0, 2, 3}});
    EXPECT_NEAR(s.mean_gamma, gamma, 1e-14);
    EXPECT_NEAR(s.mean_sicn, -sicn, 1e-14);
  }
  // Inscribed sphere of radius h / 2, circumsphere of radius sqrt(1 / 2).
  const MeshStatistics low = of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e-9}});
  EXPECT_NEAR(low.min_gamma / (1.5e-9 / std::sqrt(0.5)), 1, 1e-8);
  const MeshStatistics flat = of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  EXPECT_EQ(flat.min_gamma, 0);
  EXPECT_EQ(flat.min_sicn, 0);
  const MeshStatistics incomparable = of({{0, 0, 0}, {0, 0, 1e-250}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(incomparable.min_gamma, 0);
}

TEST(Statistics, BothWaysGiveTheSameShapes) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int round = 0; round < 200; ++round) {
    Points points(4);
    for (auto& p : points) p = {coordinate(random), coordinate(random), coordinate(random)};
    const MeshStatistics s = of(points), far = of(scaled(points, 0x1p700));
    EXPECT_NEAR(s.mean_gamma, far.mean_gamma, 1e-12);
    EXPECT_NEAR(s.mean_sicn, far.mean_sicn, 1e-12);
    EXPECT_EQ(s.sharpest_dihedral, far.sharpest_dihedral);
    EXPECT_EQ(s.sharpest_face_angle, far.sharpest_face_angle);
  }
}

// Slivers over a common triangle, with a vertex each: at angles of 0.1 degrees, 0.2, and so on.
struct Slivers {
  explicit Slivers(int count) : points{{0, 0, 0}, {1, 0, 0}, {0.5, -1, 0}} {
    for (int n = 1; n <= count; ++n) {
      const double angle = 0.1 * n * M_PI / 180;
      tets.push_back({0, 1, 2, static_cast<std::uint32_t>(points.size())});
      points.push_back({0.5, -std::cos(angle), -std::sin(angle)});
    }
  }
  Points points;
  Tets tets;
};

TEST(Statistics, QuantilesAndCounts) {
  for (const int count : {1, 2, 99, 100, 101, 150, 1001, 1701}) {
    SCOPED_TRACE(count);
    Slivers slivers(count);
    std::shuffle(slivers.tets.begin(), slivers.tets.end(), std::mt19937(5));
    const MeshStatistics s = of(slivers.points, slivers.tets);
    EXPECT_NEAR(s.dihedral_1_percent, 0.1 * (1 + 0.01 * (count - 1)), 1e-9);
    std::vector<double> gammas;
    for (const auto& tet : slivers.tets) gammas.push_back(of(slivers.points, {tet}).mean_gamma);
    std::sort(gammas.begin(), gammas.end());
    const double place = 0.01 * (count - 1);
    const auto below = static_cast<std::size_t>(place);
    const double above = gammas[std::min(below + 1, gammas.size() - 1)];
    const double part = place - std::floor(place);
    EXPECT_NEAR(s.gamma_1_percent, gammas[below] + part * (above - gammas[below]), 1e-12);
    EXPECT_EQ(s.min_gamma, gammas.front());
    EXPECT_NEAR(s.mean_gamma, std::accumulate(gammas.begin(), gammas.end(), 0.0) / count, 1e-12);
    if (count == 1001) {  // rounding decides about the two at the bounds
      EXPECT_NEAR(static_cast<double>(s.below_5), 49.5, 0.6);
      EXPECT_NEAR(static_cast<double>(s.below_10), 99.5, 0.6);
    }
  }
}

TEST(Statistics, TellsWhereTheSmallestAnglesAre) {
  Slivers slivers(300);
  std::shuffle(slivers.tets.begin(), slivers.tets.end(), std::mt19937(6));
  // The sharpest one is over the edge 01 and has vertex 3.
  MeshStatistics s = of(slivers.points, slivers.tets);
  EXPECT_EQ(s.sharpest_dihedral, (std::array<std::uint32_t, 4>{0, 1, 2, 3}));
  // A needle at vertex 0, once as an ordinary tetrahedron and once not.
  for (const double width : {0.06, 1e-5}) {
    Points points = slivers.points;
    const auto n = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), {{0, width, 0}, {0, 0, 1}, {width, 0, 0}});
    Tets tets = slivers.tets;
    for (auto& tet : tets) {  // others have no small face angles
      if (tet[3] < 103) tet[3] = n - 1;
    }
    tets.insert(tets.begin() + 7, {n + 1, n, 0, n + 2});
    s = of(points, tets);
    EXPECT_EQ(s.sharpest_face_angle[0], n + 1) << width;
  }
}

TEST(Statistics, SharedFacesCountOnce) {
  // Two corners glued along the face x = 0: three orthogonal faces of the second are new.
  Points points = kCorner;
  points.push_back({-1, 0, 0});
  const MeshStatistics s = of(points, {{0, 1, 2, 3}, {0, 4, 3, 2}});
  EXPECT_EQ(total(s.face_angle_histogram), 3U * 7U);
  EXPECT_EQ(total(s.dihedral_histogram), 12U);
  EXPECT_NEAR(s.mean_min_face_angle, (5 * 45 + 2 * 60) / 7.0, 1e-12);
}

TEST(Statistics, FaceCountOfAGrid) {
  // Kuhn subdivision of n^3 cubes: 12 n^3 + 6 n^2 faces.
  const int n = 5;
  Points points;
  Tets tets;
  const auto id = [&](int x, int y, int z) {
    return static_cast<std::uint32_t>((x * (n + 1) + y) * (n + 1) + z);
  };
  for (int x = 0; x <= n; ++x) {
    for (int y = 0; y <= n; ++y) {
      for (int z = 0; z <= n; ++z) points.push_back({double(x), double(y), double(z)});
    }
  }
  const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int cube = 0; cube < n * n * n; ++cube) {
    for (const auto& o : order) {
      int at[3] = {cube / (n * n), cube / n % n, cube % n};
      std::array<std::uint32_t, 4> tet{id(at[0], at[1], at[2])};
      for (int i = 0; i < 3; ++i) {
        ++at[o[i]];
        tet[i + 1] = id(at[0], at[1], at[2]);
      }
      tets.push_back(tet);
    }
  }
  const MeshStatistics s = of(points, tets);
  EXPECT_EQ(total(s.face_angle_histogram), 3U * (12 * n * n * n + 6 * n * n));
  EXPECT_NEAR(s.min_dihedral, 45, 1e-12);
  EXPECT_EQ(s.max_dihedral, 90);
}

TEST(Statistics, ScaleDoesNotMatter) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int round = 0; round < 200; ++round) {
    Points points(4);
    for (auto& p : points) p = {coordinate(random), coordinate(random), coordinate(random)};
    const MeshStatistics s = of(points);
    for (const int exponent : {-1000, -660, -300, 300, 660, 1020}) {
      const MeshStatistics t = of(scaled(points, std::ldexp(1.0, exponent)));
      EXPECT_NEAR(s.min_face_angle, t.min_face_angle, 1e-9);
      EXPECT_NEAR(s.min_dihedral, t.min_dihedral, 1e-9);
      EXPECT_NEAR(s.max_dihedral, t.max_dihedral, 1e-9);
      // Far from ordinary sizes every angle is computed in another way.
      EXPECT_NEAR(s.mean_min_face_angle, t.mean_min_face_angle, 1e-9);
      EXPECT_NEAR(s.mean_max_face_angle, t.mean_max_face_angle, 1e-9);
      EXPECT_NEAR(s.min_gamma, t.min_gamma, 1e-9);
      EXPECT_NEAR(s.min_sicn, t.min_sicn, 1e-9);
      EXPECT_EQ(s.face_angle_histogram, t.face_angle_histogram);
      EXPECT_EQ(s.dihedral_histogram, t.dihedral_histogram);
    }
  }
  for (const double factor : {1e-200, 1e200, 1e-307, 1.7e308}) {
    const MeshStatistics s = of(scaled(kRegular, factor));
    EXPECT_NEAR(s.min_face_angle, 60, 1e-12);
    EXPECT_NEAR(s.max_dihedral, kRegularDihedral, 1e-12);
  }
}

TEST(Statistics, Needle) {
  for (const double height : {1e3, 1e8, 1e40, 1e100, 1e290}) {
    // An equilateral base and an apex far above its centre.
    const double r = std::sqrt(3.0);
    const MeshStatistics s =
        of({{2, 0, 0}, {-1, r, 0}, {-1, -r, 0}, {0, 0, height}}, {{0, 1, 2, 3}});
    const double slope = std::atan2(height, 1.0) * 180 / M_PI;
    EXPECT_NEAR(s.max_dihedral, slope, 1e-9) << height;
    EXPECT_NEAR(s.min_dihedral, 60, 200 / height + 1e-9) << height;
    const double apex = 2 * std::atan(r / std::hypot(height, 1.0)) * 180 / M_PI;
    // Relative accuracy, unless the edges are too different to share a scale.
    const double tolerance = height < 1e50 ? 1e-9 * apex : 1e-12;
    EXPECT_NEAR(s.min_face_angle, apex, tolerance) << height;
  }
}

TEST(Statistics, TinyEdgeKeepsItsAngles) {
  // An edge of 1e-250 in a tetrahedron of size 1, perpendicular to the others there.
  const MeshStatistics s = of({{0, 0, 0}, {0, 0, 1e-250}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(s.max_face_angle, 90);
  EXPECT_EQ(s.max_dihedral, 90);
  EXPECT_LT(s.min_face_angle, 1e-200);
  EXPECT_GE(s.min_face_angle, 0);
}

TEST(Statistics, Sliver) {
  for (const double h : {1e-3, 1e-8, 1e-14}) {
    // The square's diagonals, one of them lifted by h.
    const MeshStatistics s = of({{1, 0, 0}, {-1, 0, 0}, {0, 1, h}, {0, -1, h}});
    // At the diagonals 180 - 2 atan(h); at the sides the planes z = h y and z = h (1 - x) meet.
    EXPECT_NEAR(s.max_dihedral, 180 - 2 * std::atan(h) * 180 / M_PI, 1e-12);
    EXPECT_NEAR(s.min_dihedral / (std::sqrt(2.0) * h * 180 / M_PI), 1, 1e-5);
    EXPECT_NEAR(s.min_face_angle, 45, 1e-2);
  }
}

TEST(Statistics, FlatTetrahedra) {
  const MeshStatistics quad = of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  EXPECT_EQ(quad.min_dihedral, 0);
  EXPECT_EQ(quad.max_dihedral, 180);
  EXPECT_EQ(quad.dihedral_histogram[11], 2U);
  EXPECT_EQ(quad.dihedral_histogram[0], 4U);
  const MeshStatistics centre = of({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}});
  EXPECT_EQ(centre.dihedral_histogram[11], 3U);
  EXPECT_EQ(centre.dihedral_histogram[0], 3U);
}

TEST(Statistics, DegenerateButNoNaN) {
  for (const Points& points :
       {Points{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
        Points{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}},
        Points{{1, 2, 3}, {1, 2, 3}, {0, 1, 0}, {5, 5, 1}},
        Points{{0, 0, 0}, {5e-324, 0, 0}, {0, 5e-324, 0}, {0, 0, 5e-324}},
        Points{{-1.7e308, 0, 0}, {1.7e308, 0, 0}, {0, 1.7e308, 0}, {0, 0, -1.7e308}},
        Points{{0, 0, 0}, {1e-300, 0, 0}, {1e300, 1, 0}, {0, 0, 1e-20}}}) {
    const MeshStatistics s = of(points);
    expect_finite(s);
    EXPECT_EQ(total(s.dihedral_histogram), 6U);
    EXPECT_EQ(total(s.face_angle_histogram), 12U);
  }
  EXPECT_EQ(of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).max_dihedral, 180);
}

TEST(Statistics, EmptyMesh) {
  const MeshStatistics s = of({}, {});
  EXPECT_EQ(s.tetrahedra, 0U);
  expect_finite(s);
  EXPECT_EQ(s.max_face_angle, 0);
}

// The polynomial is as good as the library's function.
TEST(Cosines, DegreesAreThoseOfTheArcCosine) {
  std::vector<double> cosines = {1, -1, 0, 0.5, -0.5, std::nextafter(0.5, 1), 0x1p-40, 1 - 0x1p-50};
  for (int n = -1000; n <= 1000; ++n) cosines.push_back(std::sin(n * 1.5e-3));
  std::vector<double> degrees = cosines;
  degrees_of_cosines(degrees);
  for (std::size_t n = 0; n < cosines.size(); ++n) {
    EXPECT_NEAR(degrees[n], std::acos(cosines[n]) * 180 / M_PI, 1e-13) << cosines[n];
  }
}

// Lanes without a tetrahedron, and tetrahedra for the robust formulas, are told from the others.
TEST(Cosines, ABatchKnowsItsOrdinaryTetrahedra) {
  const std::vector<std::array<double, 3>> points = {{0, 0, 0}, {1, 0, 0},    {0, 1, 0}, {0, 0, 1},
                                                     {2, 0, 0}, {1e-9, 0, 0}, {1, 1, 0}};
  const std::vector<std::array<std::uint32_t, 4>> tetrahedra = {
      {0, 1, 2, 3}, {0, 1, 4, 3}, {0, 5, 2, 3}, {0, 1, 6, 2}, {4, 6, 2, 3}};
  CosineBatch batch;
  batch.measure(points, tetrahedra);
  const std::vector<bool> expected = {true, false, false, false, true};  // face, edge, volume
  for (std::size_t l = 0; l < CosineBatch::kLanes; ++l) {
    EXPECT_EQ(batch.ordinary[l], l < expected.size() && expected[l]) << l;
  }
  EXPECT_NEAR(batch.face[0][0][0], 0.5, 1e-15);                  // the large face, equilateral
  EXPECT_NEAR(batch.dihedral[0][0], 0, 1e-15);                   // at an edge of the right corner
  EXPECT_NEAR(batch.dihedral[3][0], 1 / std::sqrt(3.0), 1e-15);  // at an edge of the large face
}

}  // namespace
}  // namespace delmesher::output::statistics_test
