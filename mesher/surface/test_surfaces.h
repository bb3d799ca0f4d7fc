// Small surfaces for the tests of this folder.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "mesher/delmesher/surface.h"

namespace delmesher::surface::test_surfaces {

using Point = std::array<double, 3>;

// An axis-parallel box, every face a grid of n x n squares cut in two; outward oriented.
inline Surface box(const Point& lo, const Point& hi, std::uint32_t n = 1) {
  Surface s;
  std::vector<std::uint32_t> ids((n + 1) * (n + 1) * (n + 1), 0xffffffffU);
  const auto vertex = [&](const std::array<std::uint32_t, 3>& g) {
    std::uint32_t& id = ids[(g[0] * (n + 1) + g[1]) * (n + 1) + g[2]];
    if (id == 0xffffffffU) {
      id = static_cast<std::uint32_t>(s.vertices.size());
      Point p;
      for (std::size_t i = 0; i < 3; ++i) {
        p[i] = g[i] == n ? hi[i] : lo[i] + (hi[i] - lo[i]) * g[i] / n;
      }
      s.vertices.push_back(p);
    }
    return id;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
          const auto at = [&](std::uint32_t di, std::uint32_t dj) {
            std::array<std::uint32_t, 3> g;
            g[axis] = upper ? n : 0;
            g[(axis + 1) % 3] = i + di;
            g[(axis + 2) % 3] = j + dj;
            return vertex(g);
          };
          std::uint32_t a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
          if (!upper) std::swap(b, d);
          s.triangles.push_back({a, b, c});
          s.triangles.push_back({a, c, d});
        }
      }
    }
  }
  return s;
}

inline Surface tetrahedron(const Point& a, const Point& b, const Point& c, const Point& d) {
  Surface s;
  s.vertices = {a, b, c, d};
  s.triangles = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  return s;
}

using Polygon = std::vector<std::array<double, 2>>;

// On the ellipse around the origin with semi-axes 1 and `width`.
inline Polygon ellipse(std::uint32_t n, double width = 1) {
  Polygon points;
  for (std::uint32_t k = 0; k < n; ++k) {
    const double angle = 2 * std::acos(-1.0) * k / n;
    points.push_back({std::cos(angle), width * std::sin(angle)});
  }
  return points;
}

// A convex polygon, counter-clockwise, extruded from z = 0 to `top` of its points. Its ends are
// fans; with many corners their triangles are needles.
inline Surface prism(const Polygon& polygon, const std::function<double(double, double)>& top) {
  Surface s;
  const auto n = static_cast<std::uint32_t>(polygon.size());
  for (const auto& [x, y] : polygon) s.vertices.push_back({x, y, 0});
  for (const auto& [x, y] : polygon) s.vertices.push_back({x, y, top(x, y)});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    s.triangles.push_back({i, j, n + j});
    s.triangles.push_back({i, n + j, n + i});
    if (i == 0 || j == 0) continue;
    s.triangles.push_back({0, j, i});
    s.triangles.push_back({n, n + i, n + j});
  }
  return s;
}

inline Surface prism(const Polygon& polygon, double height) {
  return prism(polygon, [height](double, double) { return height; });
}

inline Surface reversed(Surface s) {
  for (auto& t : s.triangles) std::swap(t[1], t[2]);
  return s;
}

// Both surfaces side by side, vertices not merged.
inline Surface joined(Surface s, const Surface& t) {
  const auto offset = static_cast<std::uint32_t>(s.vertices.size());
  s.vertices.insert(s.vertices.end(), t.vertices.begin(), t.vertices.end());
  for (const auto& x : t.triangles) {
    s.triangles.push_back({x[0] + offset, x[1] + offset, x[2] + offset});
  }
  return s;
}

// Merges vertices with equal coordinates, keeping the first.
inline Surface welded(const Surface& s) {
  Surface result;
  std::vector<std::uint32_t> id(s.vertices.size());
  for (std::size_t i = 0; i < s.vertices.size(); ++i) {
    std::size_t j = 0;
    while (j < result.vertices.size() && result.vertices[j] != s.vertices[i]) ++j;
    if (j == result.vertices.size()) result.vertices.push_back(s.vertices[i]);
    id[i] = static_cast<std::uint32_t>(j);
  }
  for (const auto& t : s.triangles) result.triangles.push_back({id[t[0]], id[t[1]], id[t[2]]});
  return result;
}

inline Surface scaled(Surface s, double factor) {
  for (auto& v : s.vertices) {
    for (double& x : v) x *= factor;
  }
  return s;
}

// By three angles, in doubles, so that every coordinate has a few roundings.
inline Surface rotated(Surface s, double a = 0.3, double b = 0.7, double c = 1.1) {
  const auto turn = [](double& x, double& y, double angle) {
    const double u = x * std::cos(angle) - y * std::sin(angle);
    y = x * std::sin(angle) + y * std::cos(angle);
    x = u;
  };
  for (Point& p : s.vertices) {
    turn(p[1], p[2], a);
    turn(p[2], p[0], b);
    turn(p[0], p[1], c);
  }
  return s;
}

// Rounded by adding and subtracting: gcc 12 at -O3 leaves out some conversions to float and back.
inline double to_single(double x) {
  const double large = std::ldexp(x < 0 ? -1.5 : 1.5, std::ilogb(x) + 29);
  return (x + large) - large;
}

inline Surface in_single_precision(Surface s) {
  for (Point& p : s.vertices) {
    for (double& x : p) x = to_single(x);
  }
  return s;
}

inline Surface in_decimals(Surface s, double unit) {
  for (Point& p : s.vertices) {
    for (double& x : p) x = std::round(x / unit) / std::round(1 / unit);
  }
  return s;
}

}  // namespace delmesher::surface::test_surfaces
