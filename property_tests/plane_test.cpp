// End-to-end properties of triangulate_polygon, judged by the exact oracles of the plane.
// TETPROOF_ITERATIONS widens the generated inputs; the long run is tiny-angles of tetproof
// generate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <random>
#include <thread>

#include "mesher/delmesher_plane.h"
#include "oracles/plane/shapes.h"
#include "oracles/plane/verify.h"

namespace {

using namespace delmesher;
namespace shapes = tetproof::shapes;

// That many times TETPROOF_ITERATIONS.
int iterations(int normal) {
  const char* times = std::getenv("TETPROOF_ITERATIONS");
  return times == nullptr ? normal : std::max(1, std::atoi(times)) * normal;
}

PlaneOptions exact_options() {
  PlaneOptions options;
  options.want_exact = true;
  return options;
}

PlaneResult expect_verified(const PlanarGraph& graph,
                            const PlaneOptions& options = exact_options()) {
  PlaneResult result = triangulate_polygon(graph, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  if (!result.status.ok()) return result;
  const tetproof::PlaneVerdict verdict = tetproof::verify_plane(graph, options, result);
  EXPECT_TRUE(verdict.ok()) << verdict.text();
  EXPECT_GT(verdict.checks, 0U);
  EXPECT_EQ(result.statistics.rounding_inverted, 0U);
  return result;
}

std::string refusal(const PlanarGraph& graph, const PlaneOptions& options = {}) {
  const PlaneResult result = triangulate_polygon(graph, options);
  EXPECT_EQ(result.status.code, StatusCode::invalid_surface);
  EXPECT_TRUE(result.mesh.triangles.empty());
  return result.status.message;
}

// Points times 2^k.
std::vector<std::array<double, 2>> scaled(std::vector<std::array<double, 2>> points, int k) {
  for (auto& p : points) p = {std::ldexp(p[0], k), std::ldexp(p[1], k)};
  return points;
}

// Every oracle, and the bound down to the outer box.
TEST(Plane, AsThePaperSays) {
  PlaneOptions options = paper_plane_options();
  options.want_exact = true;
  const PlanarGraph graphs[] = {shapes::square(), shapes::star(7, 0.2), shapes::comb(6, 0.1),
                                shapes::koch(3), shapes::nested_squares(3)};
  for (const PlanarGraph& graph : graphs) {
    const PlaneResult result = expect_verified(graph, options);
    EXPECT_GE(result.statistics.refined.min_angle, PlaneOptions().delta);
  }
}

TEST(Plane, Families) {
  const PlaneResult square = expect_verified(shapes::square());
  EXPECT_EQ(square.mesh.triangles.size(), 2U);  // a tie of four cocircular points costs nothing
  EXPECT_GT(expect_verified(shapes::star(7, 0.2)).statistics.acute_vertices, 0U);
  expect_verified(shapes::comb(6, 0.1));
  EXPECT_EQ(expect_verified(shapes::koch(3)).statistics.dropped_segments, 0U);
  expect_verified(shapes::fan(9, 0.05));
  expect_verified(shapes::nested_squares(5));
  expect_verified(shapes::rough_circle(150, 0.3, 1));
  expect_verified(shapes::archipelago(200, 20, 3));
  expect_verified(shapes::figure());
}

TEST(Plane, OptionsKeepTheirPromises) {
  for (const Region region : {Region::interior, Region::hull}) {
    for (const double acute : {60.0, 90.0}) {
      PlaneOptions options = exact_options();
      options.region = region;
      options.acute = acute;
      expect_verified(shapes::figure(), options);
      expect_verified(shapes::star(5, 0.3), options);
      options.approximate = true;
      expect_verified(shapes::figure(), options);
      options.chamfer_radius = 0.01;
      expect_verified(shapes::figure(), options);
      options.tau = 0;
      options.delta = 10;
      expect_verified(shapes::figure(), options);
    }
  }
  PlaneOptions options = exact_options();
  options.max_edge = 0.1;
  const PlaneResult fine = expect_verified(shapes::square(), options);
  for (const auto& t : fine.mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const auto &p = fine.mesh.vertices[t[i]], &q = fine.mesh.vertices[t[(i + 1) % 3]];
      EXPECT_LE(std::hypot(p[0] - q[0], p[1] - q[1]), 0.1 * (1 + 1e-9));
    }
  }
}

TEST(Plane, BeyondTheProvenBound) {
  PlaneOptions options = exact_options();
  options.delta = 30;
  const PlaneResult result = expect_verified(shapes::figure(), options);
  EXPECT_EQ(result.statistics.guaranteed_delta, 30);
  EXPECT_GE(result.statistics.refined.min_angle, 30);
  options.delta = 34;  // may not end: then the proven bound holds
  const PlaneResult most = expect_verified(shapes::koch(2), options);
  EXPECT_GE(most.statistics.guaranteed_delta, 20.7);
  EXPECT_EQ(most.warnings.empty(), most.statistics.guaranteed_delta == 34);
}

TEST(Plane, CornersComeBackWithoutNeedles) {
  // The cut points around a corner lie on a circle whose centre is the corner. The refinement may
  // put a circumcentre there, which must not come back beside the corner.
  const PlanarGraph graph = shapes::archipelago(500, 55, 1);
  const PlaneResult result = expect_verified(graph);
  EXPECT_GT(result.exact.corners.size(), 10U);
  for (const PlaneRecord::Corner& corner : result.exact.corners) {
    const auto& a = graph.vertices[corner.vertex];
    for (const auto& p : result.mesh.vertices) {
      if (p == a) continue;
      EXPECT_GT(std::hypot(p[0] - a[0], p[1] - a[1]), corner.distance / 10) << corner.vertex;
    }
  }
  EXPECT_GT(result.statistics.final.min_angle, 2);
}

// A fan of n spokes in a square, evenly or not: no angle of the mesh is smaller than those of the
// fan. Where all points are kept, as in the paper, points beside the spokes make needles.
TEST(Plane, FansComeBackWithTheirOwnAngles) {
  for (const int n : {7, 24, 100}) {
    for (const bool even : {true, false}) {
      PlanarGraph graph;
      graph.vertices = {{0, 0}, {-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
      graph.segments = {{1, 2}, {2, 3}, {3, 4}, {4, 1}};
      double smallest = 360;
      for (int i = 0, before = -1; i < n; ++i) {
        const int turn = even || i % 3 != 1 ? 2 * i : 2 * i + 1;  // of 2 n
        const double angle = 3.14159265358979323846 * turn / n;
        graph.segments.push_back({0, static_cast<std::uint32_t>(graph.vertices.size())});
        graph.vertices.push_back({std::cos(angle), std::sin(angle)});
        if (before >= 0) smallest = std::min(smallest, 180.0 * (turn - before) / n);
        before = turn;
      }
      PlaneOptions options = exact_options();
      const double kept = std::min(smallest, 20.0) - 1e-9;
      EXPECT_GE(expect_verified(graph, options).statistics.final.min_angle, kept) << n << even;
      if (n == 24) {
        // What was cut off is longer than these edges, so angles beside it are smaller: no needles.
        options.max_edge = 0.1;
        const PlaneResult fine = expect_verified(graph, options);
        EXPECT_GE(fine.statistics.final.min_angle, 1) << even;
        options.as_paper.kept_points = true;
        const tetproof::PlaneVerdict verdict = tetproof::verify_plane(graph, options, fine);
        EXPECT_FALSE(verdict.ok());
        for (const std::string& failure : verdict.failures) {
          EXPECT_TRUE(failure.starts_with("enrichment: refined vertex")) << failure;
        }
        options.max_edge = 0;
        expect_verified(graph, options);
      }
    }
  }
}

TEST(Plane, TinyAngles) {
  std::uint64_t chamfered = 0, dropped = 0;
  const int n = iterations(96);
  for (int seed = 0; seed < n; ++seed) {
    const shapes::Named input = shapes::tiny_angles(static_cast<std::uint64_t>(seed));
    SCOPED_TRACE(input.name + " " + std::to_string(seed));
    PlaneOptions options = exact_options();
    // The larger the channels that are refined, the longer the oracles take.
    options.tau = seed % 16 == 0 ? 1e-4 : 1e-2;
    options.region = seed % 5 == 0 ? Region::hull : Region::interior;
    options.acute = seed % 3 == 0 ? 90 : 60;
    options.delta = seed % 7 == 0 ? 28 : 20.7;
    options.approximate = seed % 11 == 0;
    const PlaneResult result = expect_verified(input.graph, options);
    EXPECT_GE(result.statistics.refined.min_angle, 20.7 - 1e-6);
    chamfered += result.statistics.acute_vertices;
    dropped += result.statistics.dropped_segments;
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_GT(chamfered, 0U);  // not vacuous
  EXPECT_GT(dropped, 0U);
}

// --- relations between runs

TEST(Plane, ScalesWithPowersOfTwo) {
  for (const int k : {-300, -3, 1, 40, 300}) {
    PlanarGraph graph = shapes::figure();
    const PlaneResult first = triangulate_polygon(graph);
    graph.vertices = scaled(graph.vertices, k);
    const PlaneResult second = triangulate_polygon(graph);
    ASSERT_TRUE(first.status.ok() && second.status.ok());
    EXPECT_EQ(first.mesh.triangles, second.mesh.triangles);
    EXPECT_EQ(scaled(first.mesh.vertices, k), second.mesh.vertices);
  }
}

TEST(Plane, SameInputSameMesh) {
  const PlanarGraph graph = shapes::archipelago(300, 10, 5);
  const PlaneResult first = triangulate_polygon(graph);
  std::vector<PlaneResult> others(3);
  std::vector<std::thread> threads;  // reentrant
  for (PlaneResult& other : others) {
    threads.emplace_back([&] { other = triangulate_polygon(graph); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const PlaneResult& other : others) {
    EXPECT_EQ(first.mesh.triangles, other.mesh.triangles);
    EXPECT_EQ(first.mesh.vertices, other.mesh.vertices);
  }
}

TEST(Plane, OrderAndDirectionOfSegmentsDoNotMatter) {
  PlanarGraph graph = shapes::figure();
  const PlaneResult first = triangulate_polygon(graph);
  std::reverse(graph.segments.begin(), graph.segments.end());
  for (std::size_t i = 0; i < graph.segments.size(); i += 2) {
    std::swap(graph.segments[i][0], graph.segments[i][1]);
  }
  const PlaneResult second = triangulate_polygon(graph);
  // The order in which encroached segments are split may differ, the quality may not.
  EXPECT_NEAR(static_cast<double>(first.mesh.triangles.size()),
              static_cast<double>(second.mesh.triangles.size()),
              0.2 * static_cast<double>(first.mesh.triangles.size()));
  PlanarGraph turned = graph;
  for (auto& p : turned.vertices) p = {-p[1], p[0]};  // exact: a quarter turn
  PlaneOptions options = exact_options();
  expect_verified(turned, options);
}

TEST(Plane, SplittingASegmentByHandKeepsTheArea) {
  PlanarGraph graph = shapes::star(6, 0.4);
  const auto area = [](const PlaneMesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
      sum += (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    }
    return sum / 2;
  };
  const double before = area(triangulate_polygon(graph).mesh);
  const auto [a, b] = graph.segments[0];
  graph.vertices.push_back({(graph.vertices[a][0] + graph.vertices[b][0]) / 2,
                            (graph.vertices[a][1] + graph.vertices[b][1]) / 2});
  const auto m = static_cast<std::uint32_t>(graph.vertices.size() - 1);
  graph.segments[0] = {a, m};
  graph.segments.push_back({m, b});
  EXPECT_NEAR(before, area(expect_verified(graph).mesh), 1e-12);
}

// Every segment in so many pieces, collinear except for the rounding of their ends.
PlanarGraph in_pieces(const PlanarGraph& graph, int count) {
  PlanarGraph result;
  result.vertices = graph.vertices;
  for (const auto& [a, b] : graph.segments) {
    std::uint32_t last = a;
    for (int i = 1; i < count; ++i) {
      const auto next = static_cast<std::uint32_t>(result.vertices.size());
      const double t = static_cast<double>(i) / count;
      const auto &p = graph.vertices[a], &q = graph.vertices[b];
      result.vertices.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
      result.segments.push_back({last, next});
      last = next;
    }
    result.segments.push_back({last, b});
  }
  return result;
}

// In the plane noise costs nothing, because the ends of a piece are vertices in any case, and the
// angle between two is near 180 degrees.
TEST(Plane, RotatedAndRoundedAGraphCostsNoMore) {
  const auto single = [](double x) {
    const double large = std::ldexp(x < 0 ? -1.5 : 1.5, std::ilogb(x) + 29);
    return (x + large) - large;
  };
  const auto six_digits = [](double x) { return std::round(x * 1e6) / 1e6; };
  for (const PlanarGraph& part :
       {shapes::star(7, 0.2), shapes::comb(6, 0.1), shapes::figure(), shapes::nested_squares(5)}) {
    const PlanarGraph given = in_pieces(part, 7);
    const auto straight = static_cast<double>(expect_verified(given).mesh.triangles.size());
    for (int rounding = 0; rounding < 3; ++rounding) {
      PlanarGraph turned = shapes::moved(given, 0.3, 1, 0, 0);
      for (auto& p : turned.vertices) {
        for (double& x : p) x = rounding == 0 ? x : rounding == 1 ? single(x) : six_digits(x);
      }
      const PlaneResult result = expect_verified(turned);
      EXPECT_NEAR(static_cast<double>(result.mesh.triangles.size()), straight, 0.1 * straight);
      EXPECT_GE(result.statistics.refined.min_angle, PlaneOptions().delta);
    }
  }
}

// --- what is inside

TEST(Plane, HolesAndRegions) {
  PlanarGraph graph = shapes::nested_squares(3);
  graph.insideness = Insideness::enclosed;
  graph.holes = {{0, 0.6}};  // between the second and the third
  graph.regions = {{{0, 0}, 7}, {{0, 0.9}, 3}};
  const PlaneResult result = expect_verified(graph);
  ASSERT_EQ(result.mesh.attributes.size(), result.mesh.triangles.size());
  std::array<int, 8> count{};
  for (const double a : result.mesh.attributes) ++count[static_cast<std::size_t>(a)];
  EXPECT_GT(count[7], 0);
  EXPECT_GT(count[3], 0);
  EXPECT_EQ(count[0], 0);
  graph.holes = {{5, 5}, {0, 0.6}};
  const PlaneResult odd = triangulate_polygon(graph);
  ASSERT_EQ(odd.warnings.size(), 1U);
  EXPECT_EQ(odd.warnings[0], "hole 0 ignored: it is not inside (numbered from 0)");
  graph.holes = {{1, 1}, {0.5, 1}};  // a corner, a side
  graph.regions.clear();
  const PlaneResult on = expect_verified(graph);
  ASSERT_EQ(on.warnings.size(), 2U);
  EXPECT_EQ(on.warnings[1], "hole 1 ignored: it is on a segment (numbered from 0)");
}

TEST(Plane, BordersDivide) {
  // Two squares side by side, given as rings: the common edge divides.
  PlanarGraph graph;
  graph.insideness = Insideness::nested;
  graph.vertices = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}};
  graph.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 0}, {1, 4}};
  graph.partitions = {0, 0, 0, 0, 0, 0, 1};
  graph.markers = {1, 1, 1, 1, 1, 1, 9};
  const PlaneResult result = expect_verified(graph);
  EXPECT_EQ(std::count(result.mesh.edge_markers.begin(), result.mesh.edge_markers.end(), 9), 1);
}

// --- invalid and odd input

TEST(Plane, RefusesAndSaysWhy) {
  PlanarGraph graph = shapes::square();
  graph.segments.push_back({0, 2});
  graph.segments.push_back({1, 3});
  EXPECT_NE(refusal(graph).find("segments 4 and 5 cross"), std::string::npos);
  graph = shapes::square();
  graph.vertices.push_back({1, 1});
  EXPECT_NE(refusal(graph).find("vertices 2 and 4 coincide"), std::string::npos);
  graph = shapes::square();
  graph.vertices[1][0] = NAN;
  EXPECT_NE(refusal(graph).find("vertex 1 is not finite"), std::string::npos);
  graph = shapes::square();
  graph.segments[2] = {1, 9};
  EXPECT_NE(refusal(graph).find("segment 2 has the vertex 9 of 4"), std::string::npos);
  graph.segments[2] = {3, 3};
  EXPECT_NE(refusal(graph).find("begins and ends at vertex 3"), std::string::npos);
  graph = shapes::square();
  graph.vertices.push_back({2, 0});
  graph.segments.push_back({0, 4});
  EXPECT_NE(refusal(graph).find("segments 0 and 4 overlap"), std::string::npos);
  EXPECT_NE(refusal({}).find("no segments"), std::string::npos);
  graph = shapes::square();
  graph.segments.pop_back();
  EXPECT_NE(refusal(graph).find("enclose nothing"), std::string::npos);
  graph = shapes::square();
  graph.markers = {1};
  EXPECT_NE(refusal(graph).find("markers"), std::string::npos);
  graph = shapes::square();
  graph.vertices[0] = {-5e-324, 0};
  graph.vertices[2] = {1e300, 1e300};
  EXPECT_NE(refusal(graph).find("orders of magnitude"), std::string::npos);
}

// Spokes from one place, as far from each other there as rounding moved them: none of the wedges
// between them has a narrow part, but they are wedges over twelve orders of magnitude.
PlanarGraph spokes_without_hub(int n, double step) {
  PlanarGraph graph = shapes::polygon({{-2, -2}, {2, -2}, {2, 2}, {-2, 2}});
  for (int i = 0; i < n; ++i) {
    const double angle = 0.1 + step * i;
    const auto first = static_cast<std::uint32_t>(graph.vertices.size());
    graph.vertices.push_back({-1e-12 * i * std::sin(0.1), 1e-12 * i * std::cos(0.1)});
    graph.vertices.push_back({std::cos(angle), std::sin(angle)});
    graph.segments.push_back({first, first + 1});
  }
  return graph;
}

TEST(Plane, WedgesWithoutACornerAreBounded) {
  double predicted = 0;
  PlaneOptions options = exact_options();
  options.progress = [&](const Progress& progress) {
    predicted = progress.predicted_tetrahedra;
    return true;
  };
  const PlaneResult wide = expect_verified(spokes_without_hub(4, 3e-2), options);
  const auto triangles = static_cast<double>(wide.mesh.triangles.size());
  EXPECT_EQ(wide.statistics.dropped_segments, 0U);
  EXPECT_GT(triangles, predicted / 1.5);
  EXPECT_LT(triangles, predicted * 1.5);
  // Twenty thousand triangles would go between the two.
  const PlaneResult narrow = expect_verified(spokes_without_hub(2, 1e-3));
  EXPECT_EQ(narrow.statistics.dropped_segments, 1U);
  EXPECT_LT(narrow.mesh.triangles.size(), 200U);
  ASSERT_EQ(narrow.warnings.size(), 1U);
  EXPECT_NE(narrow.warnings[0].find("too narrow"), std::string::npos);
}

// Every wedge of this fan is wide enough to be refined, and has hundreds of triangles; there are
// thousands. So many are refused before the work, unless somebody says how many there may be.
TEST(Plane, ManyWedgesTogetherAreBoundedByDefault) {
  PlanarGraph graph = shapes::polygon({{-2, -2}, {2, -2}, {2, 2}, {-2, 2}});
  constexpr int kSpokes = 6000;
  const auto hub = static_cast<std::uint32_t>(graph.vertices.size());
  graph.vertices.push_back({0, 0});
  for (int i = 0; i < kSpokes; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / kSpokes;
    graph.segments.push_back({hub, static_cast<std::uint32_t>(graph.vertices.size())});
    graph.vertices.push_back({std::cos(angle), std::sin(angle)});
  }
  Phase last = Phase::check;
  PlaneOptions options;
  options.progress = [&](const Progress& progress) {
    last = progress.phase;
    return true;
  };
  const PlaneResult bounded = triangulate_polygon(graph, options);
  EXPECT_EQ(bounded.status.code, StatusCode::limit_reached);
  EXPECT_EQ(bounded.status.limit, Limit::size);
  EXPECT_EQ(last, Phase::chamfer);  // nothing was refined
  for (const char* word : {"million triangles", "--tau", "--max-vertices"}) {
    EXPECT_NE(bounded.status.message.find(word), std::string::npos) << word;
  }
  // The number that was allowed stops the refinement itself.
  options.max_vertices = 20'000;
  const PlaneResult allowed = triangulate_polygon(graph, options);
  EXPECT_EQ(allowed.status.limit, Limit::size);
  EXPECT_NE(last, Phase::chamfer);
  options.max_vertices = 0;
  options.tau = 3e-3;
  const PlaneResult fewer = triangulate_polygon(graph, options);
  EXPECT_TRUE(fewer.status.ok()) << fewer.status.message;
  EXPECT_LT(fewer.mesh.triangles.size(), 1'000'000U);
}

// --- what repair_graph() mends

// Segments between points of a grid cross, overlap, repeat each other, and some have no length; a
// third of the points are there twice.
PlanarGraph tangle(std::uint32_t seed, Insideness insideness) {
  std::mt19937 random(seed);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  PlanarGraph graph;
  graph.insideness = insideness;
  const std::uint32_t size = 4 + below(5), n = 6 + below(9);
  for (std::uint32_t v = 0; v < n; ++v) {
    const double x = below(size), y = below(size);
    graph.vertices.push_back({x / 3, y / 3});
  }
  for (std::uint32_t v = 0; v < n / 3; ++v) graph.vertices.push_back(graph.vertices[v]);
  for (std::uint32_t s = 0; s < 2 * n; ++s) {
    const auto m = static_cast<std::uint32_t>(graph.vertices.size());
    graph.segments.push_back({below(m), below(m)});
    graph.markers.push_back(static_cast<std::int32_t>(s));
  }
  // So that something is enclosed.
  const auto first = static_cast<std::uint32_t>(graph.vertices.size());
  graph.vertices.insert(graph.vertices.end(), {{-1, -1}, {5, -1}, {2, 7}});
  for (std::uint32_t k = 0; k < 3; ++k) {
    graph.segments.push_back({first + k, first + (k + 1) % 3});
    graph.markers.push_back(99);
  }
  return graph;
}

TEST(PlaneRepair, LeavesAGraphThatCanBeMeshed) {
  int bad = 0;
  for (int i = 0; i < iterations(40); ++i) {
    const auto seed = static_cast<std::uint32_t>(i);
    const PlanarGraph graph = tangle(seed, i % 2 == 0 ? Insideness::enclosed : Insideness::nested);
    const GraphReport before = check_graph(graph);
    EXPECT_EQ(before.status.ok(), triangulate_polygon(graph).status.ok()) << seed;
    bad += before.status.ok() ? 0 : 1;
    EXPECT_EQ(before.status.ok(), before.hints.empty()) << seed;
    const GraphRepairResult mended = repair_graph(graph);
    ASSERT_TRUE(mended.status.ok()) << seed << ": " << mended.status.message;
    EXPECT_FALSE(mended.done.empty()) << seed;
    const GraphReport after = check_graph(mended.graph);
    EXPECT_TRUE(after.status.ok()) << seed << ": " << after.status.message;
    expect_verified(mended.graph);
    EXPECT_TRUE(repair_graph(mended.graph).done.empty()) << seed;
    EXPECT_GE(std::ranges::count(mended.graph.markers, 99), 3) << seed;
  }
  EXPECT_GT(bad, 20);
}

TEST(PlaneRepair, MakesWhatTheDefectsSay) {
  PlanarGraph graph = shapes::square();  // from (0, 0) to (1, 1)
  const std::uint32_t n = 4;
  graph.vertices.insert(graph.vertices.end(), {{1, 1}, {2, 0}, {1e-3, 0}});
  graph.segments.insert(graph.segments.end(), {{0, 2}, {1, 3}, {2, n}, {0, n + 1}, {0, 1}});
  const GraphReport report = check_graph(graph);
  EXPECT_FALSE(report.status.ok());
  const auto count = [&](GraphDefect kind) {
    return report.places[static_cast<std::size_t>(kind)].size();
  };
  EXPECT_EQ(count(GraphDefect::equal_vertices), 1U);
  EXPECT_EQ(count(GraphDefect::no_length), 1U);
  EXPECT_EQ(count(GraphDefect::overlap), 2U);  // of (0, 0) to (2, 0) with both of (0, 0) to (1, 0)
  EXPECT_EQ(count(GraphDefect::crossing), 1U);
  const GraphRepairResult mended = repair_graph(graph);
  // The middle, and the square's corners, (2, 0), (1e-3, 0).
  EXPECT_EQ(mended.graph.vertices.size(), 7U);
  EXPECT_EQ(mended.graph.vertices.back(), (std::array<double, 2>{0.5, 0.5}));
  EXPECT_DOUBLE_EQ(check_graph(mended.graph).area, 1);
  const GraphRepairResult welded = repair_graph(graph, 0.01);
  EXPECT_EQ(welded.graph.vertices.size(), 6U);
  EXPECT_EQ(repair_graph(graph, NAN).status.code, StatusCode::invalid_options);
  graph.segments[0] = {0, 99};
  EXPECT_EQ(repair_graph(graph).status.code, StatusCode::invalid_surface);
  EXPECT_EQ(check_graph(graph).status.code, StatusCode::invalid_surface);
}

TEST(Plane, HugeCoordinates) {
  // The rectangle around the graph is half as large again. That it may be beyond the largest double
  // is no matter, unless the rectangle is asked for, as it is in a record.
  for (const double size : {0.7e308, 1.5e308}) {
    const PlanarGraph graph = shapes::polygon({{0, 0}, {size, 0}, {0, size}});
    const PlaneResult inside = triangulate_polygon(graph);
    EXPECT_TRUE(inside.status.ok()) << inside.status.message;
    EXPECT_FALSE(inside.mesh.triangles.empty());
    for (const Region region : {Region::interior, Region::hull}) {
      PlaneOptions options = exact_options();
      options.region = region;
      if (size > DBL_MAX / 1.5) {
        EXPECT_NE(refusal(graph, options).find("beyond the largest double"), std::string::npos);
      } else {
        expect_verified(graph, options);
      }
    }
  }
}

TEST(Plane, AcceptsAndWarns) {
  PlanarGraph graph = shapes::square();
  graph.vertices.push_back({0.5, 0});  // on segment 0
  graph.segments.push_back({4, 2});
  PlaneResult result = expect_verified(graph);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_NE(result.warnings[0].find("1 segments split"), std::string::npos);
  graph = shapes::square();
  graph.segments.push_back({2, 1});
  result = expect_verified(graph);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_NE(result.warnings[0].find("more than once"), std::string::npos);
  graph = shapes::square();
  graph.vertices.push_back({0.3, 0.4});  // a lone vertex is a vertex of the mesh
  result = expect_verified(graph);
  EXPECT_NE(std::find(result.mesh.vertices.begin(), result.mesh.vertices.end(),
                      std::array<double, 2>{0.3, 0.4}),
            result.mesh.vertices.end());
}

TEST(Plane, NoRoomBetweenDoubles) {
  // Three vertices within a few units in the last place, and a segment as close to a side.
  PlanarGraph graph = shapes::square();
  graph.insideness = Insideness::enclosed;
  const double x = 0.7, up = std::nextafter(x, 1);
  graph.vertices.insert(
      graph.vertices.end(),
      {{x, x}, {up, x}, {x, up}, {0.2, 0.3}, {0.1, 1 - 0x1p-53}, {0.9, 1 - 0x1p-52}});
  graph.segments.push_back({7, 4});
  graph.segments.push_back({8, 9});
  const PlaneResult result = expect_verified(graph);
  EXPECT_GT(result.statistics.dropped_segments, 0U);
}

TEST(Plane, ExtremeScales) {
  // Squares and fourth powers of the small lengths vanish beside the large ones. Good triangles
  // must not be taken for bad, or the refinement does not end.
  PlaneOptions options = exact_options();
  options.max_vertices = 50000;
  const double up = std::nextafter(6.0, 7.0);
  expect_verified(shapes::polygon({{1e151, -2.7e28}, {6, 6}, {up, up}}), options);
  for (const double size : {1e-70, 1e-130, 1e-250}) {
    PlanarGraph graph = shapes::square();  // with a small one in a corner, cut out
    const double a = size, b = 2 * size;
    graph.insideness = Insideness::nested;
    graph.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {a, a}, {b, a}, {b, b}, {a, b}};
    graph.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}};
    const PlaneResult result = expect_verified(graph, options);
    EXPECT_EQ(result.statistics.dropped_segments, 0U) << size;
    EXPECT_GE(result.statistics.refined.min_angle, 20.7) << size;
  }
}

// The oracle's doubles: squares of these lengths vanish where it measures channels.
TEST(Plane, ReasonsOfDropsAtAllScales) {
  const auto needle = shapes::polygon({{0, 0}, {0.33, 0}, {0.08, -0x1p-30}});
  for (const int k : {0, -300, -528, -700, -850, 500}) {
    PlanarGraph graph = needle;
    graph.vertices = scaled(graph.vertices, k);
    EXPECT_GT(expect_verified(graph).statistics.dropped_segments, 0U) << k;
  }
}

TEST(Plane, SubnormalSizes) {
  // Below the normal doubles there is less and less room for points, in the end none.
  int refused = 0, dropped = 0;
  for (const Region region : {Region::interior, Region::hull}) {
    for (const int k : {-1074, -1070, -1050, -1045, -1043, -1038, -1028, -1020, -1000, -960}) {
      PlanarGraph graph = shapes::square();
      graph.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.25, 0.5}, {0.25 + 0x1p-16, 0.5}};
      graph.segments.push_back({4, 5});
      graph.segments.push_back({0, 4});
      if (k < -1072) graph = shapes::polygon({{0, 0}, {1, 0}, {0, 1}});
      graph.vertices = scaled(graph.vertices, k);
      PlaneOptions options = exact_options();
      options.region = region;
      const PlaneResult result = triangulate_polygon(graph, options);
      EXPECT_EQ(result.status.ok(), k > -1044) << k << " " << result.status.message;
      if (!result.status.ok()) {
        EXPECT_EQ(result.status.code, StatusCode::invalid_surface);
        EXPECT_NE(result.status.message.find("extent"), std::string::npos);
        ++refused;
        continue;
      }
      const tetproof::PlaneVerdict verdict = tetproof::verify_plane(graph, options, result);
      EXPECT_TRUE(verdict.ok()) << k << " " << verdict.text();
      dropped += result.statistics.dropped_segments > 0;
    }
  }
  EXPECT_EQ(refused, 8);
  EXPECT_GT(dropped, 0);
}

// Half of the extent, added to a coordinate, may be rounded to the coordinate itself.
TEST(Plane, TheOuterBoxIsBeyondAGraphOfAnUlp) {
  constexpr double kUlp = 0x1p-53;  // below 1
  for (const double sign : {1.0, -1.0}) {
    PlanarGraph graph;
    graph.vertices = {{sign, sign}, {sign, sign * (1 - kUlp)}, {sign * (1 - kUlp), sign}};
    graph.segments = {{0, 1}, {1, 2}, {2, 0}};
    const PlaneResult result = triangulate_polygon(graph);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.mesh.triangles.size(), 1U);
  }
}

// The triangle that is refined has no double inside, and one side on a segment that was dropped.
TEST(Plane, WhatIsAsSmallAsAnUlpHasASide) {
  PlanarGraph graph;
  graph.vertices = {{1, 1}, {1, 1 - 0x1p-53}, {1 - 0x1p-53, 1}};
  graph.segments = {{0, 1}, {1, 2}, {2, 0}};
  const PlaneResult result = expect_verified(graph);
  EXPECT_EQ(result.exact.dropped.size(), 1U);
  const auto inside = [](const PlaneRecord::Triangle& triangle) {
    return triangle.side == PlaneRecord::Side::inside;
  };
  EXPECT_EQ(std::ranges::count_if(result.exact.refined, inside), 1);
}

TEST(Plane, LimitsAndOptions) {
  PlaneOptions options;
  options.max_vertices = 3;
  EXPECT_EQ(triangulate_polygon(shapes::square(), options).status.code, StatusCode::limit_reached);
  options.max_vertices = 4;
  EXPECT_TRUE(triangulate_polygon(shapes::square(), options).status.ok());
  options.max_vertices = 50;
  EXPECT_EQ(triangulate_polygon(shapes::koch(4), options).status.code, StatusCode::limit_reached);
  options = {};
  options.time_limit_seconds = 1e-9;
  EXPECT_EQ(triangulate_polygon(shapes::koch(4), options).status.code, StatusCode::limit_reached);
  options = {};
  options.progress = [](const Progress&) { return false; };
  EXPECT_EQ(triangulate_polygon(shapes::koch(4), options).status.code, StatusCode::interrupted);
  options = {};
  options.acute = 45;
  EXPECT_EQ(triangulate_polygon(shapes::square(), options).status.code,
            StatusCode::invalid_options);
  options.acute = 60;
  options.delta = 40;
  EXPECT_EQ(triangulate_polygon(shapes::square(), options).status.code,
            StatusCode::invalid_options);
}

// --- the oracles themselves notice what is wrong

TEST(PlaneOracle, NoticesWhatIsWrong) {
  const PlanarGraph graph = shapes::figure();
  const PlaneOptions options = exact_options();
  const PlaneResult good = triangulate_polygon(graph, options);
  ASSERT_TRUE(tetproof::verify_plane(graph, options, good).ok());
  const auto noticed = [&](const char* kind, const std::function<void(PlaneResult&)>& spoil) {
    PlaneResult bad = good;
    spoil(bad);
    const std::string text = tetproof::verify_plane(graph, options, bad).text();
    EXPECT_NE(text.find(kind), std::string::npos) << kind << " in: " << text;
  };
  noticed("sidecar", [](PlaneResult& r) { r.exact.points[0].x += 1e-9; });
  noticed("exact-orientation", [](PlaneResult& r) {
    std::swap(r.exact.final[5].vertices[0], r.exact.final[5].vertices[1]);
  });
  noticed("refined-complex", [](PlaneResult& r) { r.exact.refined.pop_back(); });
  noticed("exact-conformity",
          [](PlaneResult& r) { r.exact.final_edges.erase(r.exact.final_edges.begin()); });
  noticed("refined-angles", [](PlaneResult& r) { r.exact.delta = 33; });
  for (const auto side : {PlaneRecord::Side::inside, PlaneRecord::Side::outside}) {
    noticed("exact-sides", [side](PlaneResult& r) {
      auto& final = r.exact.final;
      std::find_if(final.begin(), final.end(), [&](const auto& t) {
        return t.side == side;
      })->side = PlaneRecord::Side::mixed;
    });
  }
  noticed("refined-sides", [](PlaneResult& r) {
    for (auto& t : r.exact.refined) t.side = PlaneRecord::Side::inside;
  });
  noticed("refined-chamfer-distance", [](PlaneResult& r) { r.exact.corners[0].distance *= 2; });
  noticed("rounding", [](PlaneResult& r) { r.mesh.vertices[3][0] += 1e-9; });
  noticed("same-mesh", [](PlaneResult& r) { r.mesh.triangles.pop_back(); });
  noticed("promise", [](PlaneResult& r) { r.exact.acute = 1; });
  noticed("orientation: triangle 0 is inverted",
          [](PlaneResult& r) {  // confessed, and refused all the same
            std::swap(r.mesh.triangles[0][0], r.mesh.triangles[0][1]);
            r.statistics.rounding_inverted = 1;
          });
}

TEST(PlaneOracle, NoticesAnEdgeThatIsNotDelaunay) {
  // A flip of an edge of the refined mesh leaves all but this right.
  const PlanarGraph graph = shapes::square();
  PlaneOptions options = exact_options();
  options.max_edge = 0.3;
  PlaneResult result = triangulate_polygon(graph, options);
  auto& triangles = result.exact.refined;
  bool flipped = false;
  for (std::size_t i = 0; i < triangles.size() && !flipped; ++i) {
    for (std::size_t j = 0; j < i && !flipped; ++j) {
      std::vector<std::uint32_t> common, apex;
      for (const auto v : triangles[i].vertices) {
        const auto& w = triangles[j].vertices;
        (std::find(w.begin(), w.end(), v) != w.end() ? common : apex).push_back(v);
      }
      if (common.size() != 2 || triangles[i].side != PlaneRecord::Side::inside) continue;
      for (const auto v : triangles[j].vertices) {
        if (std::find(common.begin(), common.end(), v) == common.end()) apex.push_back(v);
      }
      const auto set = [&](std::size_t k, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto &p = result.exact.points[a], &q = result.exact.points[b],
                   &r = result.exact.points[c];
        const double area = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
        if (area > 0) triangles[k].vertices = {a, b, c};
        if (area < 0) triangles[k].vertices = {a, c, b};
      };
      const auto before = triangles;
      set(i, apex[0], apex[1], common[0]);
      set(j, apex[0], apex[1], common[1]);
      const std::string text = tetproof::verify_plane(graph, options, result).text();
      flipped = text.find("refined-delaunay") != std::string::npos;
      if (!flipped) triangles = before;
    }
  }
  EXPECT_TRUE(flipped);
}

}  // namespace
