// The input surface: its facets, its interior, and the tree of boxes that finds its triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "oracles/base/exact_points.h"
#include "oracles/surface/input_surface.h"
#include "property_tests/oracle_units/helpers.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactPoint;

using Rational = std::array<mpq_class, 3>;

// The part of a polygon on the inner side of the plane through three points.
std::vector<Rational> clipped(const std::vector<Rational>& polygon,
                              const std::array<Rational, 4>& tet, int face, bool& touches_inside) {
  const auto height = [&](const Rational& x) {
    const auto &a = tet[(face + 1) % 4], &b = tet[(face + 2) % 4], &c = tet[(face + 3) % 4];
    const auto at = [&](const auto& p) {
      mpq_class sum = 0;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const mpq_class n = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
        sum += n * (p[i] - a[i]);
      }
      return sum;
    };
    return mpq_class(at(x) * sgn(at(tet[face])));
  };
  std::vector<Rational> result;
  touches_inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const mpq_class s = height(p), t = height(q);
    touches_inside = touches_inside || s > 0;
    if (s >= 0) result.push_back(p);
    if (sgn(s) * sgn(t) >= 0) continue;
    Rational cut;
    for (int k = 0; k < 3; ++k) cut[k] = (s * q[k] - t * p[k]) / (s - t);
    result.push_back(cut);
  }
  return result;
}

// Triangles that are larger than tetrahedra, and pass by them at all distances, 0 and such that
// doubles do not tell from 0 among them; against clipping in rational coordinates.
TEST(InputSurface, EntersWhatRationalClippingSaysItEnters) {
  std::mt19937_64 random(11);
  std::array<int, 2> counts{};
  for (int round = 0; round < 3000; ++round) {
    std::array<Position, 4> solid, tet;
    for (Position& x : solid) {
      for (double& c : x) c = static_cast<int>(random() % 19) - 9;
    }
    for (Position& x : tet) {
      for (double& c : x) {
        c = static_cast<int>(random() % 4);
        if (round % 2 == 0) c += (static_cast<int>(random() % 3) - 1) * 0x1p-51;
      }
    }
    if (round % 3 == 0) tet[0] = solid[0];
    std::vector<Position> positions;
    std::array<Rational, 4> exact_tet;
    positions.insert(positions.end(), solid.begin(), solid.end());
    positions.insert(positions.end(), tet.begin(), tet.end());
    for (std::size_t v = 0; v < 4; ++v) {
      exact_tet[v] = {mpq_class(tet[v][0]), mpq_class(tet[v][1]), mpq_class(tet[v][2])};
    }
    const ExactPoints points = points_of(positions);
    if (exact::orient3d(points, 0, 1, 2, 3) == 0) continue;
    std::array<Index, 4> corners = {4, 5, 6, 7};
    const int orientation = exact::orient3d(points, 4, 5, 6, 7);
    if (orientation == 0) continue;
    if (orientation < 0) std::swap(corners[2], corners[3]);
    const Polyhedron polyhedron = {{positions.begin(), positions.begin() + 4},
                                   {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}},
                                   {},
                                   {}};
    InputSurface surface;
    ASSERT_EQ(surface.assign(polyhedron, points), "");
    bool entered = false;
    for (int without = 0; without < 4; ++without) {
      std::vector<Rational> polygon;
      for (int v = 0; v < 4; ++v) {
        if (v == without) continue;
        polygon.push_back({mpq_class(solid[v][0]), mpq_class(solid[v][1]), mpq_class(solid[v][2])});
      }
      bool inside = true;
      for (int face = 0; face < 4; ++face) {
        bool ignored = false;
        polygon = clipped(polygon, exact_tet, face, ignored);
      }
      for (int face = 0; face < 4; ++face) {
        bool touches = false;
        clipped(polygon, exact_tet, face, touches);
        inside = inside && touches;
      }
      entered = entered || inside;
    }
    InputSurface::PlaneSides known;
    ASSERT_EQ(surface.contact(points, corners, known).enters, entered) << "round " << round;
    ++counts[entered];
  }
  EXPECT_GT(counts[0], 300);
  EXPECT_GT(counts[1], 300);
}

// Also where triangles occur twice, or have sides in common in either direction.
TEST(SumOfAreas, IsThatOfTheTrianglesOneByOne) {
  std::mt19937 random(13);
  for (int round = 0; round < 200; ++round) {
    std::vector<Position> positions(6);
    for (Position& p : positions) {
      for (double& x : p) x = static_cast<int>(random() % 19) - 9;
    }
    const ExactPoints points = points_of(positions);
    std::vector<std::array<Index, 3>> triangles(1 + random() % 8);
    std::array<ExactSum, 3> sum;
    for (auto& corners : triangles) {
      const auto first = static_cast<Index>(random() % 6);
      corners = {first, (first + 1 + static_cast<Index>(random() % 2)) % 6, (first + 4) % 6};
      const ExactVector area = exact::area2(points, corners[0], corners[1], corners[2]);
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += area[axis];
    }
    EXPECT_TRUE(sum_of_areas2(points, triangles) == sum) << round;
  }
}

// Sides on segments are taken together. Two segments have a corner in common, and each has points
// beyond its ends; one has its corners in descending order in a definition.
TEST(SumOfAreas, IsThatOfTheTrianglesOneByOneOnSegments) {
  std::mt19937 random(17);
  std::vector<ExactPoint> definitions;
  for (const Position& p : {Position{3, 1, 4}, {1, 5, 9}, {2, 6, 5}, {3, 5, 8}}) {
    definitions.push_back({ExactPoint::Kind::explicit_point, 0, 0, 0, p[0], p[1], p[2]});
  }
  for (const double share : {-0.25, 0.125, 0.7, 1.5}) {
    definitions.push_back({ExactPoint::Kind::on_segment, 0, 1, 0, share, 0, 0});
    definitions.push_back({ExactPoint::Kind::on_segment, 2, 1, 0, share, 0, 0});
  }
  definitions.push_back({ExactPoint::Kind::on_segment, 1, 0, 0, 0.3, 0, 0});
  definitions.push_back({ExactPoint::Kind::on_triangle, 0, 1, 2, 0.3, 0.1, 0});
  ExactPoints points;
  ASSERT_EQ(points.assign(definitions), "");
  const auto any = [&] { return static_cast<Index>(random() % points.size()); };
  for (int round = 0; round < 500; ++round) {
    std::vector<std::array<Index, 3>> triangles(1 + random() % 8);
    std::array<ExactSum, 3> sum;
    for (auto& corners : triangles) {
      corners = {any(), any(), any()};
      const ExactVector area = exact::area2(points, corners[0], corners[1], corners[2]);
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += area[axis];
    }
    ASSERT_TRUE(sum_of_areas2(points, triangles) == sum) << round;
  }
}

TEST(BoxTree, FindsWhatMeetsTheQueryAndNothingFarInAHalfSpace) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> real(-1, 1);
  std::vector<BoxTree::Box> boxes(500);
  for (BoxTree::Box& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = real(random);
      box.high[axis] = box.low[axis] + 0.1 * std::fabs(real(random));
    }
  }
  const BoxTree tree(boxes);
  std::size_t left_out = 0, kept = 0;
  for (int round = 0; round < 200; ++round) {
    BoxTree::Box query;
    for (int axis = 0; axis < 3; ++axis) {
      query.low[axis] = real(random);
      query.high[axis] = query.low[axis] + std::fabs(real(random));
    }
    std::array<BoxTree::HalfSpace, 4> but_in;
    for (BoxTree::HalfSpace& half : but_in) {
      half = {{real(random), real(random), real(random)}, 0.5 + 0.5 * real(random)};
    }
    std::vector<Index> found;
    tree.query(query, found, [&but_in] { return but_in; });
    std::sort(found.begin(), found.end());
    for (Index i = 0; i < boxes.size(); ++i) {
      bool meets = true;
      for (int axis = 0; axis < 3; ++axis) {
        meets = meets && boxes[i].low[axis] <= query.high[axis] &&
                query.low[axis] <= boxes[i].high[axis];
      }
      double depth = -kInfinity;  // of the box in one of them
      for (const BoxTree::HalfSpace& half : but_in) {
        double height = 0;
        for (int axis = 0; axis < 3; ++axis) {
          height += std::min(half.normal[axis] * boxes[i].low[axis],
                             half.normal[axis] * boxes[i].high[axis]);
        }
        depth = std::max(depth, height - half.offset);
      }
      const bool is_found = std::binary_search(found.begin(), found.end(), i);
      if (!meets) {
        ASSERT_FALSE(is_found);
      } else if (depth <= 0) {
        ASSERT_TRUE(is_found);
        ++kept;
      } else if (depth > 1e-12) {
        ASSERT_FALSE(is_found);
        ++left_out;
      }
    }
  }
  EXPECT_GT(kept, 200U);
  EXPECT_GT(left_out, 500U);
}

// A quadrilateral face is one facet if it is flat, however steep. A saddle is two, though the sum
// of its triangles' normals is upright.
TEST(InputSurface, PolygonsAreFacetsWhereTheyAreFlat) {
  const auto facets = [](const Polyhedron& polyhedron) {
    const ExactPoints points = points_of(polyhedron.vertices);
    InputSurface surface;
    EXPECT_EQ(surface.assign(polyhedron, points), "");
    return surface.facets().size();
  };
  const auto box = [](double top, double lift) {
    Polyhedron p;
    const std::array<std::array<double, 2>, 4> corner = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (const auto& [x, y] : corner) p.vertices.push_back({2 * x, 2 * y, 0});
    for (std::size_t i = 0; i < 4; ++i) {
      const double z = 4 + (i % 2 == 0 ? lift : -lift);
      p.vertices.push_back({top * corner[i][0], top * corner[i][1], z});
    }
    for (const auto& [a, b, c, d] : {std::array<Index, 4>{0, 3, 2, 1},
                                     {4, 5, 6, 7},
                                     {0, 1, 5, 4},
                                     {1, 2, 6, 5},
                                     {2, 3, 7, 6},
                                     {3, 0, 4, 7}}) {
      p.triangles.push_back({a, b, c});
      p.triangles.push_back({a, c, d});
      p.polygons.insert(p.polygons.end(), 2, static_cast<Index>(p.polygons.size() / 2));
    }
    return p;
  };
  EXPECT_EQ(facets(box(1, 0)), 6U);
  EXPECT_EQ(facets(box(2, 0)), 6U);
  EXPECT_EQ(facets(box(2, 0.5)), 7U);  // upright sides stay flat
}

}  // namespace
}  // namespace tetproof
