// The oracles of the plane: signs, graphs, files, the grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "oracles/base/steps.h"
#include "oracles/base/text_reader.h"
#include "oracles/plane/boxes.h"
#include "oracles/plane/faces.h"
#include "oracles/plane/file.h"
#include "oracles/plane/graph.h"
#include "oracles/plane/points.h"
#include "oracles/plane/slabs.h"
#include "oracles/plane/verify.h"
#include "property_tests/oracle_units/helpers.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT

// Of 50 x 50 unit boxes, far from the origin as well as near it, those that a query meets are
// visited, in their order.
TEST(PlaneBoxes, VisitsWhatIsNear) {
  for (const double offset : {-1000.0, -25.0, 0.0, 1000.0}) {
    std::vector<PlaneBoxes::Box> items;
    for (int i = 0; i < 2500; ++i) {
      const PlaneBoxes::Corner low = {offset + i % 50, offset + i / 50};  // NOLINT: rows of 50
      items.push_back({low, {low[0] + 1, low[1] + 1}});
    }
    const PlaneBoxes boxes(items);
    for (const int place : {0, 20, 47}) {
      const PlaneBoxes::Corner low = {offset + place + 0.5, offset + place + 0.5};
      std::vector<int> found;
      boxes.visit({low, {low[0] + 1, low[1]}},
                  [&](std::uint32_t item) { found.push_back(static_cast<int>(item)); });
      EXPECT_EQ(found, (std::vector<int>{51 * place, 51 * place + 1})) << offset;
    }
  }
}

PlanePoints plane_points(const std::vector<std::array<double, 2>>& given) {
  PlanePoints points;
  for (const auto& [x, y] : given) points.add({x, y, x, y});
  return points;
}

TEST(PlaneSigns, OfASquareAndBeside) {
  PlanePoints p = plane_points({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}, {2, 0}, {3, 3}});
  EXPECT_EQ(p.orient(0U, 1U, 2U), 1);
  EXPECT_EQ(p.orient(0U, 2U, 1U), -1);
  EXPECT_EQ(p.orient(0U, 1U, 5U), 0);
  EXPECT_EQ(p.in_circle(0, 1, 2, 4), 1);
  EXPECT_EQ(p.in_circle(0, 1, 2, 3), 0);
  EXPECT_EQ(p.in_circle(0, 1, 2, 5), -1);
  EXPECT_EQ(p.in_circle(0, 2, 1, 5), 1);
  EXPECT_TRUE(p.encroaches(0, 4, 5));
  EXPECT_FALSE(p.encroaches(0, 4, 1));  // on the circle
  EXPECT_TRUE(p.encroaches(0, 1, 5));
  EXPECT_FALSE(p.encroaches(0, 1, 2));  // a right angle
  EXPECT_FALSE(p.encroaches(0, 6, 1));
  EXPECT_EQ(p.checks, 12U);
  EXPECT_EQ(p.parameter(4, 0, 2), mpq_class(0.5));
  EXPECT_EQ(p.parameter(6, 0, 2), 3);
  EXPECT_EQ(p.parameter(3, 0, 3), 1);  // upright
  EXPECT_NEAR(p.distance(0, 6), std::sqrt(18.0), 1e-15);
  EXPECT_NEAR(p.distance(5, 3), std::sqrt(5.0), 1e-15);
  EXPECT_EQ(p.distance_to_segment(3, 0, 1), 1);
  EXPECT_DOUBLE_EQ(p.distance_to_segment(3, 1, 5), std::sqrt(2.0));   // beyond the first end
  EXPECT_DOUBLE_EQ(p.distance_to_segment(6, 0, 1), std::sqrt(13.0));  // beyond the second
  EXPECT_NEAR(p.distance_to_segment(1, 0, 2), std::sqrt(0.5), 1e-15);
  EXPECT_EQ(p.distance_to_segment(4, 0, 2), 0);
}

// Where doubles tell, rationals are not asked. Here these are all zero and would answer 0, so the
// answer comes from the doubles, and it must be right.
// The measure of what verification costs only grows.
TEST(PlaneSigns, CountTheirSteps) {
  PlanePoints points = plane_points({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  const auto grows = [](const auto& decide) {
    const std::uint64_t before = oracles::steps;
    decide();
    return oracles::steps > before && oracles::steps - before < 1000;
  };
  EXPECT_TRUE(grows([&] { points.orient(0U, 1U, 2U); }));
  EXPECT_TRUE(grows([&] { points.in_circle(0, 1, 2, 3); }));
  EXPECT_TRUE(grows([&] { points.encroaches(0, 1, 2); }));
  EXPECT_TRUE(grows([&] { points.parameter(1, 0, 2); }));
  EXPECT_TRUE(grows([&] { points.distance_to_segment(1, 0, 2); }));
}

TEST(PlaneSigns, DoublesTellWhatIsObvious) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 2000; ++round) {
    std::array<std::array<std::int64_t, 2>, 4> x;
    PlanePoints p;
    for (auto& point : x) {
      for (std::int64_t& c : point) c = static_cast<std::int64_t>(random() % 2001) - 1000;
      p.add({0, 0, static_cast<double>(point[0]), static_cast<double>(point[1])});
    }
    const auto sign = [](std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; };
    const auto area = [&](int a, int b, int c) {
      return (x[b][0] - x[a][0]) * (x[c][1] - x[a][1]) - (x[b][1] - x[a][1]) * (x[c][0] - x[a][0]);
    };
    EXPECT_EQ(p.orient(0U, 1U, 2U), sign(area(0, 1, 2)));
    std::int64_t lifted = 0;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t u = x[i][0] - x[3][0], v = x[i][1] - x[3][1];
      lifted += (u * u + v * v) * area(3, (i + 1) % 3, (i + 2) % 3);
    }
    EXPECT_EQ(p.in_circle(0, 1, 2, 3), sign(lifted));
  }
}

TEST(PlaneSigns, AgreeWithMachineIntegersOnALattice) {
  std::mt19937_64 random(7);
  std::array<std::array<int, 3>, 2> counts{};
  for (int round = 0; round < 4000; ++round) {
    std::vector<std::array<double, 2>> given(4);
    std::array<std::array<std::int64_t, 2>, 4> x;
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < 2; ++k) {
        x[i][k] = static_cast<std::int64_t>(random() % 4);
        given[i][k] = 0x1p40 + static_cast<double>(x[i][k]) * 0x1.0000001p10;
      }
    }
    PlanePoints p = plane_points(given);
    const auto sign = [](std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; };
    const auto area = [&](int a, int b, int c) {
      return (x[b][0] - x[a][0]) * (x[c][1] - x[a][1]) - (x[b][1] - x[a][1]) * (x[c][0] - x[a][0]);
    };
    ASSERT_EQ(p.orient(0U, 1U, 2U), sign(area(0, 1, 2)));
    ++counts[0][sign(area(0, 1, 2)) + 1];
    std::int64_t lifted = 0;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t u = x[i][0] - x[3][0], v = x[i][1] - x[3][1];
      lifted += (u * u + v * v) * area(3, (i + 1) % 3, (i + 2) % 3);
    }
    ASSERT_EQ(p.in_circle(0, 1, 2, 3), sign(lifted));
    ++counts[1][sign(lifted) + 1];
  }
  for (const auto& of_predicate : counts) {
    for (const int count : of_predicate) EXPECT_GT(count, 100);
  }
}

// A vertex on a segment cuts it, whichever vertex it is. A vertex beside it, beyond its end or at
// its end does not.
TEST(PlaneGraph, SegmentsAreCutWhereVerticesLieOnThem) {
  delmesher::PlanarGraph graph;
  graph.vertices = {{1, 0}, {0, 0}, {4, 0}, {2, 0x1p-40}, {3, 0}, {5, 0}};
  graph.segments = {{1, 2}, {2, 1}};
  PlaneGraph cut(graph);
  ASSERT_EQ(cut.pieces().size(), 3U);
  const std::array<Index, 4> along = {1, 0, 4, 2};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(cut.pieces()[i].a, along[i]);
    EXPECT_EQ(cut.pieces()[i].b, along[i + 1]);
    EXPECT_EQ(cut.pieces()[i].segment, 0U);
  }
}

TEST(PlaneGraph, KnowsTheAreaOfASingleRing) {
  delmesher::PlanarGraph graph;
  graph.vertices = {{0, 0}, {4, 0}, {4, 3}, {10, 0}, {11, 0}, {11, 1}};
  const auto twice_area = [&](const std::vector<std::array<Index, 2>>& segments) {
    graph.segments.assign(segments.begin(), segments.end());
    return PlaneGraph(graph).area_of_ring();
  };
  EXPECT_EQ(twice_area({{0, 1}, {1, 2}, {2, 0}}), 12);
  EXPECT_EQ(twice_area({{2, 1}, {0, 2}, {0, 1}}), 12);  // clockwise, as they come
  EXPECT_LT(twice_area({{0, 1}, {1, 2}}), 0);
  EXPECT_LT(twice_area({{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}}), 0);
  graph.segments = {{0, 1}, {1, 2}, {2, 0}};
  EXPECT_TRUE(PlaneGraph(graph).closed_rings());
  graph.segments.pop_back();
  EXPECT_FALSE(PlaneGraph(graph).closed_rings());
}

// The last line is a line, with or without its end.
TEST(PlaneFiles, AreReadToTheirLastCharacter) {
  const std::string ring = "0 0\n4 0\n0 4";
  for (const char* end : {"", "\n", "\n\n", "\r\n", "\n>"}) {
    EXPECT_EQ(read_plane_graph(written("ring.txt", ring + end)).vertices.size(), 3U);
  }
  EXPECT_THROW(read_plane_graph(written("ring.txt", ring + "\n7")), ReadError);
  EXPECT_THROW(read_plane_graph(written("ring.txt", ring + "\nx")), ReadError);
}

TEST(PlaneFiles, ListedEdgesHaveMarkers) {
  const std::string path = written("triangle.node", "3 2 0 0\n1 0 0\n2 4 0\n3 0 4\n");
  written("triangle.ele", "1 3 0\n1 1 2 3\n");
  written("triangle.poly", "0 2 0 0\n3 1\n1 1 2 7\n2 2 3 8\n3 3 1 9\n0\n");
  PlaneFile file = read_plane_file(path);
  EXPECT_TRUE(file.lists_edges);
  EXPECT_EQ(file.edges, (std::vector<std::array<Index, 2>>{{0, 1}, {1, 2}, {2, 0}}));
  EXPECT_EQ(file.markers, (std::vector<std::int32_t>{7, 8, 9}));
  written("triangle.poly", "0 2 0 0\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n");
  file = read_plane_file(path);
  EXPECT_EQ(file.markers, (std::vector<std::int32_t>{0, 0, 0}));
}

// Squares around each other, with a line into the innermost and one between the second and third,
// and a triangle beside them.
delmesher::PlanarGraph squares() {
  delmesher::PlanarGraph graph;
  for (const double r : {4.0, 3.0, 2.0, 1.0}) {
    const auto first = static_cast<std::uint32_t>(graph.vertices.size());
    for (const auto& [x, y] : {std::pair(-r, -r), {r, -r}, {r, r}, {-r, r}}) {
      graph.vertices.push_back({x, y});
    }
    for (std::uint32_t k = 0; k < 4; ++k) {
      graph.segments.push_back({first + k, first + (k + 1) % 4});
    }
  }
  return graph;
}

// In the middle of the innermost square, between the squares from there on, and outside.
std::string sides_of(const delmesher::PlanarGraph& given) {
  PlaneGraph graph(given);
  PlaneFaces faces(graph);
  std::string sides;
  for (const double x : {0.25, 1.25, 2.25, 3.25, 4.25}) {
    for (const double y : {0.0, 0.125, -0.25}) {
      sides += faces.inside({x, y, x, y}) ? 'i' : 'o';
    }
  }
  return sides;
}

TEST(PlaneFaces, OfSquaresAroundEachOther) {
  delmesher::PlanarGraph graph = squares();
  graph.insideness = delmesher::Insideness::nested;
  EXPECT_EQ(sides_of(graph), "oooiiioooiiiooo");
  graph.insideness = delmesher::Insideness::enclosed;
  EXPECT_EQ(sides_of(graph), "iiiiiiiiiiiiooo");
  graph.holes = {{0.5, 0}, {-2.5, 0}};
  EXPECT_EQ(sides_of(graph), "oooiiioooiiiooo");
  // A line that ends in a face bounds nothing.
  graph.vertices.push_back({2.5, 0.125});
  graph.segments.push_back({10, 16});
  EXPECT_EQ(sides_of(graph), "oooiiioooiiiooo");
  // Two lines from within a side of a square cut that face; the third is half of that side.
  graph.vertices[16] = {2, 0};
  graph.segments.push_back({16, 5});
  graph.segments.push_back({16, 6});
  EXPECT_EQ(sides_of(graph), "oooiiiiiiiiiooo");
  graph.holes[1] = {2.5, 0};
  EXPECT_EQ(sides_of(graph), "oooiiioooiiiooo");
}

TEST(PlaneFaces, SeparateWhereASideIsInside) {
  delmesher::PlanarGraph given = squares();
  given.holes = {{0, 0}};
  PlaneGraph graph(given);
  const PlaneFaces faces(graph);
  std::string separating;
  for (std::uint32_t piece = 0; piece < 16; ++piece)
    separating += faces.separates(piece) ? 's' : '-';
  EXPECT_EQ(separating, "ssss--------ssss");
}

// Each oracle says how much it has looked at: all that it is about, by plain counts and by Euler's
// formula, of a triangulated rectangle, for edges.
TEST(PlaneCounts, AreThoseOfTheRecord) {
  delmesher::PlanarGraph graph = squares();
  graph.insideness = delmesher::Insideness::enclosed;
  graph.holes = {{0, 0}};
  graph.vertices.push_back({6, 0});  // a wing, acute beside the square
  graph.segments.push_back({1, 16});
  graph.segments.push_back({16, 2});
  for (const bool hull : {false, true}) {
    delmesher::PlaneOptions options;
    options.want_exact = true;
    if (hull) options.region = delmesher::Region::hull;
    const delmesher::PlaneResult result = triangulate_polygon(graph, options);
    const PlaneVerdict verdict = verify_plane(graph, options, result);
    ASSERT_TRUE(verdict.ok()) << verdict.text();
    const delmesher::PlaneRecord& record = result.exact;
    EXPECT_EQ(record.corners.size(), 2U);
    const auto on_segments = [](const auto& edges) {
      return static_cast<std::size_t>(
          std::ranges::count_if(edges, [](const auto& e) { return e.segment != 0xffffffffU; }));
    };
    // Each edge is a side of two triangles, but for those of the rectangle; listed ones are left
    // out.
    const auto free = [&](const auto& triangles, const auto& edges) {
      return (3 * triangles.size() + edges.size() - on_segments(edges)) / 2 - edges.size();
    };
    const std::size_t vertices = graph.vertices.size(), pieces = graph.segments.size(),
                      triangles = result.mesh.triangles.size(), refined = record.refined.size(),
                      final = record.final.size(), edges = on_segments(record.final_edges),
                      inside =
                          refined - static_cast<std::size_t>(
                                        std::ranges::count_if(record.refined, [](const auto&t) {
                                          return t.side == delmesher::PlaneRecord::Side::outside;
                                        }));
    const std::map<std::string, std::size_t> wanted = {
        {"complex", triangles},
        {"orientation", triangles},
        {"conformity", pieces + vertices + 3 * triangles + (hull ? 1 : 0)},
        {"sides", triangles + edges + graph.holes.size()},
        {"edge-list", 2 * edges},
        {"angles", triangles},
        {"refined-complex", refined + record.refined_edges.size()},
        {"refined-orientation", refined},
        {"refined-delaunay", free(record.refined, record.refined_edges)},
        {"exact-complex", final + record.final_edges.size()},
        {"exact-orientation", final},
        {"exact-delaunay", free(record.final, record.final_edges)},
        {"exact-conformity", edges},
        {"exact-sides", final},
        {"enrichment", record.points.size()},
        {"refined-segments", pieces + on_segments(record.refined_edges)},
        {"refined-angles", hull ? refined : inside},
        {"refined-encroachment", hull ? refined : inside},
        {"refined-sides", refined},
        {"refined-chamfer-distance", vertices + record.corners.size()},
        {"refined-chamfer-need", vertices},
        {"refined-chamfer-cuts", 3 * pieces},
        {"refined-drops", pieces},
        {"same-mesh", triangles + edges},
        {"rounding", record.mesh_vertices.size()}};
    std::size_t compared = 0;
    for (const OracleReport& oracle : verdict.report.oracles) {
      const auto found = wanted.find(oracle.name);
      if (found == wanted.end()) continue;
      ++compared;
      EXPECT_EQ(oracle.checked, found->second) << oracle.name << (hull ? " hull" : "");
    }
    EXPECT_EQ(compared, wanted.size());
  }
}

// Parity says the same of rings, at points level with vertices as well.
TEST(PlaneFaces, OfRingsAreThoseOfParity) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    delmesher::PlanarGraph given;
    given.insideness = delmesher::Insideness::nested;
    for (int ring = 0; ring < 4; ++ring) {  // stars about one point, each inside the one before
      const auto first = static_cast<std::uint32_t>(given.vertices.size());
      constexpr std::uint32_t kCorners = 9;
      for (std::uint32_t k = 0; k < kCorners; ++k) {
        const double angle = 2 * 3.14159265358979 * k / kCorners;
        const double r = 64 >> ring,
                     here = r * (0.6 + 0.4 * static_cast<double>(random() % 100) / 100);
        given.vertices.push_back({std::round(4 * here * std::cos(angle)) / 4,
                                  std::round(4 * here * std::sin(angle)) / 4});
        given.segments.push_back({first + k, first + (k + 1) % kCorners});
      }
    }
    PlaneGraph graph(given);
    ASSERT_TRUE(graph.closed_rings());
    PlaneFaces faces(graph);
    for (int k = 0; k < 200; ++k) {
      const double x = static_cast<double>(random() % 640) / 5 - 64.1,
                   y = given.vertices[random() % given.vertices.size()][1] + (k % 2 == 0 ? 0 : 0.1);
      if (graph.on_segment({x, y})) continue;
      EXPECT_EQ(faces.inside({x, y, x, y}), graph.inside_by_ray({x, y, x, y})) << x << " " << y;
    }
  }
}

// The pieces that a ray crosses, one by one: those that it has at its height, and to its right.
TEST(PlaneSlabs, KnowWhatARayCrosses) {
  std::mt19937 random(7);
  const auto coordinate = [&] { return static_cast<int>(random() % 9) - 4; };
  std::size_t crossed = 0;
  for (int round = 0; round < 300; ++round) {
    PlanePoints points;
    std::vector<std::array<int, 2>> places;
    for (int n = 0; n < 12; ++n) {
      places.push_back({coordinate(), coordinate()});
      const auto [x, y] = places.back();
      points.add({x, y, static_cast<double>(x), static_cast<double>(y)});
    }
    // Spokes of one hub, then any pieces, which cross and are level or equal as well.
    std::vector<PlaneSlabs::Piece> pieces;
    for (std::uint32_t n = 1; n < 12; ++n) {
      const auto other = round % 2 == 0 ? 0 : static_cast<std::uint32_t>(random() % 12);
      if (places[other] != places[n]) pieces.push_back({n, other});
    }
    PlaneSlabs slabs(points, pieces);
    for (int x = -9; x <= 9; ++x) {
      for (int y = -9; y <= 9; ++y) {  // halves
        std::vector<std::uint32_t> found, wanted;
        const auto at = [](int half) { return mpq_class(half, 2); };
        slabs.right_of({at(x), at(y), x / 2.0, y / 2.0}, [&](std::span<const std::uint32_t> some) {
          found.insert(found.end(), some.begin(), some.end());
        });
        for (std::uint32_t n = 0; n < pieces.size(); ++n) {
          auto a = places[pieces[n].a], b = places[pieces[n].b];
          if (b[1] < a[1]) std::swap(a, b);
          if (2 * a[1] > y || 2 * b[1] <= y) continue;
          // A little above y, by as little as the determinant of doubled coordinates tells.
          const int rise = b[1] - a[1],
                    side = (b[0] - a[0]) * (y - 2 * a[1]) - (x - 2 * a[0]) * rise;
          if (side > 0 || (side == 0 && b[0] > a[0])) wanted.push_back(n);
        }
        std::ranges::sort(found);
        crossed += wanted.size();
        EXPECT_EQ(found, wanted) << round << ": " << x << " " << y;
      }
    }
  }
  EXPECT_GT(crossed, 10000U);
}

// A triangulation of n wedges around one vertex, or of n teeth of a comb, as planar graph and file.
std::pair<delmesher::PlanarGraph, PlaneFile> wedges(std::uint32_t n) {
  delmesher::PlanarGraph graph;
  PlaneFile file;
  graph.vertices = {{0, 0}};
  for (std::uint32_t k = 0; k < n; ++k) {
    const double angle = 2 * 3.14159265358979 * k / n;
    graph.vertices.push_back({std::cos(angle), std::sin(angle)});
    graph.segments.push_back({0, k + 1});
    graph.segments.push_back({k + 1, (k + 1) % n + 1});
    file.triangles.push_back({0, k + 1, (k + 1) % n + 1});
  }
  file.vertices = graph.vertices;
  return {graph, file};
}

std::pair<delmesher::PlanarGraph, PlaneFile> comb(std::uint32_t n) {
  delmesher::PlanarGraph graph;
  PlaneFile file;
  graph.vertices = {{0, -1}};
  for (std::uint32_t k = 0; k < n; ++k) {
    const double x = 2.0 * k;
    const std::uint32_t left = 3 * k + 1, tip = left + 1, right = left + 2, next = left + 3;
    for (const auto& p : {std::array{x, 0.0}, std::array{x + 0.5, 1.0}, std::array{x + 1, 0.0}}) {
      graph.vertices.push_back(p);
    }
    for (const std::uint32_t v : {left, tip, right}) graph.segments.push_back({v, v + 1});
    file.triangles.push_back({left, right, tip});
    file.triangles.push_back({0, right, left});
    file.triangles.push_back({0, next, right});
  }
  graph.vertices.push_back({2.0 * n, 0});
  graph.segments.push_back({3 * n + 1, 0});
  graph.segments.push_back({0, 1});
  file.vertices = graph.vertices;
  return {graph, file};
}

// Twice as many wedges or teeth are verified in twice as many steps, but for a logarithm.
TEST(PlaneCost, GrowsWithTheNumberOfSpokesAndTeeth) {
  for (const auto& make : {wedges, comb}) {
    double before = 0;
    for (const std::uint32_t n : {500U, 1000U, 2000U}) {
      const auto& [graph, file] = make(n);
      oracles::VerifyReport report;
      const std::uint64_t begun = oracles::steps;
      EXPECT_EQ(verify_plane(graph, file, nullptr, {}, report), "");
      EXPECT_EQ(report.verdict, Verdict::exact);
      const auto taken = static_cast<double>(oracles::steps - begun);
      EXPECT_TRUE(before == 0 || taken < 2.4 * before) << n << ": " << before << " " << taken;
      before = taken;
    }
  }
}

// The same of refined meshes with records, per triangle.
TEST(PlaneCost, GrowsWithTheSizeOfTheRecord) {
  double before = 0;
  for (const std::uint32_t n : {100U, 200U, 400U}) {
    const delmesher::PlanarGraph graph = wedges(n).first;
    delmesher::PlaneOptions options;
    options.want_exact = true;
    const delmesher::PlaneResult result = triangulate_polygon(graph, options);
    const std::uint64_t begun = oracles::steps;
    const PlaneVerdict verdict = verify_plane(graph, options, result);
    EXPECT_TRUE(verdict.ok()) << verdict.text();
    const double taken = static_cast<double>(oracles::steps - begun) /
                         static_cast<double>(result.mesh.triangles.size());
    EXPECT_TRUE(before == 0 || taken < 1.1 * before) << n << ": " << before << " " << taken;
    before = taken;
  }
}

}  // namespace
}  // namespace tetproof
