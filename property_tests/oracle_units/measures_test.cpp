// Volumes, altitudes, angles and shapes of tetrahedra.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <vector>

#include "oracles/base/exact_points.h"
#include "oracles/mesh/angles.h"
#include "oracles/mesh/measures.h"
#include "oracles/mesh/shapes.h"
#include "oracles/mesh/tet_complex.h"
#include "oracles/surface/corners.h"
#include "oracles/surface/input_surface.h"
#include "property_tests/oracle_units/helpers.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT

Position position(const std::array<long, 3>& x) {
  return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
}

TEST(Measures, VolumesAddUpWhateverTheNeighbours) {
  std::mt19937 random(13);
  std::vector<Position> positions(12);
  for (Position& p : positions) {
    for (double& x : p) x = static_cast<int>(random() % 21) - 10;
  }
  const ExactPoints points = points_of(positions);
  for (int round = 0; round < 300; ++round) {
    // Random tetrahedra of any orientation, which share faces or not; and the neighbours claimed
    // for them may be right or wrong.
    TetComplex complex;
    complex.points = &points;
    Neighbours neighbours;
    std::vector<std::uint8_t> selected;
    ExactSum sum;
    for (std::size_t t = 0; t < 30; ++t) {
      std::array<Index, 12> order;
      std::iota(order.begin(), order.end(), 0U);
      std::shuffle(order.begin(), order.begin() + 6, random);
      complex.tetrahedra.push_back({order[0], order[1], order[2], order[3]});
      complex.inside.push_back(1);
      selected.push_back(random() % 3 != 0);
      if (selected.back() != 0)
        sum += exact::volume6(points, order[0], order[1], order[2], order[3]);
    }
    neighbours.across.assign(4 * complex.tetrahedra.size(), kNone);
    for (Index i = 0; i < neighbours.across.size(); ++i) {
      for (Index j = 0; j < i; ++j) {
        Face f = face_of(complex.tetrahedra[i / 4], static_cast<int>(i % 4)),
             g = face_of(complex.tetrahedra[j / 4], static_cast<int>(j % 4));
        std::sort(f.begin(), f.end());
        std::sort(g.begin(), g.end());
        if (f != g && random() % 200 != 0) continue;
        neighbours.across[i] = j;
        neighbours.across[j] = i;
      }
    }
    ASSERT_EQ(sum_of_volumes6(complex, neighbours, selected), sum);
  }
}

TEST(Angles, BelowTheBoundAreFoundAmongMachineIntegers) {
  std::mt19937 random(17);
  std::size_t counts[2] = {};
  for (int round = 0; round < 3000; ++round) {
    const long size = round % 2 == 0 ? 4 : 1000;
    std::array<std::array<long, 3>, 4> p;
    std::vector<Position> positions;
    for (auto& x : p) {
      for (long& c : x) c = static_cast<long>(random() % static_cast<unsigned long>(size));
      positions.push_back(position(x));
    }
    const ExactPoints points = points_of(positions);
    const int orientation = exact::orient3d(points, 0, 1, 2, 3);
    if (orientation == 0) continue;
    TetComplex complex;
    complex.points = &points;
    complex.tetrahedra = {orientation > 0 ? Tet{0, 1, 2, 3} : Tet{0, 1, 3, 2}};
    complex.inside = {1};
    Neighbours neighbours;
    neighbours.across.assign(4, kNone);
    const Polyhedron polyhedron = {
        positions, {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}}, {}, {}};
    InputSurface surface;
    ASSERT_EQ(surface.assign(polyhedron, points), "");
    const Places places(complex, neighbours, surface);
    for (const double delta : {20.0, 45.0, 45.001}) {
      bool below = false, close = false;
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) {
          for (int c = 0; c < b; ++c) {
            if (a == b || a == c) continue;
            long uv = 0, uu = 0, vv = 0;
            for (int axis = 0; axis < 3; ++axis) {
              const long u = p[b][axis] - p[a][axis], v = p[c][axis] - p[a][axis];
              uv += u * v;
              uu += u * u;
              vv += v * v;
            }
            const long double cosine2 = static_cast<long double>(uv) * uv / uu / vv;
            const long double bound = std::pow(std::cos(delta * std::acos(-1.0L) / 180), 2);
            // An angle of exactly 45 degrees is not below 45.
            const bool equal = delta == 45 && 2 * uv * uv == uu * vv;
            below = below || (uv > 0 && !equal && cosine2 > bound);
            close = close || (uv > 0 && !equal && std::fabs(cosine2 - bound) < 1e-7L);
          }
        }
      }
      if (close) continue;
      const OracleReport report = check_angles(complex, neighbours, places, delta, AngleScope::all);
      ASSERT_EQ(report.violations > 0, below) << "round " << round << ", " << delta;
      ++counts[below];
    }
  }
  EXPECT_GT(counts[0], 300U);
  EXPECT_GT(counts[1], 300U);
}

// A regular tetrahedron and one that was pressed flat when it was written: 20 degrees are kept in
// the record, not in the file. The face (0 1 3) then has the angle whose tangent is 0.1.
TEST(Angles, OfAFileAreThoseOfTheMeshBeforeItWasWritten) {
  const std::vector<Position> written = {{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, 0, 0.1}};
  std::vector<Position> meant = written;
  meant[3][2] = 1.5;
  const ExactPoints points = points_of(written), before = points_of(meant);
  TetComplex complex;
  complex.points = &points;
  complex.tetrahedra = {{0, 1, 2, 3}};
  complex.inside = {1};
  Neighbours neighbours;
  neighbours.across.assign(4, kNone);
  const Polyhedron solid = {written, {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}}, {}, {}};
  InputSurface surface;
  ASSERT_EQ(surface.assign(solid, points), "");
  const Places places(complex, neighbours, surface);
  const auto checked = [&](const BeforeWriting& how) {
    return check_angles(complex, neighbours, places, 20, AngleScope::all, how);
  };
  EXPECT_STREQ(checked({}).status(), "FAIL");
  const OracleReport kept = checked({&before, {0, 1, 2, 3}});
  EXPECT_STREQ(kept.status(), "pass");
  EXPECT_EQ(kept.figure("bad as written alone"), 1);
  EXPECT_NEAR(kept.figure("smallest angle of these").value(),
              std::atan(0.1) * 180 / std::acos(-1.0), 1e-6);
  // The record has another tetrahedron there, which is as flat, or none.
  EXPECT_STREQ(checked({&points, {0, 1, 2, 3}}).status(), "FAIL");
  EXPECT_STREQ(checked({&before, {0, 1, 2}}).status(), "FAIL");
  EXPECT_STREQ(checked({&before, {0, 1, 2, 4}}).status(), "FAIL");
  // Without a record: 14.3 degrees are missing, and an edge of 1 turns by that where its ends move
  // by an eighth.
  EXPECT_STREQ(checked({nullptr, {}, 0.25}).status(), "undecided");
  EXPECT_STREQ(checked({nullptr, {}, 0.01}).status(), "FAIL");
}

// The corner of a cube has an inscribed sphere of radius 1 / (3 + sqrt 3), a circumsphere of radius
// sqrt(3) / 2, squared edges of 9 and squared doubled areas of 6. Far from the origin, tiny, or
// nearly flat, it needs exact coordinates.
TEST(Shapes, ByHand) {
  const auto shape = [](const std::vector<Position>& positions, const Tet& tet = {0, 1, 2, 3}) {
    return shape_of(points_of(positions), tet);
  };
  const std::vector<Position> regular = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  EXPECT_NEAR(shape(regular, {0, 1, 3, 2}).gamma, 1, 1e-14);
  EXPECT_NEAR(shape(regular, {0, 1, 3, 2}).sicn, 1, 1e-14);
  const double gamma = 3 / (3 + std::sqrt(3.0)) / (std::sqrt(3.0) / 2), sicn = 6 / std::sqrt(54.0);
  for (const double size : {1.0, 1e-3, 0x1p-200, 0x1p200}) {
    const std::vector<Position> corner = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
    EXPECT_NEAR(shape(corner).gamma, gamma, 1e-14) << size;
    EXPECT_NEAR(shape(corner).sicn, sicn, 1e-14) << size;
    EXPECT_NEAR(shape(corner, {1, 0, 2, 3}).gamma, gamma, 1e-14) << size;
    EXPECT_NEAR(shape(corner, {1, 0, 2, 3}).sicn, -sicn, 1e-14) << size;
  }
  const double far = 0x1p50;
  EXPECT_NEAR(shape({{far, 0, 0}, {far + 1, 0, 0}, {far, 1, 0}, {far, 0, 1}}).gamma, gamma, 1e-14);
  for (const double h : {1e-4, 1e-9, 1e-200}) {
    const TetShape low = shape({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, h}});
    EXPECT_NEAR(low.gamma / (1.5 * h / std::sqrt(0.5)), 1, 2 * h + 1e-12) << h;
    EXPECT_NEAR(low.sicn / (6 * h / std::sqrt(12.0)), 1, 2 * h + 1e-12) << h;
  }
  const TetShape flat = shape({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
  EXPECT_EQ(flat.gamma, 0);
  EXPECT_EQ(flat.sicn, 0);
}

// Where doubles count as certain, they are as good as exact coordinates, which tiny tetrahedra ask
// for.
TEST(Shapes, DoublesAgreeWithExactCoordinates) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int round = 0; round < 300; ++round) {
    std::vector<Position> near(4);
    const double height = std::pow(10, -7 * coordinate(random) - 7);
    for (auto& p : near) p = {coordinate(random), coordinate(random), height * coordinate(random)};
    std::vector<Position> tiny = near;
    for (auto& p : tiny) {
      for (double& x : p) x *= 0x1p-150;  // too small for doubles
    }
    const TetShape a = shape_of(points_of(near), {0, 1, 2, 3});
    const TetShape b = shape_of(points_of(tiny), {0, 1, 2, 3});
    EXPECT_NEAR(a.gamma, b.gamma, 1e-7 * b.gamma);
    EXPECT_NEAR(a.sicn, b.sicn, 1e-7 * std::fabs(b.sicn));
  }
}

TEST(Shapes, QuantilesAndCounts) {
  for (const int count : {1, 2, 100, 101, 250}) {
    ShapeMeasure measure;
    std::vector<int> order(static_cast<std::size_t>(count));
    std::iota(order.begin(), order.end(), 1);
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    for (const int n : order) measure.add({0.001 * n, -0.002 * n}, 0.1 * n);
    OracleReport report("angles");
    measure.report(report);
    const std::map<std::string, double> figures(report.figures.begin(), report.figures.end());
    const double place = 1 + 0.01 * (count - 1);
    EXPECT_NEAR(figures.at("1 % quantile of gamma"), 0.001 * place, 1e-12);
    EXPECT_NEAR(figures.at("1 % quantile of smallest dihedral angles"), 0.1 * place, 1e-12);
    EXPECT_EQ(figures.at("tetrahedra below 5 degrees"), std::min(count, 49));
    EXPECT_EQ(figures.at("tetrahedra below 10 degrees"), std::min(count, 99));
    EXPECT_NEAR(figures.at("smallest gamma"), 0.001, 1e-12);
    EXPECT_NEAR(figures.at("mean gamma"), 0.0005 * (count + 1), 1e-12);
    EXPECT_NEAR(figures.at("smallest SICN"), -0.002 * count, 1e-12);
    EXPECT_NEAR(figures.at("mean SICN"), -0.001 * (count + 1), 1e-12);
  }
  OracleReport none("angles");
  ShapeMeasure().report(none);
  EXPECT_TRUE(none.figures.empty());
}

TEST(AngleBound, IntervalsNeverContradictIntegers) {
  std::mt19937 random(19);
  std::size_t decided = 0, not_above = 0;
  for (const double degrees : {25.0, 60.0, 90.0}) {
    for (const Doubt doubt : {Doubt::acute, Doubt::not_acute}) {
      const AngleBound bound(degrees, doubt);
      for (int round = 0; round < 2000; ++round) {
        std::array<std::array<long, 3>, 2> u;
        for (auto& x : u) {
          for (long& c : x) c = static_cast<long>(random() % 9) - 4;
        }
        const auto dot = [&](int i, int j) {
          return u[i][0] * u[j][0] + u[i][1] * u[j][1] + u[i][2] * u[j][2];
        };
        const long cosine = dot(0, 1), norms = dot(0, 0) * dot(1, 1);
        const bool surely = bound.surely_not_above(Interval(static_cast<double>(cosine)),
                                                   Interval(static_cast<double>(norms)));
        const bool above = bound.above(cosine, norms);
        ASSERT_FALSE(surely && above) << degrees << ": " << cosine << " of " << norms;
        decided += surely ? 1 : 0;
        not_above += above ? 0 : 1;
      }
    }
  }
  EXPECT_GT(decided, not_above / 2);  // most are far from the bound
}

TEST(AngleBound, TurnsOnAFacetAreThoseOfTheirProjections) {
  std::mt19937 random(23);
  std::size_t counts[3] = {};
  for (int round = 0; round < 2000; ++round) {
    // A facet in the plane z = 0, seen from above, and points over and under it.
    std::vector<Position> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    std::array<std::array<long, 3>, 3> p;
    for (auto& x : p) {
      for (long& c : x) c = static_cast<long>(random() % 7) - 3;
      positions.push_back(position(x));
    }
    const ExactPoints points = points_of(positions);
    InputSurface::Facet facet;
    facet.span = {0, 1, 2};
    facet.rough_normal = exact::rough_area2(points, 0, 1, 2);
    const long turn =
        (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    const int wanted = turn > 0 ? 1 : turn < 0 ? -1 : 0;
    ASSERT_EQ(left_turn(points, facet, 3, 4, 5), wanted);
    ++counts[wanted + 1];
  }
  for (const std::size_t count : counts) EXPECT_GT(count, 100U);
}

TEST(Measures, SmallestAltitude) {
  // Over the triangle (0,0) (3,0) (0,4), whose legs are 3 and 4; the other faces are smaller.
  const ExactPoints p = points_of({{0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {0, 0, 0.25}, {1, 1, 0}});
  const double sides[4] = {6, 1.5 * 0.25, 2 * 0.25, 0};
  const double oblique = std::sqrt(36 + sides[1] * sides[1] + sides[2] * sides[2]);  // de Gua
  const double volume = 6 * 0.25 / 3;
  EXPECT_NEAR(smallest_altitude(p, {0, 1, 2, 3}), 3 * volume / oblique, 1e-15);
  EXPECT_NEAR(smallest_altitude(p, {0, 2, 1, 3}), 3 * volume / oblique, 1e-15);
  EXPECT_EQ(smallest_altitude(p, {0, 1, 2, 4}), 0);
}

}  // namespace
}  // namespace tetproof
