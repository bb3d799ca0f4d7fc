#include "mesher/delaunay/planar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "mesher/base/check.h"

namespace delmesher::delaunay::planar_test {
namespace {

// Points of the plane through three explicit points, and an explicit point above it.
class PlanarTest : public testing::Test {
 protected:
  void set_plane(const Vec3& p, const Vec3& q, const Vec3& r) {
    for (int k = 0; k < 3; ++k) {
      corner_[k] = points_.add_explicit(k == 0   ? p[0]
                                        : k == 1 ? q[0]
                                                 : r[0],
                                        k == 0   ? p[1]
                                        : k == 1 ? q[1]
                                                 : r[1],
                                        k == 0   ? p[2]
                                        : k == 1 ? q[2]
                                                 : r[2]);
    }
    for (plane_.axis = 2; plane_.axis > 0; --plane_.axis) {
      if (orient2d(0, 1, 2) != 0) break;
    }
    plane_.axis_sign = orient2d(0, 1, 2);
    // A point off the plane, then on its positive side by exchange of orientation.
    plane_.off_plane = points_.add_explicit(p[0] + 3, p[1] - 5, p[2] + 7);
    if (predicates_.orient3d(0, 1, 2, plane_.off_plane) < 0) plane_.axis_sign = -plane_.axis_sign;
  }
  int orient2d(VertexId a, VertexId b, VertexId c) {
    return predicates_.orient2d(plane_.axis, a, b, c);
  }
  int orient(VertexId a, VertexId b, VertexId c) { return plane_.axis_sign * orient2d(a, b, c); }
  VertexId add(double u, double v) {
    return points_.add_on_triangle(corner_[0], corner_[1], corner_[2], u, v);
  }

  // Everything that makes it the Delaunay triangulation of the points' convex hull.
  void expect_delaunay(const PlanarTriangulation& t, const std::vector<VertexId>& vertices) {
    std::set<VertexId> used;
    std::vector<std::array<VertexId, 2>> hull;
    for (std::uint32_t n = 0; n < t.triangles.size(); ++n) {
      const auto& v = t.triangles[n];
      used.insert(v.begin(), v.end());
      ASSERT_GT(orient(v[0], v[1], v[2]), 0);
      for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t side = t.neighbors[n][i];
        if (side == kNone) {
          hull.push_back({v[(i + 1) % 3], v[(i + 2) % 3]});
          continue;
        }
        ASSERT_EQ(t.neighbors[side / 3][side % 3], 3 * n + i);
        const auto& w = t.triangles[side / 3];
        ASSERT_EQ(w[(side + 1) % 3], v[(i + 2) % 3]);
        ASSERT_EQ(w[(side + 2) % 3], v[(i + 1) % 3]);
        ASSERT_LT(predicates_.insphere_perturbed(v[0], v[1], v[2], plane_.off_plane, w[side % 3]),
                  0);
      }
    }
    EXPECT_EQ(used.size(), vertices.size());
    EXPECT_EQ(t.triangles.size() + hull.size(), 2 * vertices.size() - 2);  // Euler
    if (vertices.size() > 300) return;
    for (const auto& edge : hull) {
      for (const VertexId v : vertices) ASSERT_GE(orient(edge[0], edge[1], v), 0);
    }
  }

  PlanarTriangulation triangulate(const std::vector<VertexId>& vertices) {
    return triangulate_planar(predicates_, plane_, vertices);
  }

  // Triangles as sorted triples.
  static std::set<std::array<VertexId, 3>> as_set(const PlanarTriangulation& t) {
    std::set<std::array<VertexId, 3>> result;
    for (auto v : t.triangles) {
      std::sort(v.begin(), v.end());
      result.insert(v);
    }
    return result;
  }

  void check(std::vector<VertexId> vertices) {
    const PlanarTriangulation first = triangulate(vertices);
    expect_delaunay(first, vertices);
    std::shuffle(vertices.begin(), vertices.end(), random_);
    EXPECT_EQ(as_set(first), as_set(triangulate(vertices)));  // whatever the order
  }

  PointStore points_;
  Predicates predicates_{points_};
  FacetPlane plane_{};
  std::array<VertexId, 3> corner_{};
  std::mt19937 random_{12345};
};

TEST_F(PlanarTest, Triangle) {
  set_plane({0, 0, 0}, {1, 0, 0.5}, {0, 1, 0.25});
  check({0, 1, 2});
  check({0, 2, 1});
}

TEST_F(PlanarTest, CollinearPointsAreRefused) {
  set_plane({0, 0, 0}, {1, 0, 0.5}, {0, 1, 0.25});
  std::vector<VertexId> line;
  for (int i = 0; i < 4; ++i) line.push_back(add(0.25 * i, 0));
  EXPECT_THROW(triangulate(line), InternalError);
}

TEST_F(PlanarTest, FewRandomPointsManyTimes) {
  set_plane({0.1, 0.2, 0.3}, {1.7, 0.1, 0.9}, {0.4, 1.3, -0.7});
  std::uniform_int_distribution<int> cell(0, 4);
  for (int round = 0; round < 200; ++round) {
    std::set<std::array<int, 2>> cells;
    const std::size_t n = 3 + static_cast<std::size_t>(round) % 12;
    while (cells.size() < n) cells.insert({cell(random_), cell(random_)});
    std::vector<VertexId> vertices;
    for (const auto& c : cells) vertices.push_back(add(c[0] / 8.0, c[1] / 8.0));
    int side = 0;
    for (std::size_t i = 2; i < n; ++i) {
      side |= orient(vertices[0], vertices[1], vertices[i]);
    }
    if (side != 0) check(vertices);
  }
}

TEST_F(PlanarTest, GridIsAllTies) {
  for (const Vec3& r : {Vec3{0, 0, 1}, Vec3{0, 1, 0.5}}) {
    set_plane({0, 0, 0}, {1, 0, 0}, r);
    std::vector<VertexId> vertices;
    for (int i = 0; i < 12; ++i) {
      for (int j = 0; j < 12; ++j) vertices.push_back(add(i / 16.0, j / 16.0));
    }
    check(vertices);
    points_ = PointStore();
  }
}

TEST_F(PlanarTest, ManyPointsOnTheBoundaryOfATriangle) {
  set_plane({0, 0, 0}, {0.3, 1, 0}, {0.7, 0.2, 1});
  std::vector<VertexId> vertices = {0, 1, 2};
  for (int i = 1; i < 32; ++i) {
    vertices.push_back(add(i / 32.0, 0));
    vertices.push_back(add(0, i / 32.0));
    vertices.push_back(add(i / 32.0, 1 - i / 32.0));
  }
  check(vertices);
}

TEST_F(PlanarTest, Large) {
  set_plane({0, 0, 0}, {0.3, 1, 0}, {0.7, 0.2, 1});
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<VertexId> vertices;
  for (int i = 0; i < 5000; ++i) {
    vertices.push_back(add(std::floor(coordinate(random_) * 0x1p20) * 0x1p-20,
                           std::floor(coordinate(random_) * 0x1p20) * 0x1p-20));
  }
  const PlanarTriangulation t = triangulate(vertices);
  expect_delaunay(t, vertices);
}

// Insertion in rounds along a curve finds its way in a number of steps that does not depend on how
// many points there are, wherever they lie and in whatever order they come. On a parabola, one end
// of it first would destroy every triangle with each point.
TEST_F(PlanarTest, StepsPerPointDoNotDependOnTheirNumber) {
  const auto per_point = [&](int n, bool parabola, bool flipped) {
    points_ = PointStore();
    set_plane({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    std::vector<VertexId> vertices;
    for (int i = 0; i < n; ++i) {
      const double x = static_cast<double>(i) / n;
      const double u = parabola ? x : std::ldexp(random_() >> 8, -24) / 2,
                   v = parabola ? x * x : std::ldexp(random_() >> 8, -24) / 2;
      vertices.push_back(points_.add_explicit(flipped ? 1 - u : u, flipped ? 1 - v : v, 0));
    }
    std::shuffle(vertices.begin(), vertices.end(), random_);
    const PredicateCounters& c = predicates_.counters;
    const auto asked = [&] { return c.decided(); };
    const std::uint64_t before = asked();
    triangulate(vertices);
    return static_cast<double>(asked() - before) / n;
  };
  for (const bool parabola : {false, true}) {
    for (const bool flipped : {false, true}) {
      const double few = per_point(2000, parabola, flipped),
                   many = per_point(32000, parabola, flipped);
      EXPECT_LT(many, 1.5 * few) << parabola << flipped;
      EXPECT_LT(many, 60) << parabola << flipped;
    }
  }
}

// Points that are moved exactly are inserted in the same order, and ask as much.
TEST_F(PlanarTest, StepsDoNotDependOnThePlace) {
  const auto asked = [&](double offset) {
    points_ = PointStore();
    set_plane({offset, offset, 0}, {offset + 1, offset, 0}, {offset, offset + 1, 0});
    std::mt19937 random(7);
    std::vector<VertexId> vertices;
    for (int i = 0; i < 4000; ++i) {
      const double x = static_cast<double>(random() >> 12), y = static_cast<double>(random() >> 12);
      vertices.push_back(points_.add_explicit(offset + x, offset + y, 0));
    }
    const std::uint64_t before = predicates_.counters.decided();
    triangulate(vertices);
    return predicates_.counters.decided() - before;
  };
  const std::uint64_t here = asked(0);
  EXPECT_GT(here, 4000U);
  EXPECT_EQ(asked(0x1p30), here);
  EXPECT_EQ(asked(-0x1p30), here);
}

// The restriction to a plane of the perturbed Delaunay tetrahedrization: a cube's square face, cut
// by the diagonal that the 3D predicate prefers.
TEST_F(PlanarTest, AgreesWithThePerturbedInsphere) {
  for (int rotation = 0; rotation < 4; ++rotation) {
    points_ = PointStore();
    const double x[4] = {0, 1, 1, 0}, y[4] = {0, 0, 1, 1};
    for (int i = 0; i < 4; ++i) {
      points_.add_explicit(x[(i + rotation) % 4], y[(i + rotation) % 4], 0);
    }
    plane_ = {2, 1, points_.add_explicit(0.5, 0.5, 9)};
    const VertexId below = points_.add_explicit(0.3, 0.4, -1);
    const auto t = as_set(triangulate({0, 1, 2, 3}));
    // Vertex 0 is raised most, so it is cut off: the diagonal joins its neighbours 1 and 3.
    EXPECT_EQ(t.count({0, 1, 3}), 1U);
    // The same seen from the other side of the plane.
    EXPECT_GT(predicates_.orient3d(0, 3, 1, below), 0);
    EXPECT_LT(predicates_.insphere_perturbed(0, 3, 1, below, 2), 0);
  }
}

}  // namespace
}  // namespace delmesher::delaunay::planar_test
