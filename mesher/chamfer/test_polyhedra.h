// For tests: polyhedra with integer coordinates, so that their facets are exactly flat.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "mesher/delmesher/surface.h"

namespace delmesher::chamfer::test_polyhedra {

using Point2 = std::array<std::int64_t, 2>;
using Polygon = std::vector<Point2>;

struct Sample {
  std::string name;
  Surface surface;
};

inline std::int64_t turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Triangles of a polygon given as a counter-clockwise list of indices, in which indices may repeat
// (a hole joined to the outside by a double edge).
inline std::vector<std::array<std::uint32_t, 3>> triangulate(const Polygon& points,
                                                             std::vector<std::uint32_t> loop) {
  std::vector<std::array<std::uint32_t, 3>> result;
  while (loop.size() > 3) {
    const std::size_t before = loop.size();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::size_t n = loop.size();
      const std::uint32_t a = loop[(i + n - 1) % n], b = loop[i], c = loop[(i + 1) % n];
      if (turn(points[a], points[b], points[c]) <= 0) continue;
      bool empty = true;
      for (std::uint32_t p : loop) {
        if (p == a || p == b || p == c) continue;
        empty = empty && !(turn(points[a], points[b], points[p]) >= 0 &&
                           turn(points[b], points[c], points[p]) >= 0 &&
                           turn(points[c], points[a], points[p]) >= 0);
      }
      if (!empty) continue;
      result.push_back({a, b, c});
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    if (loop.size() == before) return {};
  }
  result.push_back({loop[0], loop[1], loop[2]});
  return result;
}

// `outer` counter-clockwise, `hole` clockwise or empty; their first vertices see each other.
inline Surface prism(const Polygon& outer, std::int64_t height, const Polygon& hole = {}) {
  Polygon points = outer;
  points.insert(points.end(), hole.begin(), hole.end());
  const auto n = static_cast<std::uint32_t>(points.size());
  const auto m = static_cast<std::uint32_t>(outer.size());
  std::vector<std::uint32_t> loop;
  for (std::uint32_t i = 0; i < n; ++i) loop.push_back(i);
  if (!hole.empty()) {
    loop.insert(loop.begin() + m, 0);
    loop.push_back(m);
  }
  Surface s;
  for (std::int64_t z : {std::int64_t{0}, height}) {
    for (const Point2& p : points) {
      s.vertices.push_back(
          {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(z)});
    }
  }
  for (const auto& t : triangulate(points, loop)) {
    s.triangles.push_back({t[0], t[2], t[1]});
    s.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = i + 1 == m ? 0 : i + 1 == n ? m : i + 1;
    const std::uint32_t k = hole.empty() && i + 1 == n ? 0 : j;
    s.triangles.push_back({i, k, k + n});
    s.triangles.push_back({i, k + n, i + n});
  }
  return s;
}

// A cone over a polygon.
inline Surface pyramid(const Polygon& base, const std::array<std::int64_t, 3>& apex) {
  Surface s;
  std::vector<std::uint32_t> loop;
  const auto n = static_cast<std::uint32_t>(base.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    s.vertices.push_back({static_cast<double>(base[i][0]), static_cast<double>(base[i][1]), 0});
    loop.push_back(i);
    s.triangles.push_back({i, (i + 1) % n, n});
  }
  s.vertices.push_back(
      {static_cast<double>(apex[0]), static_cast<double>(apex[1]), static_cast<double>(apex[2])});
  for (const auto& t : triangulate(base, loop)) s.triangles.push_back({t[0], t[2], t[1]});
  return s;
}

inline Surface tetrahedron(const std::array<std::array<std::int64_t, 3>, 4>& p) {
  Surface s;
  for (const auto& v : p) {
    s.vertices.push_back(
        {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
  }
  std::int64_t e[3][3];
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) e[k][i] = p[k + 1][i] - p[0][i];
  }
  const std::int64_t volume = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                              e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                              e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
  if (volume > 0) {
    s.triangles = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  } else if (volume < 0) {
    s.triangles = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  }
  return s;
}

// Figure 3 of the paper: a triangle split at an inner point, which is lifted a little. Closed to a
// solid by a vertex far below.
inline Surface spike(std::int64_t height) {
  Surface s;
  s.vertices = {{0, 0, 0},
                {1000, 0, 0},
                {900, 300, 0},
                {300, 50, static_cast<double>(height)},
                {600, 100, -800}};
  s.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}};
  return s;
}

// The image under an integer matrix of positive determinant: facets stay exactly flat.
inline Surface sheared(Surface s, const std::array<std::array<int, 3>, 3>& m) {
  for (auto& v : s.vertices) {
    const std::array<double, 3> p = v;
    for (int i = 0; i < 3; ++i) v[i] = m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2];
  }
  return s;
}

inline Surface scaled(Surface s, double factor) {
  for (auto& v : s.vertices) {
    for (double& x : v) x *= factor;
  }
  return s;
}

inline std::vector<Sample> samples() {
  const Polygon square = {{0, 0}, {1000, 0}, {1000, 1000}, {0, 1000}};
  const Polygon hole = {{300, 300}, {300, 700}, {700, 700}, {700, 300}};
  const Polygon needle_hole = {{300, 300}, {480, 520}, {700, 700}, {520, 480}};
  const Polygon ell = {{0, 0}, {1000, 0}, {1000, 400}, {400, 400}, {400, 1000}, {0, 1000}};
  const Polygon star = {{1000, 0},  {300, 200},   {0, 1000},  {-200, 300},
                        {-1000, 0}, {-300, -200}, {0, -1000}, {200, -300}};
  const Polygon wedge = {{0, 0}, {5000, 0}, {5000, 400}};
  const Polygon thin_wedge = {{0, 0}, {100000, 0}, {100000, 1}};
  // A deep notch: reflex corners close to 360 degrees, and near 180 at its mouth.
  const Polygon notched = {{0, 0},     {1000, 0},   {1000, 1000}, {520, 1000},
                           {500, 300}, {480, 1000}, {0, 1000}};
  Polygon round;
  for (int i = 0; i < 24; ++i) {
    const double a = i * 3.14159265358979323846 / 12;
    round.push_back({std::llround(1000 * std::cos(a)), std::llround(1000 * std::sin(a))});
  }
  std::vector<Sample> result = {
      {"cube", prism(square, 1000)},
      {"frame", prism(square, 500, hole)},
      {"square with a needle hole", prism(square, 500, needle_hole)},
      {"L", prism(ell, 300)},
      {"star", prism(star, 200)},
      {"flat star", prism(star, 20)},
      {"wedge", prism(wedge, 2000)},
      {"thin wedge", prism(thin_wedge, 2000)},
      {"notch", prism(notched, 600)},
      {"coin", prism(round, 50)},
      {"pyramid on an L", pyramid(ell, {350, 350, 500})},
      {"star pyramid", pyramid(star, {0, 0, 500})},
      {"flat star pyramid", pyramid(star, {0, 0, 20})},
      {"cone", pyramid(round, {0, 0, 2000})},
      {"lens", pyramid(round, {0, 0, 40})},
      {"spike", spike(300)},
      {"low spike", spike(1)},
      {"needle", tetrahedron({{{0, 0, 0}, {100000, 3, 5}, {100001, 10, 2}, {100003, 4, 11}}})},
      {"sliver", tetrahedron({{{0, 0, 0}, {1000, 1000, 1}, {1000, 0, 0}, {0, 1000, 2}}})},
  };
  // A hole close to the middle of an edge that is acute at the bottom: it bounds the strip there.
  result.push_back(
      {"hole by an acute edge", sheared(prism({{0, 0}, {3000, 0}, {3000, 3000}, {0, 3000}}, 3000,
                                              {{1400, 20}, {1400, 120}, {1600, 120}, {1600, 20}}),
                                        {{{1, 0, 0}, {0, 1, 4}, {0, 0, 1}}})});
  const std::array<std::array<std::array<int, 3>, 3>, 2> shears = {
      {{{{1, 2, 0}, {0, 1, 3}, {1, 0, 1}}}, {{{3, -1, 1}, {1, 2, -1}, {0, 1, 2}}}}};
  const std::size_t plain = result.size();
  for (std::size_t i = 0; i < plain; ++i) {
    for (const auto& m : shears) {
      result.push_back({"sheared " + result[i].name, sheared(result[i].surface, m)});
    }
  }
  std::mt19937 random(20240607);
  std::uniform_int_distribution<std::int64_t> coordinate(-1000, 1000);
  for (int i = 0; i < 60; ++i) {
    std::array<std::array<std::int64_t, 3>, 4> p;
    for (auto& v : p) {
      for (auto& x : v) x = coordinate(random);
    }
    Surface s = tetrahedron(p);
    if (!s.triangles.empty()) result.push_back({"tetrahedron " + std::to_string(i), s});
  }
  return result;
}

}  // namespace delmesher::chamfer::test_polyhedra
