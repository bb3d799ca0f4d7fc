// The laws of separate.h, through unite(): validity is that of the certificate of generated models,
// and how far vertices are moved is measured against the union that touches.
#include "corpus/union/separate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "corpus/generators/certify.h"
#include "corpus/generators/random.h"
#include "corpus/generators/shapes.h"
#include "corpus/generators/test_surfaces.h"
#include "corpus/union/unite.h"

namespace tetproof::unite {
namespace {

using delmesher::Surface;
using shapes::box;
using test_surfaces::inwards;
using test_surfaces::together;
using test_surfaces::volume;

constexpr double kShare = 1e-3;

double distance(const Position& p, const Position& q) {
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

double area(const Surface& surface) {
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const double x = distance(surface.vertices[a], surface.vertices[b]),
                 y = distance(surface.vertices[b], surface.vertices[c]),
                 z = distance(surface.vertices[c], surface.vertices[a]), s = (x + y + z) / 2;
    sum += std::sqrt(std::max(0.0, s * (s - x) * (s - y) * (s - z)));
  }
  return sum;
}

double diagonal(const Surface& surface) {
  Position low = surface.vertices[0], high = low;
  for (const Position& p : surface.vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  return distance(low, high);
}

// How far the vertices of a surface are at most from vertices, and middles of edges, of another.
double farthest_vertex(const Surface& from, const Surface& to) {
  std::vector<Position> places = to.vertices;
  for (const auto& t : to.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Position &p = to.vertices[t[k]], &q = to.vertices[t[(k + 1) % 3]];
      places.push_back({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
    }
  }
  double farthest = 0;
  for (const Position& p : from.vertices) {
    double nearest = distance(p, places[0]);
    for (const Position& q : places) nearest = std::min(nearest, distance(p, q));
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

// Unites bodies whose union touches itself, and separates it.
UnionResult expect_separated(const std::vector<Surface>& bodies, UnionOptions options = {}) {
  const UnionResult touching = unite(together(bodies), options);
  EXPECT_EQ(touching.code, UnionCode::touching);
  EXPECT_EQ(touching.counts.copies, 0U);
  options.separate = kShare;
  UnionResult result = unite(together(bodies), options);
  EXPECT_EQ(result.code, UnionCode::done) << result.message;
  EXPECT_TRUE(certified_valid(result.surface));
  EXPECT_EQ(result.counts.touching_edges, touching.counts.touching_edges);
  EXPECT_EQ(result.counts.touching_vertices, touching.counts.touching_vertices);
  EXPECT_EQ(result.surface.labels.size(), result.surface.triangles.size());
  const double allowed = kShare * diagonal(touching.surface),
               moved = farthest_vertex(result.surface, touching.surface);
  EXPECT_LE(moved, allowed);
  EXPECT_GT(moved, 0);
  EXPECT_NEAR(moved, result.counts.largest_separation, 1e-12);
  EXPECT_LE(farthest_vertex(touching.surface, result.surface), allowed);
  const double before = volume(touching.surface), after = volume(result.surface);
  EXPECT_LE(std::fabs(after - before),
            allowed * std::max(area(touching.surface), area(result.surface)));
  EXPECT_NEAR(result.counts.volume_after, after, 1e-12 * after);
  return result;
}

TEST(Separate, PartsThatTouchShrink) {
  const Surface one = box({0, 0, 0}, {1, 1, 1});
  const UnionResult edge = expect_separated({one, box({1, 1, 0}, {2, 2, 1})});
  EXPECT_EQ(edge.counts.copies, 4U);
  EXPECT_EQ(edge.counts.halved_edges, 0U);
  EXPECT_EQ(edge.counts.bodies_after, 2U);
  EXPECT_LT(volume(edge.surface), 2);
  expect_separated({one, box({1, 1, 0.25}, {2, 2, 0.5})});
  const UnionResult vertex = expect_separated({one, box({1, 1, 1}, {2, 2, 2})});
  EXPECT_EQ(vertex.counts.copies, 2U);
  EXPECT_LT(volume(vertex.surface), 2);
  // A tip on the middle of a side.
  expect_separated(
      {one, shapes::tetrahedron({0.25, 0.5, 1}, {0.25, 0.25, 2}, {0.75, 0.25, 2}, {0.5, 0.75, 2})});
  // Eight boxes around a point, every other one of them there.
  const UnionResult four =
      expect_separated({box({-1, -1, -1}, {0, 0, 0}), box({0, 0, -1}, {1, 1, 0}),
                        box({-1, 0, 0}, {0, 1, 1}), box({0, -1, 0}, {1, 0, 1})});
  EXPECT_EQ(four.counts.touching_edges, 6U);
  EXPECT_EQ(four.counts.copies, 16U);
  EXPECT_EQ(four.counts.bodies_after, 4U);
}

// Less than half a turn for all of them, so that their order is not that of half planes alone.
TEST(Separate, ThreeWedgesOfOneEdge) {
  const auto around = [](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return Position{std::cos(angle), std::sin(angle), 0.5};
  };
  std::vector<Surface> bodies;
  for (const double from : {0.0, 50.0, 100.0}) {
    bodies.push_back(shapes::tetrahedron({0, 0, 0}, around(from), around(from + 30), {0, 0, 1}));
  }
  const UnionResult result = expect_separated(bodies);
  EXPECT_EQ(result.counts.touching_edges, 1U);
  EXPECT_EQ(result.counts.copies, 6U);
  EXPECT_EQ(result.counts.bodies_after, 3U);
}

// As far as they go, hollows shrink, so that there is a wall between them; where they touch along
// an edge, the walls that end there are the parts, and a gap joins the hollows.
TEST(Separate, WallsBetweenHollowsGrow) {
  const Surface around = box({-1, -1, -1}, {3, 3, 3}), hollow = inwards(box({0, 0, 0}, {1, 1, 1}));
  const UnionResult vertex = expect_separated({around, hollow, inwards(box({1, 1, 1}, {2, 2, 2}))});
  EXPECT_EQ(vertex.counts.copies, 2U);
  EXPECT_EQ(vertex.counts.bodies_after, 3U);
  EXPECT_GT(volume(vertex.surface), 62);
  const UnionResult edge = expect_separated({around, hollow, inwards(box({1, 1, 0}, {2, 2, 1}))});
  EXPECT_EQ(edge.counts.bodies_after, 2U);
  EXPECT_LT(volume(edge.surface), 62);
}

// Pillars that touch along their edge stand on one plate and carry another: at both ends of the
// edge there is one fan of triangles only.
TEST(Separate, AnEdgeBetweenSingleFansIsHalved) {
  const Surface low = box({0, 0, -1}, {2, 2, 0}), high = box({0, 0, 3}, {2, 2, 4});
  const Surface one = box({0, 0, 0}, {1, 1, 3}), other = box({1, 1, 0}, {2, 2, 3});
  const UnionResult result = expect_separated({low, high, one, other});
  EXPECT_EQ(result.counts.touching_edges, 1U);
  EXPECT_EQ(result.counts.halved_edges, 1U);
  EXPECT_EQ(result.counts.copies, 2U);
  EXPECT_EQ(result.counts.bodies_after, 1U);
}

TEST(Separate, LeavesAloneWhatDoesNotTouch) {
  const Surface two = together({box({0, 0, 0}, {2, 2, 2}), box({1, 1, 1}, {3, 3, 3})});
  UnionOptions options;
  const UnionResult before = unite(two, options);
  options.separate = kShare;
  const UnionResult after = unite(two, options);
  EXPECT_EQ(after.code, UnionCode::done);
  EXPECT_EQ(after.counts.copies, 0U);
  EXPECT_EQ(after.surface.vertices, before.surface.vertices);
  EXPECT_EQ(after.surface.triangles, before.surface.triangles);
}

// Less than doubles can tell apart, so that copies stay at one place.
TEST(Separate, SaysWhereItCannot) {
  UnionOptions options;
  options.separate = 1e-30;
  const UnionResult result =
      unite(together({box({0, 0, 0}, {1, 1, 1}), box({1, 1, 1}, {2, 2, 2})}), options);
  EXPECT_EQ(result.code, UnionCode::inseparable);
  EXPECT_NE(result.message.find("could not be moved apart"), std::string::npos) << result.message;
  EXPECT_NE(result.message.find("at (1, 1, 1)"), std::string::npos) << result.message;
  EXPECT_TRUE(result.surface.triangles.empty());
}

// Boxes on a grid touch in many ways. Their copies are moved in the same way each time.
TEST(Separate, BoxesOnAGrid) {
  Random random(11);
  int touching = 0;
  for (int round = 0; round < 60; ++round) {
    std::vector<Surface> bodies;
    for (int i = 0; i < 3 + round % 6; ++i) {
      Position low, high;
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = random.integer(0, 4);
        high[k] = low[k] + random.integer(1, 2);
      }
      bodies.push_back(box(low, high));
    }
    if (unite(together(bodies)).code == UnionCode::done) continue;
    SCOPED_TRACE("round " + std::to_string(round));
    ++touching;
    const UnionResult result = expect_separated(bodies);
    UnionOptions options;
    options.separate = kShare;
    EXPECT_EQ(unite(together(bodies), options).surface.vertices, result.surface.vertices);
  }
  EXPECT_GT(touching, 15);
}

}  // namespace
}  // namespace tetproof::unite
