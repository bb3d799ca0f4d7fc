// The laws of unite.h. Volumes are those of solid geometry; insides are asked of the oracles, one
// body at a time, and validity of the certificate of generated models: neither knows anything of
// the arrangement.
#include "corpus/union/unite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "corpus/generators/certify.h"
#include "corpus/generators/random.h"
#include "corpus/generators/rotate.h"
#include "corpus/generators/shapes.h"
#include "corpus/generators/test_surfaces.h"
#include "oracles/base/exact_points.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::unite {
namespace {

using delmesher::Surface;
using shapes::box;
using test_surfaces::inwards;
using test_surfaces::together;
using test_surfaces::volume;
using Point = std::array<double, 3>;

// Bodies bounded by closed surfaces, one by one.
class Bodies {
 public:
  Bodies(const std::vector<Surface>& bodies, const std::vector<Point>& places) {
    for (const Surface& body : bodies) {
      std::vector<Point> positions = body.vertices;
      first_.push_back(static_cast<oracles::Index>(positions.size()));
      positions.insert(positions.end(), places.begin(), places.end());
      EXPECT_EQ(points_.emplace_back().assign(positions), "");
      EXPECT_EQ(
          solids_.emplace_back().assign({body.vertices, body.triangles, {}, {}}, points_.back()),
          "");
    }
  }
  // 1 if the place is inside of one, 0 if it is outside of all, -1 if it is on a surface.
  int inside_any(std::size_t place) const {
    int any = 0;
    for (std::size_t b = 0; b < solids_.size(); ++b) {
      const std::array<oracles::Index, 1> corner = {first_[b] + static_cast<oracles::Index>(place)};
      const int inside = solids_[b].inside(points_[b], corner);
      if (inside < 0) return inside;
      any = std::max(any, inside);
    }
    return any;
  }

 private:
  std::vector<oracles::Index> first_;
  std::vector<oracles::ExactPoints> points_;
  std::vector<oracles::InputSurface> solids_;
};

std::vector<Point> places_around(const Surface& surface, int count, Random& random) {
  Point low = surface.vertices[0], high = low;
  for (const Point& p : surface.vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  std::vector<Point> places(static_cast<std::size_t>(count));
  for (Point& p : places) {
    for (std::size_t k = 0; k < 3; ++k) p[k] = random.between(low[k], high[k]);
  }
  return places;
}

// Is the result inside exactly where one of the bodies is? Returns how many places were inside.
int expect_same_inside(const std::vector<Surface>& bodies, const Surface& result, Random& random) {
  const std::vector<Point> places = places_around(together(bodies), 300, random);
  const Bodies before(bodies, places), after({result}, places);
  int inside = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_EQ(before.inside_any(i), after.inside_any(i)) << "place " << i;
    inside += before.inside_any(i) == 1 ? 1 : 0;
  }
  return inside;
}

UnionResult expect_valid(const std::vector<Surface>& bodies, double expected,
                         const UnionOptions& options = {}) {
  UnionResult result = unite(together(bodies), options);
  EXPECT_EQ(result.code, UnionCode::done) << result.message;
  EXPECT_TRUE(certified_valid(result.surface));
  EXPECT_NEAR(volume(result.surface), expected, 1e-12 * expected);
  EXPECT_NEAR(result.counts.volume_after, expected, 1e-12 * expected);
  return result;
}

bool says(const UnionResult& result, const std::string& words) {
  return std::any_of(result.done.begin(), result.done.end(), [&](const std::string& line) {
    return line.find(words) != std::string::npos;
  });
}

TEST(Union, OfOverlappingBoxesIsExactWhereDoublesAre) {
  const UnionResult result =
      expect_valid({box({0, 0, 0}, {2, 2, 2}), box({1, 1, 1}, {3, 3, 3})}, 15);
  EXPECT_EQ(result.counts.bodies_before, 2U);
  EXPECT_EQ(result.counts.bodies_after, 1U);
  EXPECT_DOUBLE_EQ(result.counts.volume_before, 16);
  EXPECT_EQ(result.counts.largest_move, 0);
  EXPECT_GT(result.counts.pairs, 0U);
  EXPECT_GT(result.counts.dropped, 0U);
  // The result has all given vertices except one of each box, and the line where the boxes meet has
  // six corners. Where it crosses diagonals of sides, no vertex is left.
  EXPECT_EQ(result.surface.vertices.size(), 20U);
  EXPECT_EQ(result.counts.new_points, 6 + result.counts.flat_vertices);
  EXPECT_TRUE(says(result, "2 bodies of volume 16 became 1 of 15"));
}

TEST(Union, OfDisjointBodiesIsWhatTheyAre) {
  const Surface both = together({box({0, 0, 0}, {1, 1, 1}), box({2, 0, 0}, {3, 1, 1})});
  const UnionResult result = unite(both);
  EXPECT_EQ(result.code, UnionCode::done);
  EXPECT_EQ(result.surface.vertices, both.vertices);
  EXPECT_EQ(result.surface.triangles, both.triangles);
  EXPECT_EQ(result.counts.cut, 0U);
  EXPECT_EQ(result.counts.bodies_after, 2U);
}

TEST(Union, DropsBodiesInsideOthersAndKeepsHollows) {
  const Surface outer = box({0, 0, 0}, {3, 3, 3}), inner = box({1, 1, 1}, {2, 2, 2});
  const UnionResult full = expect_valid({outer, inner}, 27);
  EXPECT_EQ(full.surface.triangles, outer.triangles);
  EXPECT_EQ(full.counts.dropped, 12U);
  expect_valid({outer, inwards(inner)}, 26);
  // A body in the hollow, and one in that.
  expect_valid({outer, inwards(inner), box({1.25, 1.25, 1.25}, {1.75, 1.75, 1.75}),
                box({1.375, 1.375, 1.375}, {1.5, 1.5, 1.5})},
               26.125);
}

TEST(Union, OfEqualBodiesIsOne) {
  const Surface one = box({0, 0, 0}, {1, 2, 3});
  const UnionResult result = expect_valid({one, one, one}, 6);
  EXPECT_EQ(result.counts.bodies_after, 1U);
  EXPECT_EQ(result.counts.welded, 16U);
  EXPECT_EQ(result.surface.triangles.size(), 12U);
  EXPECT_EQ(unite(together({one, inwards(one)})).code, UnionCode::empty);
}

// With the diagonals of their sides the other way.
TEST(Union, OfEqualBodiesThatAreTriangulatedDifferently) {
  Surface other = box({-1, 0, 0}, {0, 1, 1});
  shapes::move(other, [](const Point& p) { return Point{-p[0], p[1], p[2]}; });
  shapes::reverse(other);
  const UnionResult result = expect_valid({box({0, 0, 0}, {1, 1, 1}), other}, 1);
  EXPECT_GT(result.counts.coplanar_pairs, 0U);
  EXPECT_EQ(result.counts.largest_move, 0);
}

TEST(Union, OfBodiesWithSidesInOnePlane) {
  // Side by side, with four sides in common planes.
  EXPECT_GT(
      expect_valid({box({0, 0, 0}, {2, 1, 1}), box({1, 0, 0}, {3, 1, 1})}, 3).counts.coplanar_pairs,
      0U);
  // One stands on the other: the wall between them is gone.
  expect_valid({box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})}, 2);
  expect_valid({box({0, 0, 0}, {4, 4, 1}), box({1, 1, 1}, {2, 3, 2})}, 18);
  // In a corner of it, and over its border.
  expect_valid({box({0, 0, 0}, {4, 4, 1}), box({0, 0, 0.5}, {2, 2, 2})}, 20);
  expect_valid({box({0, 0, 0}, {4, 4, 1}), box({3, 1, 1}, {6, 2, 2})}, 19);
  expect_valid({box({0, 0, 0}, {2, 2, 2}), box({0, 0, 0}, {1, 1, 1})}, 8);
}

// The vertices of polyhedra, and 2 V - 4 + 4 H triangles with H holes through them.
TEST(Union, LeavesNoVerticesInFlatSidesAndStraightEdges) {
  const auto expect_vertices = [](const std::vector<Surface>& bodies, double volume,
                                  std::size_t vertices, std::size_t holes = 0) {
    const UnionResult result = expect_valid(bodies, volume);
    EXPECT_EQ(result.surface.vertices.size(), vertices);
    EXPECT_EQ(result.surface.triangles.size(), 2 * vertices - 4 + 4 * holes);
    EXPECT_EQ(result.counts.largest_move, 0);
    return result;
  };
  expect_vertices({box({0, 0, 0}, {2, 1, 1}), box({1, 0, 0}, {3, 1, 1})}, 3, 8);
  expect_vertices({box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})}, 2, 8);
  // A step, and the same in a corner.
  expect_vertices({box({0, 0, 0}, {4, 4, 1}), box({0, 0, 0.5}, {4, 2, 2})}, 24, 12);
  expect_vertices({box({0, 0, 0}, {4, 4, 1}), box({0, 0, 0.5}, {2, 2, 2})}, 20, 14);
  // A box that stands on another: its foot is a ring of four vertices in the side.
  const UnionResult standing =
      unite(together({box({0, 0, 0}, {4, 4, 1}), box({1, 1, 1}, {2, 3, 2})}));
  EXPECT_EQ(standing.surface.vertices.size(), 16U);
  EXPECT_EQ(standing.surface.triangles.size(), 28U);
  // A frame of four bars around a hole.
  const std::vector<Surface> frame = {box({0, 0, 0}, {3, 1, 1}), box({0, 2, 0}, {3, 3, 1}),
                                      box({0, 0, 0}, {1, 3, 1}), box({2, 0, 0}, {3, 3, 1})};
  const UnionResult result = expect_vertices(frame, 8, 16, 1);
  EXPECT_TRUE(says(result, "vertices within flat sides and straight edges dropped"));
  // Turned by numbers of few digits, so that all points are exact: nothing is in the planes of
  // axes.
  std::vector<Surface> turned = frame;
  for (Surface& bar : turned) {
    shapes::move(bar, [](const Point& p) {
      return Point{2 * p[0] - p[1] + 2 * p[2], 2 * p[0] + 2 * p[1] - p[2],
                   -p[0] + 2 * p[1] + 2 * p[2]};
    });
  }
  expect_vertices(turned, 8 * 27, 16, 1);
}

// Vertices of triangles that meet no others stay, and so does what labels tell apart.
TEST(Union, KeepsFlatSidesThatNothingMeetsAndBordersOfLabels) {
  const Surface one = box({0, 0, 0}, {2, 1, 1}), other = box({1, 0, 0}, {3, 1, 1});
  Surface labelled = together({one, other});
  for (std::size_t t = 0; t < 24; ++t) labelled.labels.push_back(t < 12 ? 7 : 9);
  const UnionResult result = unite(labelled);
  EXPECT_EQ(result.code, UnionCode::done) << result.message;
  EXPECT_EQ(result.surface.vertices.size(), 12U);  // four more where the first one ends
  for (const std::int32_t label : {7, 9}) {
    double area = 0;  // of the four sides that go through
    for (std::size_t t = 0; t < result.surface.triangles.size(); ++t) {
      if (result.surface.labels[t] != label) continue;
      std::array<Point, 3> p;
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = result.surface.vertices[result.surface.triangles[t][k]];
      if (p[0][0] == p[1][0] && p[1][0] == p[2][0]) continue;
      Point u, v;
      for (std::size_t k = 0; k < 3; ++k) u[k] = p[1][k] - p[0][k], v[k] = p[2][k] - p[0][k];
      area += std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                         u[0] * v[1] - u[1] * v[0]) /
              2;
    }
    EXPECT_DOUBLE_EQ(area, label == 7 ? 8 : 4);
  }
  // A side of four triangles around a vertex, which a box far from them does not change.
  Surface refined = box({0, 0, 0}, {1, 1, 1});
  const auto [a, b, c] = refined.triangles[0];
  Point middle;
  for (std::size_t k = 0; k < 3; ++k) {
    middle[k] = (refined.vertices[a][k] + refined.vertices[b][k] + 2 * refined.vertices[c][k]) / 4;
  }
  const auto m = static_cast<std::uint32_t>(refined.vertices.size());
  refined.vertices.push_back(middle);
  refined.triangles[0] = {a, b, m};
  refined.triangles.push_back({b, c, m});
  refined.triangles.push_back({c, a, m});
  const std::size_t own = refined.triangles.size();
  const UnionResult apart =
      unite(together({refined, box({5, 0, 0}, {6, 1, 1}), box({5.5, 0, 0}, {7, 1, 1})}));
  EXPECT_EQ(apart.surface.vertices.size(), m + 1 + 8);
  EXPECT_EQ(apart.surface.triangles.size(), own + 12);
}

TEST(Union, SaysWherePartsTouch) {
  const Surface one = box({0, 0, 0}, {1, 1, 1});
  const UnionResult edge = unite(together({one, box({1, 1, 0}, {2, 2, 1})}));
  EXPECT_EQ(edge.code, UnionCode::touching);
  EXPECT_EQ(edge.counts.touching_edges, 1U);
  EXPECT_EQ(edge.counts.touching_vertices, 0U);
  EXPECT_NE(edge.message.find("1 edge"), std::string::npos) << edge.message;
  EXPECT_NE(edge.message.find("(1, 1, "), std::string::npos) << edge.message;
  EXPECT_DOUBLE_EQ(volume(edge.surface), 2);
  const UnionResult part = unite(together({one, box({1, 1, 0.25}, {2, 2, 0.5})}));
  EXPECT_EQ(part.counts.touching_edges, 1U);
  const UnionResult vertex = unite(together({one, box({1, 1, 1}, {2, 2, 2})}));
  EXPECT_EQ(vertex.code, UnionCode::touching);
  EXPECT_EQ(vertex.counts.touching_edges, 0U);
  EXPECT_EQ(vertex.counts.touching_vertices, 1U);
  // A tip on the middle of a side.
  const UnionResult tip =
      unite(together({one, shapes::tetrahedron({0.25, 0.5, 1}, {0.25, 0.25, 2}, {0.75, 0.25, 2},
                                               {0.5, 0.75, 2})}));
  EXPECT_EQ(tip.code, UnionCode::touching);
  EXPECT_EQ(tip.counts.touching_edges, 0U);
  EXPECT_EQ(tip.counts.touching_vertices, 1U);
}

// A box whose top goes down to a point, `apex` above the bottom.
Surface pierced_box(double apex) {
  Surface surface = box({0, 0, 0}, {1, 1, 1});
  std::erase_if(surface.triangles, [&](const auto& t) {
    return std::all_of(t.begin(), t.end(), [&](auto v) { return surface.vertices[v][2] == 1; });
  });
  const auto top = [&](double x, double y) {
    const auto found = std::find(surface.vertices.begin(), surface.vertices.end(), Point{x, y, 1});
    return static_cast<std::uint32_t>(found - surface.vertices.begin());
  };
  const std::array<std::uint32_t, 4> ring = {top(0, 0), top(1, 0), top(1, 1), top(0, 1)};
  const auto tip = static_cast<std::uint32_t>(surface.vertices.size());
  surface.vertices.push_back({0.5, 0.5, apex});
  for (std::size_t i = 0; i < 4; ++i) {
    surface.triangles.push_back({ring[i], ring[(i + 1) % 4], tip});
  }
  surface.labels.clear();
  return surface;
}

// The pyramid has the volume 2/3 or, below the bottom, 1/12.
TEST(Union, OfABodyThatPokesThroughItsOwnSide) {
  expect_valid({pierced_box(0.25)}, 0.75);
  const UnionResult positive = expect_valid({pierced_box(-1)}, 5.0 / 12);
  EXPECT_TRUE(says(positive, "inside out"));
  EXPECT_GT(positive.counts.inside_out, 0U);
  UnionOptions options;
  options.inside = Inside::nonzero;
  const UnionResult nonzero = unite(pierced_box(-1), options);
  EXPECT_EQ(nonzero.code, UnionCode::touching);  // the part below hangs on the rim of the hole
  EXPECT_EQ(nonzero.counts.touching_edges, 4U);
  EXPECT_NEAR(volume(nonzero.surface), 0.5, 1e-15);
  EXPECT_FALSE(says(nonzero, "inside out"));
}

TEST(Union, TurnsWhatIsInsideOut) {
  const UnionResult result =
      expect_valid({inwards(box({0, 0, 0}, {2, 2, 2})), inwards(box({1, 1, 1}, {3, 3, 3}))}, 15);
  EXPECT_TRUE(says(result, "turned round"));
  // One of two: hollow, or solid.
  const std::vector<Surface> mixed = {box({0, 0, 0}, {2, 2, 2}),
                                      inwards(box({5, 5, 5}, {6, 6, 6}))};
  expect_valid(mixed, 8);
  UnionOptions options;
  options.inside = Inside::nonzero;
  expect_valid(mixed, 9, options);
}

TEST(Union, NeedsASurfaceThatClosesUp) {
  Surface open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  open.labels.clear();
  UnionResult result = unite(open);
  EXPECT_EQ(result.code, UnionCode::unsound);
  EXPECT_NE(result.message.find("at 3 edges"), std::string::npos) << result.message;
  EXPECT_TRUE(result.surface.triangles.empty());
  Surface turned = box({0, 0, 0}, {1, 1, 1});
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(unite(turned).code, UnionCode::unsound);
  Surface wrong = box({0, 0, 0}, {1, 1, 1});
  wrong.triangles[0][0] = 8;
  EXPECT_EQ(unite(wrong).code, UnionCode::unsound);
  Surface endless = box({0, 0, 0}, {1, 1, 1});
  endless.vertices[0][0] = NAN;
  EXPECT_EQ(unite(endless).code, UnionCode::unsound);
  EXPECT_EQ(unite({}).code, UnionCode::empty);
}

// An edge that one side has in two parts; a triangle without area may join them.
TEST(Union, ClosesSlits) {
  for (const bool joined : {false, true}) {
    Surface surface = box({0, 0, 0}, {1, 1, 1});
    const auto [a, b, c] = surface.triangles[0];
    Point middle;
    for (std::size_t k = 0; k < 3; ++k) {
      middle[k] = (surface.vertices[a][k] + surface.vertices[b][k]) / 2;
    }
    const auto m = static_cast<std::uint32_t>(surface.vertices.size());
    surface.vertices.push_back(middle);
    surface.triangles[0] = {a, m, c};
    surface.triangles.push_back({m, b, c});
    if (joined) surface.triangles.push_back({a, b, m});
    const UnionResult result = expect_valid({surface}, 1);
    EXPECT_EQ(result.counts.degenerate, joined ? 1U : 0U);
    EXPECT_EQ(result.surface.triangles.size(), 12U);
  }
}

TEST(Union, PiecesHaveTheLabelsOfTheirTriangles) {
  Surface surface = together({box({0, 0, 0}, {2, 2, 2}), box({1, 1, 1}, {3, 3, 3})});
  for (std::size_t t = 0; t < 24; ++t) surface.labels.push_back(t < 12 ? 7 : 9);
  const UnionResult result = unite(surface);
  ASSERT_EQ(result.surface.labels.size(), result.surface.triangles.size());
  std::array<int, 2> seen{};
  for (std::size_t t = 0; t < result.surface.triangles.size(); ++t) {
    Point middle{};
    for (const auto v : result.surface.triangles[t]) {
      for (std::size_t k = 0; k < 3; ++k) middle[k] += result.surface.vertices[v][k] / 3;
    }
    const bool first =
        std::all_of(middle.begin(), middle.end(), [](double x) { return x <= 2.0000001; }) &&
        std::any_of(middle.begin(), middle.end(),
                    [](double x) { return std::fabs(x) < 1e-9 || std::fabs(x - 2) < 1e-9; });
    EXPECT_EQ(result.surface.labels[t], first ? 7 : 9) << t;
    ++seen[first ? 0 : 1];
  }
  EXPECT_GT(seen[0], 12);
  EXPECT_GT(seen[1], 12);
}

TEST(Union, StopsWhenAsked) {
  const Surface one = box({0, 0, 0}, {1, 1, 1});
  std::vector<Surface> many;
  for (int i = 0; i < 30; ++i) many.push_back(rotated(one, {7, i, 1, 2}, Precision::doubles));
  UnionOptions options;
  options.go_on = [] { return false; };
  const UnionResult result = unite(together(many), options);
  EXPECT_EQ(result.code, UnionCode::stopped);
  EXPECT_TRUE(result.surface.triangles.empty());
}

Surface random_box(Random& random, bool grid) {
  Point low, high;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = grid ? random.integer(0, 4) : random.between(-1, 0.5);
    high[k] = low[k] + (grid ? random.integer(1, 3) : random.between(0.1, 1));
  }
  return box(low, high);
}

// Boxes on a grid have sides in common planes, edges on sides, and touch now and then.
TEST(Union, OfBoxesOnAGrid) {
  Random random(5);
  int inside = 0, touching = 0;
  for (int round = 0; round < 40; ++round) {
    std::vector<Surface> bodies;
    for (int i = 0; i < 2 + round % 4; ++i) bodies.push_back(random_box(random, true));
    const UnionResult result = unite(together(bodies));
    const bool valid = certified_valid(result.surface);
    ASSERT_EQ(result.code, valid ? UnionCode::done : UnionCode::touching)
        << "round " << round << ": " << result.message;
    touching += valid ? 0 : 1;
    EXPECT_EQ(result.counts.largest_move, 0);  // no vertex is left where lines cross diagonals
    if (valid) inside += expect_same_inside(bodies, result.surface, random);
    // The volume by counting cells.
    int cells = 0;
    for (int cell = 0; cell < 512; ++cell) {
      const Point p = {cell % 8 + 0.5, cell / 8 % 8 + 0.5, cell / 64 + 0.5};
      const Bodies solids(bodies, {p});
      cells += solids.inside_any(0);
    }
    EXPECT_NEAR(volume(result.surface), cells, 1e-12 * cells);
  }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(touching, 0);
}

// In general position, and nearly so: `turn` says how far from a box's the sides of the others are.
void unite_rotated(std::uint64_t seed, double turn, int rounds) {
  Random random(seed);
  const bool nearly_grid = turn < 1e-14;
  int inside = 0, touching = 0, touching_on_grid = 0;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Surface> bodies, on_grid;
    for (int i = 0; i < 2 + round % 4; ++i) {
      Surface body = random_box(random, turn < 1);
      on_grid.push_back(body);
      const Point axis = {random.between(-turn, turn), random.between(-turn, turn),
                          random.between(-turn, turn)};
      shapes::move(body, [&](const Point& p) {
        return Point{p[0] - axis[2] * p[1] + axis[1] * p[2], p[1] + axis[2] * p[0] - axis[0] * p[2],
                     p[2] - axis[1] * p[0] + axis[0] * p[1]};
      });
      bodies.push_back(body);
    }
    const UnionResult result = unite(together(bodies));
    const bool valid = certified_valid(result.surface);
    ASSERT_EQ(result.code, valid ? UnionCode::done : UnionCode::touching)
        << "round " << round << ": " << result.message;
    touching += valid ? 0 : 1;
    if (nearly_grid) touching_on_grid += unite(together(on_grid)).code == UnionCode::touching;
    EXPECT_LT(result.counts.largest_move, 1e-13);
    if (valid) inside += expect_same_inside(bodies, result.surface, random);
    const UnionResult again = unite(result.surface);
    EXPECT_EQ(again.surface.vertices, result.surface.vertices);
    EXPECT_EQ(again.surface.triangles, result.surface.triangles);
    const UnionResult same = unite(together(bodies));
    EXPECT_EQ(same.surface.vertices, result.surface.vertices);
    EXPECT_EQ(same.surface.triangles, result.surface.triangles);
    // Vertices are given or new. Further rounds make points of their own.
    if (result.counts.rounds > 1) continue;
    const Surface input = together(bodies);
    const std::set<Point> given(input.vertices.begin(), input.vertices.end());
    const auto fresh = std::count_if(result.surface.vertices.begin(), result.surface.vertices.end(),
                                     [&](const Point& p) { return !given.contains(p); });
    EXPECT_LE(static_cast<std::uint64_t>(fresh), result.counts.new_points);
  }
  EXPECT_GT(inside, 20 * rounds);
  // What all but touches is joined, and so touches where it does on the grid.
  EXPECT_LE(touching, nearly_grid ? touching_on_grid + rounds / 10 : 0);
}

TEST(Union, OfRotatedBoxes) {
  unite_rotated(6, 1, 40);
}

TEST(Union, OfBoxesWhoseSidesAreNearlyInOnePlane) {
  unite_rotated(7, 1e-3, 20);
  unite_rotated(8, 1e-9, 20);
  unite_rotated(9, 1e-14, 20);
  unite_rotated(10, 3e-16, 20);
}

// A thread of `turns` turns of the height 1, each as high: they meet along the whole thread, but
// for the rounding of sines. The volume is that of prisms between the planes of neighbouring
// profiles.
TEST(Union, OfTurnsThatMeetUpToRounding) {
  constexpr int kSteps = 24, kTurns = 3, kSides = 6;
  constexpr std::array<std::array<double, 2>, kSides> kProfile = {
      {{1, -0.5}, {1.6, -0.2}, {1.6, 0.2}, {1, 0.5}, {0.8, 0.5}, {0.8, -0.5}}};
  for (const double start : {0.0, 0.3}) {
    Surface thread;
    for (int k = 0; k <= kTurns * kSteps; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSteps + start;
      for (const auto& [radius, height] : kProfile) {
        thread.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle),
                                   static_cast<double>(k) / kSteps + height});
      }
    }
    for (std::uint32_t k = 0; k < kTurns * kSteps * kSides; ++k) {
      const std::uint32_t next = (k + 1) % kSides == 0 ? k + 1 - kSides : k + 1;
      thread.triangles.push_back({k, k + kSides, next + kSides});
      thread.triangles.push_back({k, next + kSides, next});
    }
    for (std::uint32_t i = 1, end = kTurns * kSteps * kSides; i + 1 < kSides; ++i) {
      thread.triangles.push_back({0, i, i + 1});
      thread.triangles.push_back({end, end + i + 1, end + i});
    }
    UnionOptions options;
    options.separate = 1e-4;
    const UnionResult result = unite(thread, options);
    EXPECT_EQ(result.code, UnionCode::done) << result.message;
    EXPECT_TRUE(certified_valid(result.surface));
    EXPECT_EQ(result.counts.bodies_after, 1U);
    EXPECT_LT(result.counts.largest_move, 1e-14);
    // Turns overlap at most where sides that are bent cross each other's.
    EXPECT_LT(result.counts.volume_after, result.counts.volume_before);
    EXPECT_NEAR(result.counts.volume_after, result.counts.volume_before,
                1e-3 * result.counts.volume_before);
  }
}

// Of a globe: meridians and parallels.
Surface globe(std::uint32_t parallels, std::uint32_t meridians, const Point& centre) {
  Surface surface;
  const auto add = [&](double polar, double turn) {
    surface.vertices.push_back({centre[0] + std::sin(polar) * std::cos(turn),
                                centre[1] + std::sin(polar) * std::sin(turn),
                                centre[2] + std::cos(polar)});
  };
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return (i - 1) * meridians + j % meridians;
  };
  for (std::uint32_t i = 1; i < parallels; ++i) {
    for (std::uint32_t j = 0; j < meridians; ++j) {
      add(std::numbers::pi * i / parallels, 2 * std::numbers::pi * j / meridians);
    }
  }
  const auto north = static_cast<std::uint32_t>(surface.vertices.size()), south = north + 1;
  add(0, 0);
  add(std::numbers::pi, 0);
  for (std::uint32_t j = 0; j < meridians; ++j) {
    surface.triangles.push_back({north, at(1, j), at(1, j + 1)});
    surface.triangles.push_back({south, at(parallels - 1, j + 1), at(parallels - 1, j)});
    for (std::uint32_t i = 1; i + 1 < parallels; ++i) {
      surface.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      surface.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return surface;
}

double least_height(const Surface& surface) {
  double least = HUGE_VAL;
  for (const auto& t : surface.triangles) {
    std::array<Point, 3> side;
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &p = surface.vertices[t[k]], &q = surface.vertices[t[(k + 1) % 3]];
      side[k] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
      longest = std::max(longest, std::hypot(side[k][0], side[k][1], side[k][2]));
    }
    const auto& [u, v, w] = side;
    least = std::min(least, std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                       u[0] * v[1] - u[1] * v[0]) /
                                longest);
  }
  return least;
}

// Meridians of both meet in the plane between their centres, up to roundings.
TEST(Union, LeavesNoNeedles) {
  std::uint64_t needles = 0;
  for (const double apart : {0.25, 0.5, 0.75, 1.0}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Point centre{0, 0, 0};
      centre[axis] = apart / 2;
      const Surface one = globe(16, 24, centre);
      centre[axis] = -apart / 2;
      const Surface both = together({one, globe(16, 24, centre)});
      const UnionResult result = unite(both);
      EXPECT_EQ(result.code, UnionCode::done) << result.message;
      EXPECT_TRUE(certified_valid(result.surface));
      EXPECT_GT(least_height(result.surface), 0x1p-48) << apart << " " << axis;
      EXPECT_FALSE(says(result, "left"));
      EXPECT_LT(result.counts.largest_move, 1e-13);
      EXPECT_LT(result.counts.volume_after, result.counts.volume_before);
      needles += result.counts.needles;
      EXPECT_EQ(unite(result.surface).surface.triangles, result.surface.triangles);
    }
  }
  EXPECT_GT(needles, 0U);
}

TEST(Union, OfSpheres) {
  Random random(3);
  const Surface one = shapes::sphere(3, [&] { return random.between(0.98, 1); });
  Surface other = one;
  shapes::move(other, [](const Point& p) { return Point{p[0] + 0.7, p[1] + 0.1, p[2] + 0.05}; });
  const UnionResult result = unite(together({one, other}));
  EXPECT_EQ(result.code, UnionCode::done) << result.message;
  EXPECT_TRUE(certified_valid(result.surface));
  expect_same_inside({one, other}, result.surface, random);
  // Only what is cut is new.
  EXPECT_LT(result.counts.cut, one.triangles.size());
}

}  // namespace
}  // namespace tetproof::unite
