#include "mesher/surface/validity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "mesher/surface/nesting.h"
#include "mesher/surface/test_surfaces.h"

namespace delmesher::surface {
namespace {

using namespace test_surfaces;
using Kind = Defect::Kind;

ValidityResult check(const Surface& s, bool stop_at_first = false) {
  const Limits options;
  Control control(options);
  return check_validity(s, stop_at_first, control);
}

std::uint64_t count(const ValidityResult& r, Kind kind) {
  return r.report.defect_counts[static_cast<std::size_t>(kind)];
}

std::uint64_t total(const ValidityResult& r) {
  std::uint64_t sum = 0;
  for (const std::uint64_t n : r.report.defect_counts) sum += n;
  return sum;
}

void expect_only(const Surface& s, Kind kind, std::uint64_t n) {
  const ValidityResult r = check(s);
  EXPECT_EQ(r.report.status.code, StatusCode::invalid_surface);
  EXPECT_EQ(count(r, kind), n) << r.report.status.message;
  EXPECT_EQ(total(r), n) << r.report.status.message;
  const ValidityResult first = check(s, true);
  EXPECT_EQ(first.report.status.code, StatusCode::invalid_surface);
  ASSERT_FALSE(first.report.defects.empty());
  EXPECT_EQ(first.report.defects[0].kind, kind);
}

void expect_valid(const Surface& s) {
  const ValidityResult r = check(s);
  EXPECT_TRUE(r.report.status.ok()) << r.report.status.message;
  EXPECT_EQ(total(r), 0U);
  EXPECT_TRUE(r.report.warnings.empty());
}

const Point kOrigin{0, 0, 0};

TEST(Validity, Box) {
  const ValidityResult r = check(box(kOrigin, {1, 2, 4}, 3));
  EXPECT_TRUE(r.report.status.ok());
  EXPECT_EQ(r.report.components, 1U);
  EXPECT_EQ(r.report.euler_characteristic, 2);
  EXPECT_NEAR(r.report.volume, 8, 1e-14);
  EXPECT_DOUBLE_EQ(r.report.bbox_diagonal, std::sqrt(21.0));
  EXPECT_FALSE(r.report.flipped);
}

TEST(Validity, AsManyLabelsAsTrianglesOrNone) {
  Surface s = box({0, 0, 0}, {1, 1, 1});
  s.labels.assign(s.triangles.size(), 7);
  EXPECT_TRUE(check(s).report.status.ok());
  for (const std::size_t labels :
       {std::size_t{1}, s.triangles.size() - 1, s.triangles.size() + 1}) {
    s.labels.assign(labels, 7);
    for (const bool stop_at_first : {false, true}) {
      const Status status = check(s, stop_at_first).report.status;
      EXPECT_EQ(status.code, StatusCode::invalid_surface);
      EXPECT_EQ(status.message,
                std::to_string(labels) + " labels for 12 triangles: as many are needed, or none");
    }
  }
}

TEST(Validity, InsideOut) {
  const Surface s = reversed(tetrahedron(kOrigin, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
  const ValidityResult r = check(s);
  EXPECT_TRUE(r.report.status.ok());
  EXPECT_TRUE(r.report.flipped);
  EXPECT_EQ(r.report.warnings.size(), 1U);
  EXPECT_NEAR(r.report.volume, 1.0 / 6, 1e-16);
  expect_valid(oriented_outwards(s, r));
}

TEST(Validity, ParityOrientsNestedComponents) {
  const Surface outer = box(kOrigin, {8, 8, 8}), hole = box({1, 1, 1}, {7, 7, 7}),
                island = box({2, 2, 2}, {3, 3, 3}), beside = box({9, 0, 0}, {10, 8, 8});
  Surface good = joined(joined(joined(outer, reversed(hole)), island), beside);
  expect_valid(good);
  EXPECT_NEAR(check(good).report.volume, 512 - 216 + 1 + 64, 1e-12);
  EXPECT_EQ(check(good).report.components, 4U);
  const Surface bad = joined(joined(joined(outer, hole), island), reversed(beside));
  const ValidityResult r = check(bad);
  EXPECT_TRUE(r.report.status.ok());
  EXPECT_FALSE(r.report.flipped);
  EXPECT_EQ(r.report.warnings.size(), 2U);
  EXPECT_NEAR(r.report.volume, 512 - 216 + 1 + 64, 1e-12);
  EXPECT_EQ(oriented_outwards(bad, r).triangles.size(), good.triangles.size());
  expect_valid(oriented_outwards(bad, r));
  EXPECT_TRUE(check(reversed(good)).report.flipped);
}

// The sign of a volume that cancels almost completely must be decided exactly.
TEST(Validity, VolumeFarBelowRounding) {
  const Surface thin =
      tetrahedron({0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0.3, 0.3, std::nextafter(1.0, 2.0)});
  EXPECT_FALSE(check(thin).report.flipped);
  EXPECT_TRUE(check(reversed(thin)).report.flipped);
  for (const double scale : {0x1p-1000, 0x1p-350, 0x1p350, 0x1p1020}) {
    EXPECT_FALSE(check(scaled(thin, scale)).report.flipped) << scale;
    EXPECT_TRUE(check(scaled(reversed(thin), scale)).report.flipped) << scale;
  }
}

// Corners in a plane up to rounding: the volume of doubles is noise, the sign must still be right.
TEST(Validity, VolumeSignIsExact) {
  std::mt19937_64 random(17);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::array<int, 2> seen{};
  for (int round = 0; round < 200; ++round) {
    Surface s = tetrahedron({unit(), unit(), unit()}, {unit(), unit(), unit()},
                            {unit(), unit(), unit()}, kOrigin);
    const double u = unit() / 2, v = unit() / 2;
    for (std::size_t i = 0; i < 3; ++i) {
      s.vertices[3][i] =
          u * s.vertices[0][i] + v * s.vertices[1][i] + (1 - u - v) * s.vertices[2][i];
    }
    PointStore points;
    Predicates predicates(points);
    for (const Point& p : s.vertices) points.add_explicit(p[0], p[1], p[2]);
    const int o = predicates.orient3d(0, 1, 2, 3);
    if (o == 0) continue;
    ++seen[o > 0];
    EXPECT_EQ(check(s).report.flipped, o < 0) << round;
  }
  EXPECT_GT(seen[0], 50);
  EXPECT_GT(seen[1], 50);
}

TEST(Validity, UnreadableNumbersAndIndices) {
  Surface s = box(kOrigin, {1, 1, 1});
  s.vertices[3][1] = std::numeric_limits<double>::quiet_NaN();
  s.vertices[5][2] = -std::numeric_limits<double>::infinity();
  expect_only(s, Kind::non_finite, 2);
  s = box(kOrigin, {1, 1, 1});
  s.triangles[4][2] = 8;
  expect_only(s, Kind::index_out_of_range, 1);
  expect_only({}, Kind::empty, 1);
}

TEST(Validity, UnusedVerticesAreFine) {
  Surface s = box(kOrigin, {1, 1, 1});
  s.vertices.push_back({0, 0, 0});
  expect_valid(s);
  EXPECT_EQ(check(s).report.unused_vertices, 1U);
  EXPECT_EQ(check(s).report.euler_characteristic, 2);
}

TEST(Validity, DegenerateTriangles) {
  Surface s = box(kOrigin, {1, 1, 1});
  s.triangles.push_back({0, 0, 1});
  EXPECT_EQ(count(check(s), Kind::degenerate_triangle), 1U);
  EXPECT_EQ(count(check(s), Kind::self_intersection), 0U);
  // Split an edge at a vertex on it, on one side only, and close the gap with a flat triangle. The
  // neighbour across the edge then touches both halves.
  Surface flat = box(kOrigin, {1, 1, 1});
  const auto [a, b, c] = flat.triangles[0];
  Point middle;
  for (std::size_t i = 0; i < 3; ++i) middle[i] = (flat.vertices[a][i] + flat.vertices[b][i]) / 2;
  flat.vertices.push_back(middle);
  flat.triangles[0] = {a, 8, c};
  flat.triangles.push_back({8, b, c});
  flat.triangles.push_back({a, b, 8});
  EXPECT_EQ(count(check(flat), Kind::degenerate_triangle), 1U);
  EXPECT_EQ(count(check(flat), Kind::self_intersection), 2U);
  EXPECT_EQ(total(check(flat)), 3U);
}

TEST(Validity, OpenEdges) {
  Surface s = box(kOrigin, {1, 1, 1});
  s.triangles.pop_back();
  expect_only(s, Kind::open_edge, 3);
}

TEST(Validity, InconsistentOrientation) {
  Surface s = box(kOrigin, {1, 1, 1});
  std::swap(s.triangles[7][0], s.triangles[7][1]);
  expect_only(s, Kind::inconsistent_orientation, 3);
}

TEST(Validity, DuplicateTriangle) {
  Surface s = box(kOrigin, {1, 1, 1});
  s.triangles.push_back(s.triangles[3]);
  const ValidityResult r = check(s);
  EXPECT_EQ(count(r, Kind::duplicate_triangle), 1U);
  EXPECT_EQ(count(r, Kind::non_manifold_edge), 3U);
  EXPECT_EQ(r.report.defects[0].triangles, (std::vector<std::uint32_t>{3, 12}));
}

TEST(Validity, BoxesTouching) {
  const Surface cube = box(kOrigin, {1, 1, 1});
  const auto with = [&](const Point& lo, const Point& hi) { return joined(cube, box(lo, hi)); };
  // Merged: a pinched vertex, an edge of four triangles.
  expect_only(welded(with({1, 1, 1}, {2, 2, 2})), Kind::non_manifold_vertex, 1);
  expect_only(welded(with({1, 1, 0}, {2, 2, 1})), Kind::non_manifold_edge, 1);
  // Not merged: the same contacts are intersections.
  for (const Surface& s : {with({1, 1, 1}, {2, 2, 2}), with({1, 1, 0}, {2, 2, 1}),
                           with({1, 0, 0}, {2, 1, 1}), with({1, 0.25, 0.25}, {2, 0.75, 0.75}),
                           with({0.5, 0.5, 0.5}, {2, 2, 2}), with({1, 1, 0.5}, {2, 2, 0.75})}) {
    const ValidityResult r = check(s);
    EXPECT_GT(count(r, Kind::self_intersection), 0U);
    EXPECT_EQ(total(r), count(r, Kind::self_intersection));
  }
}

TEST(Validity, PlatesAnUlpApart) {
  const Surface plate = box({0.25, 0.25, 0.1}, {0.75, 0.75, 0.7}, 3);
  const double above = std::nextafter(0.7, 1.0);
  expect_valid(joined(plate, box({0, 0, above}, {1, 1, 1}, 2)));
  EXPECT_FALSE(check(joined(plate, box({0, 0, 0.7}, {1, 1, 1}, 2))).report.status.ok());
  EXPECT_FALSE(
      check(joined(plate, box({0, 0, std::nextafter(0.7, 0.0)}, {1, 1, 1}, 2))).report.status.ok());
}

// A pyramid whose base is cut along both diagonals' halves so that one base triangle folds back.
TEST(Validity, CoplanarFoldAtAnEdge) {
  Surface s = tetrahedron(kOrigin, {4, 0, 0}, {0, 4, 0}, {0, 0, 4});
  // Insert a vertex into the base (triangle {0, 2, 1}); inside it is fine, outside it folds.
  const auto split = [&](const Point& p) {
    Surface t = s;
    t.vertices.push_back(p);
    t.triangles[3] = {0, 2, 4};
    t.triangles.push_back({2, 1, 4});
    t.triangles.push_back({1, 0, 4});
    return t;
  };
  expect_valid(split({1, 1, 0}));
  const ValidityResult folded = check(split({3, 3, 0}));
  EXPECT_GE(count(folded, Kind::self_intersection), 2U);
  EXPECT_EQ(total(folded), count(folded, Kind::self_intersection));
  // Exactly on the edge 1-2: the flat triangle is degenerate.
  EXPECT_EQ(count(check(split({2, 2, 0})), Kind::degenerate_triangle), 1U);
}

TEST(Validity, TriangleTouchedByAVertexOrAnEdge) {
  const Surface cube = box(kOrigin, {4, 4, 4});
  const auto spike = [&](double tip) {
    return joined(cube, tetrahedron({1, 2, tip}, {1, 2, 9}, {3, 2, 9}, {2, 3, 9}));
  };
  EXPECT_EQ(count(check(spike(4)), Kind::self_intersection), 3U);  // the three faces at the tip
  EXPECT_TRUE(check(spike(std::nextafter(4.0, 5.0))).report.components == 2);
  EXPECT_EQ(count(check(spike(std::nextafter(4.0, 5.0))), Kind::self_intersection), 0U);
  EXPECT_GT(count(check(spike(std::nextafter(4.0, 3.0))), Kind::self_intersection), 0U);
}

TEST(Validity, Moebius) {
  Surface s;
  constexpr std::uint32_t n = 12;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n, half = a / 2;
    for (const double w : {-0.3, 0.3}) {
      const double r = 1 + w * std::cos(half);
      s.vertices.push_back({r * std::cos(a), r * std::sin(a), w * std::sin(half)});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * i + 1;
    std::uint32_t c = 2 * ((i + 1) % n), d = c + 1;
    if (i + 1 == n) std::swap(c, d);
    s.triangles.push_back({a, c, b});
    s.triangles.push_back({b, c, d});
  }
  const ValidityResult r = check(s);
  EXPECT_EQ(count(r, Kind::open_edge), 2 * n);
  EXPECT_EQ(count(r, Kind::inconsistent_orientation), 1U);
  EXPECT_EQ(r.report.euler_characteristic, 0);
}

TEST(Validity, ListsAreShortButCountsComplete) {
  Surface s;
  for (int i = 0; i < 30; ++i) {
    s = joined(s,
               tetrahedron({i * 2.0, 0, 0}, {i * 2.0 + 1, 0, 0}, {i * 2.0, 1, 0}, {i * 2.0, 0, 1}));
    s.triangles.pop_back();
  }
  const ValidityResult r = check(s);
  EXPECT_EQ(count(r, Kind::open_edge), 90U);
  EXPECT_EQ(r.report.defects.size(), 10U);
  EXPECT_NE(r.report.status.message.find("edge"), std::string::npos);
}

// Strips across each other: every one of the one kind meets every one of the other.
Surface crossing_strips(std::uint32_t along_x, std::uint32_t along_y) {
  Surface s;
  const auto add = [&s](const Point& a, const Point& b, const Point& c) {
    const auto n = static_cast<std::uint32_t>(s.vertices.size());
    s.vertices.insert(s.vertices.end(), {a, b, c});
    s.triangles.push_back({n, n + 1, n + 2});
  };
  for (std::uint32_t i = 0; i < along_x; ++i) {
    add({-1, double(i), 0}, {1.0 * along_y, double(i), -1}, {1.0 * along_y, double(i), 1});
  }
  for (std::uint32_t j = 0; j < along_y; ++j) {
    add({double(j), -2, -100}, {double(j), along_x + 1.0, -100}, {double(j), along_x / 2.0, 1000});
  }
  return s;
}

TEST(Validity, ThePlacesOfAllDefectsAreKept) {
  const Surface s = crossing_strips(30, 40);
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::uint32_t t = 0; t < 30; ++t) {
    for (std::uint32_t u = 30; u < 70; ++u) pairs.push_back({t, u});
  }
  for (const unsigned threads : {1U, 3U}) {
    Limits options;
    options.threads = threads;
    Control control(options);
    const SurfaceReport report = check_validity(s, false, control).report;
    EXPECT_EQ(report.places[static_cast<std::size_t>(Kind::self_intersection)], pairs);
    EXPECT_EQ(report.defect_counts[static_cast<std::size_t>(Kind::self_intersection)], 1200U);
    EXPECT_EQ(report.places[static_cast<std::size_t>(Kind::open_edge)].size(), 210U);
    EXPECT_EQ(report.defects.size(), 20U);
    EXPECT_EQ(report.warnings.size(), 1U);  // of the volume
    const SurfaceReport few = check_validity(s, false, control, 1199).report;
    EXPECT_EQ(few.places[static_cast<std::size_t>(Kind::self_intersection)].size(), 1199U);
    EXPECT_EQ(few.defect_counts, report.defect_counts);
    ASSERT_EQ(few.warnings.size(), 2U);
    EXPECT_EQ(few.warnings[1],
              "1199 of 1200 places are kept for files of defects: self-intersection");
  }
}

// What the numbers of a place are, by kind.
TEST(Validity, PlacesNameVerticesEdgesAndTriangles) {
  Surface s = box(kOrigin, {1, 1, 1});
  const std::array<std::uint32_t, 3> last = s.triangles.back();
  s.triangles.push_back({0, 1, 1});
  s.triangles.push_back(s.triangles[4]);
  const auto places = [&s](Kind kind) {
    return check(s).report.places[static_cast<std::size_t>(kind)];
  };
  using Places = std::vector<std::array<std::uint32_t, 2>>;
  EXPECT_EQ(places(Kind::degenerate_triangle), (Places{{12, 12}}));
  EXPECT_EQ(places(Kind::duplicate_triangle), (Places{{4, 13}}));
  s.triangles.resize(11);
  Places edges = places(Kind::open_edge);
  ASSERT_EQ(edges.size(), 3U);
  for (auto& edge : edges) {
    for (const std::uint32_t v : edge)
      EXPECT_NE(std::find(last.begin(), last.end(), v), last.end());
  }
  s.triangles[3][1] = 77;
  EXPECT_EQ(places(Kind::index_out_of_range), (Places{{3, 3}}));
  s.triangles[3][1] = 7;
  s.vertices[5][0] = std::nan("");
  EXPECT_EQ(places(Kind::non_finite), (Places{{5, 5}}));
  EXPECT_EQ(places(Kind::empty), Places{});
  const Surface touching = joined(tetrahedron(kOrigin, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}),
                                  tetrahedron(kOrigin, {0, -1, 0}, {-1, 0, 0}, {0, 0, -1}));
  s = welded(touching);
  const auto origin = static_cast<std::uint32_t>(
      std::find(s.vertices.begin(), s.vertices.end(), kOrigin) - s.vertices.begin());
  EXPECT_EQ(places(Kind::non_manifold_vertex), (Places{{origin, origin}}));
}

TEST(Validity, Cancels) {
  Limits options;
  options.progress = [](const Progress&) { return false; };
  Control control(options);
  EXPECT_THROW(check_validity(box(kOrigin, {1, 1, 1}, 30), true, control), Stopped);
}

// Against brute force: small random closed surfaces on a grid, where contacts of every kind occur,
// must be judged alike when vertices, triangles and axes are permuted.
TEST(Validity, DoesNotDependOnNumberingOrAxes) {
  std::mt19937_64 random(5);
  int invalid = 0, valid = 0;
  for (int round = 0; round < 400; ++round) {
    const auto point = [&] {
      return Point{double(random() % 4), double(random() % 4), double(random() % 4)};
    };
    Surface s = joined(tetrahedron(point(), point(), point(), point()),
                       tetrahedron(point(), point(), point(), point()));
    if (random() % 2 == 0) s = welded(s);
    const ValidityResult expected = check(s);
    ++(expected.report.status.ok() ? valid : invalid);
    Surface t = s;
    std::vector<std::uint32_t> to(s.vertices.size());
    for (std::uint32_t i = 0; i < to.size(); ++i) to[i] = i;
    std::shuffle(to.begin(), to.end(), random);
    for (std::size_t i = 0; i < to.size(); ++i) {
      const Point& p = s.vertices[i];
      t.vertices[to[i]] = {p[1], -p[2], p[0]};
    }
    for (auto& x : t.triangles) x = {to[x[1]], to[x[2]], to[x[0]]};
    std::shuffle(t.triangles.begin(), t.triangles.end(), random);
    EXPECT_EQ(check(t).report.defect_counts, expected.report.defect_counts) << round;
  }
  EXPECT_GT(valid, 20);
  EXPECT_GT(invalid, 100);
}

}  // namespace
}  // namespace delmesher::surface
