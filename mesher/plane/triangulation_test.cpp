// The laws of triangulation.h.
#include "mesher/plane/triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

#include "mesher/plane/spatial_order.h"

namespace delmesher::plane {
namespace {

class Mesh {
 public:
  Mesh() : predicates(points), mesh(predicates) {
    const VertexId a = point(-4, -4), b = point(4, -4), c = point(4, 4), d = point(-4, 4);
    mesh.start({a, b, c, d}, {0, 1, 2, 3});
  }
  VertexId point(double x, double y) { return points.add_explicit(x, y, 0); }
  VertexId insert(double x, double y) { return mesh.insert(point(x, y), 0); }

  PointStore points;
  PlanePredicates predicates;
  Triangulation mesh;
};

std::vector<std::array<double, 2>> random_points(int n, bool grid, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::set<std::array<double, 2>> result;
  while (result.size() < static_cast<std::size_t>(n)) {
    const auto coordinate = [&] {
      return grid ? static_cast<double>(random() % 32) / 8 - 2
                  : static_cast<double>(random() >> 11) * 0x1p-51 - 2;
    };
    result.insert({coordinate(), coordinate()});
  }
  std::vector<std::array<double, 2>> points(result.begin(), result.end());
  std::shuffle(points.begin(), points.end(), random);
  return points;
}

TEST(Triangulation, DelaunayAfterEveryInsertion) {
  for (const bool grid : {false, true}) {
    Mesh m;
    for (const auto& [x, y] : random_points(150, grid, 3)) {
      m.insert(x, y);
      ASSERT_NO_THROW(m.mesh.validate(true));
    }
    EXPECT_EQ(m.mesh.size(), 2 + 2 * 150U);  // Euler
  }
}

TEST(Triangulation, UniqueWhateverTheOrder) {
  // With perturbed ties the Delaunay triangulation depends on ids only: grids have many ties.
  Mesh first, second;
  std::vector<VertexId> ids;
  for (const auto& [x, y] : random_points(200, true, 4)) {
    ids.push_back(first.point(x, y));
    second.point(x, y);
  }
  for (const VertexId v : ids) first.mesh.insert(v, 0);
  arrange_in_rounds(ids);
  for (const VertexId v : ids) second.mesh.insert(v, 0);
  second.mesh.renumber();
  EXPECT_NO_THROW(second.mesh.validate(true));
  for (TriangleId t = 1; t < second.mesh.size(); ++t) {
    const auto &v = second.mesh[t - 1].vertex, &w = second.mesh[t].vertex;
    ASSERT_LE(*std::min_element(v.begin(), v.end()), *std::min_element(w.begin(), w.end()));
  }
  const auto triangles = [](const Triangulation& mesh) {
    std::set<std::array<VertexId, 3>> result;
    for (TriangleId t = 0; t < mesh.size(); ++t) {
      auto v = mesh[t].vertex;
      std::sort(v.begin(), v.end());
      result.insert(v);
    }
    return result;
  };
  EXPECT_EQ(triangles(first.mesh), triangles(second.mesh));
}

// What is left is the triangulation of what is left, in rectangles and on grids, where many corners
// are on one line; also within segments.
TEST(Triangulation, ForgetsWhatIsRemoved) {
  for (const bool grid : {false, true}) {
    for (const bool segments : {false, true}) {
      Mesh all, rest;
      std::vector<VertexId> removed;
      int n = 0;
      for (const auto& [x, y] : random_points(200, grid, 6)) {
        const VertexId v = all.insert(x, y);
        rest.point(x, y);
        if (n++ % 3 == 0) {
          removed.push_back(v);
        } else {
          rest.mesh.insert(v, 0);
        }
      }
      if (segments) {
        std::vector<VertexId> chain;
        for (Mesh* m : {&all, &rest}) {
          for (const double y : {-3.0, 3.0}) {
            const VertexId a = m->insert(-3, y), b = m->insert(3, y + 0.5);
            ASSERT_EQ(m->mesh.insert_segment(a, b, 7, chain).kind,
                      Triangulation::Obstacle::Kind::none);
          }
        }
      }
      for (const VertexId v : removed) {
        all.mesh.remove(v);
        ASSERT_FALSE(all.mesh.has_vertex(v));
        ASSERT_NO_THROW(all.mesh.validate(true));
      }
      ASSERT_EQ(all.mesh.size(), rest.mesh.size());
      const auto edges = [](const Triangulation& mesh) {
        std::set<std::tuple<VertexId, VertexId, PieceId>> result;
        for (TriangleId t = 0; t < mesh.size(); ++t) {
          for (int i = 0; i < 3; ++i) {
            const EdgeId e = edge_of(t, i);
            result.insert({mesh.origin(e), mesh.target(e), mesh.piece(e)});
          }
        }
        return result;
      };
      EXPECT_EQ(edges(all.mesh), edges(rest.mesh)) << grid << segments;
    }
  }
}

TEST(Triangulation, FindsWhatIsThere) {
  Mesh m;
  const VertexId a = m.insert(0, 0);
  EXPECT_EQ(m.insert(0, 0), a);
  const VertexId b = m.insert(1, 0);
  m.insert(0.5, 1);
  const EdgeId e = m.mesh.find_edge(a, b);
  ASSERT_NE(e, kNone);
  EXPECT_EQ(m.mesh.origin(e), a);
  EXPECT_EQ(m.mesh.target(e), b);
  EXPECT_EQ(m.mesh.find_edge(b, 3), kNone);  // a corner far away
  EXPECT_NE(m.mesh.find_edge(0, 1), kNone);  // a side of the rectangle
  std::vector<EdgeId> star;
  m.mesh.star(a, star);
  for (const EdgeId spoke : star) EXPECT_EQ(m.mesh.opposite(spoke), a);
  const VertexId c = m.point(9, 9);
  m.mesh.rename(b, c);
  EXPECT_NE(m.mesh.find_edge(a, c), kNone);
  EXPECT_FALSE(m.mesh.has_vertex(b));
}

TEST(Triangulation, SidesOfTheRectangleCanBeSplit) {
  Mesh m;
  m.insert(0, 0);
  const VertexId p = m.insert(0, -4);
  EXPECT_NO_THROW(m.mesh.validate(true));
  const EdgeId e = m.mesh.find_edge(p, 1);
  ASSERT_NE(e, kNone);
  EXPECT_EQ(m.mesh.piece(e), 0U);
}

TEST(Triangulation, SegmentsThroughEverything) {
  for (const bool grid : {false, true}) {
    Mesh m;
    std::vector<VertexId> ids;
    for (const auto& [x, y] : random_points(300, grid, 5)) ids.push_back(m.insert(x, y));
    std::vector<VertexId> chain;
    PieceId piece = 10;
    int entered = 0, crossing = 0, long_chains = 0;
    std::mt19937_64 random(6);
    for (int i = 0; i < 200; ++i) {
      const VertexId a = ids[random() % ids.size()], b = ids[random() % ids.size()];
      if (a == b) continue;
      const auto obstacle = m.mesh.insert_segment(a, b, ++piece, chain);
      ASSERT_NO_THROW(m.mesh.validate(true));
      if (obstacle.kind == Triangulation::Obstacle::Kind::none) {
        ++entered;
        long_chains += chain.size() > 2;
        ASSERT_EQ(chain.front(), a);
        ASSERT_EQ(chain.back(), b);
        for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
          const EdgeId e = m.mesh.find_edge(chain[k], chain[k + 1]);
          ASSERT_NE(e, kNone);
          ASSERT_EQ(m.mesh.piece(e), piece);
        }
      } else {
        ++crossing;
        EXPECT_NE(obstacle.piece, kNone);
      }
    }
    EXPECT_GT(entered, 20);
    EXPECT_GT(crossing, 20);
    if (grid) {
      EXPECT_GT(long_chains, 3);
    }
    // Points inserted now leave the segments alone, except for those that they lie on.
    for (const auto& [x, y] : random_points(100, false, 8)) {
      m.insert(x, y);
      ASSERT_NO_THROW(m.mesh.validate(true));
    }
  }
}

TEST(Triangulation, LooksNoFurtherThanConstraints) {
  Mesh m;
  const VertexId a = m.insert(-1, 0), b = m.insert(1, 0);
  m.insert(0, 2);
  m.insert(0, -2);
  std::vector<VertexId> chain;
  m.mesh.insert_segment(a, b, 17, chain);
  const VertexId p = m.point(0.1, -1);
  const EdgeId e = m.mesh.find_edge(a, b);  // above it
  const auto sight = m.mesh.look(p, triangle_of(e));
  ASSERT_NE(sight.blocked, kNone);
  EXPECT_EQ(m.mesh.piece(sight.blocked), 17U);
  const auto clear = m.mesh.look(p, triangle_of(m.mesh.twin(e)));
  EXPECT_EQ(clear.blocked, kNone);
  EXPECT_EQ(clear.location.triangle, m.mesh.locate(p, 0).triangle);
}

}  // namespace
}  // namespace delmesher::plane
