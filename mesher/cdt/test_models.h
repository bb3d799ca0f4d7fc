// Surfaces for the tests of this folder; all valid by construction (and checked to be).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "mesher/delmesher/surface.h"

namespace delmesher::cdt::test_models {

using Point = std::array<double, 3>;

inline void append(Surface& s, const Surface& part) {
  const auto base = static_cast<std::uint32_t>(s.vertices.size());
  s.vertices.insert(s.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& t : part.triangles)
    s.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

inline Surface inside_out(Surface s) {
  for (auto& t : s.triangles) std::swap(t[1], t[2]);
  return s;
}

// Boundary of a set of cells of a grid with the given planes; `filled(i, j, k)` selects the cells.
// Cells that touch in an edge or corner only are not allowed.
template <typename Filled>
Surface voxels(const std::array<std::vector<double>, 3>& planes, Filled&& filled) {
  Surface s;
  std::map<std::array<int, 3>, std::uint32_t> number;
  const auto vertex = [&](const std::array<int, 3>& g) {
    const auto [it, fresh] = number.emplace(g, static_cast<std::uint32_t>(s.vertices.size()));
    if (fresh) s.vertices.push_back({planes[0][g[0]], planes[1][g[1]], planes[2][g[2]]});
    return it->second;
  };
  const std::array<int, 3> n = {static_cast<int>(planes[0].size()) - 1,
                                static_cast<int>(planes[1].size()) - 1,
                                static_cast<int>(planes[2].size()) - 1};
  const auto in = [&](const std::array<int, 3>& c) {
    for (int k = 0; k < 3; ++k) {
      if (c[k] < 0 || c[k] >= n[k]) return false;
    }
    return static_cast<bool>(filled(c[0], c[1], c[2]));
  };
  for (int i = 0; i < n[0]; ++i) {
    for (int j = 0; j < n[1]; ++j) {
      for (int k = 0; k < n[2]; ++k) {
        const std::array<int, 3> cell = {i, j, k};
        if (!in(cell)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          for (int up = 0; up < 2; ++up) {
            std::array<int, 3> beyond = cell;
            beyond[axis] += up == 1 ? 1 : -1;
            if (in(beyond)) continue;
            const auto corner = [&](int a, int b) {
              std::array<int, 3> g = cell;
              g[axis] += up;
              g[(axis + 1) % 3] += a;
              g[(axis + 2) % 3] += b;
              return vertex(g);
            };
            const std::uint32_t a = corner(0, 0), c = corner(1, 1);
            std::uint32_t b = corner(1, 0), d = corner(0, 1);
            if (up == 0) std::swap(b, d);
            s.triangles.push_back({a, b, c});
            s.triangles.push_back({a, c, d});
          }
        }
      }
    }
  }
  return s;
}

inline Surface box(double lo, double hi) {
  return voxels({{{lo, hi}, {lo, hi}, {lo, hi}}}, [](int, int, int) { return true; });
}

// A plate of n x n cells with a hole in every cell of odd indices; uneven spacing.
inline Surface perforated_plate(int n, double thickness, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::array<std::vector<double>, 3> planes;
  for (int axis = 0; axis < 2; ++axis) {
    double x = 0;
    for (int i = 0; i <= n; ++i) {
      planes[axis].push_back(x);
      x += 1 + static_cast<double>(random() % 7) / 4;
    }
  }
  planes[2] = {0, thickness};
  return voxels(planes, [](int i, int j, int) { return i % 2 == 0 || j % 2 == 0; });
}

// Two regular n-gons, the upper one turned by `twist`, joined by triangles; with `reflex` the
// diagonals of the sides go inwards: the polyhedra of Schoenhardt (n = 3) and Rambau.
inline Surface twisted_prism(int n, double twist, double height, bool reflex) {
  Surface s;
  const double turn = 6.283185307179586 / n;
  for (int i = 0; i < n; ++i) s.vertices.push_back({std::cos(turn * i), std::sin(turn * i), 0});
  for (int i = 0; i < n; ++i) {
    s.vertices.push_back({std::cos(turn * i + twist), std::sin(turn * i + twist), height});
  }
  const auto lower = [&](int i) { return static_cast<std::uint32_t>(i % n); };
  const auto upper = [&](int i) { return static_cast<std::uint32_t>(n + i % n); };
  for (int i = 0; i < n; ++i) {
    if (reflex) {
      s.triangles.push_back({lower(i), lower(i + 1), upper(i + 1)});
      s.triangles.push_back({lower(i), upper(i + 1), upper(i)});
    } else {
      s.triangles.push_back({lower(i), lower(i + 1), upper(i)});
      s.triangles.push_back({lower(i + 1), upper(i + 1), upper(i)});
    }
  }
  for (int i = 1; i + 1 < n; ++i) {
    s.triangles.push_back({lower(0), lower(i + 1), lower(i)});
    s.triangles.push_back({upper(0), upper(i), upper(i + 1)});
  }
  return s;
}

// A subdivided octahedron with random radii: star-shaped, all spikes and pits.
inline Surface star(int subdivisions, double smallest, std::uint32_t seed) {
  std::mt19937 random(seed);
  Surface s;
  s.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  s.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                 {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> middle;
    const auto half = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, fresh] = middle.emplace(std::array{std::min(a, b), std::max(a, b)},
                                              static_cast<std::uint32_t>(s.vertices.size()));
      if (fresh) {
        Point p;
        for (int k = 0; k < 3; ++k) p[k] = s.vertices[a][k] + s.vertices[b][k];
        s.vertices.push_back(p);
      }
      return it->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& t : s.triangles) {
      const std::uint32_t x = half(t[0], t[1]), y = half(t[1], t[2]), z = half(t[2], t[0]);
      finer.push_back({t[0], x, z});
      finer.push_back({t[1], y, x});
      finer.push_back({t[2], z, y});
      finer.push_back({x, y, z});
    }
    s.triangles = finer;
  }
  for (Point& p : s.vertices) {
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    const double radius = smallest + (1 - smallest) * static_cast<double>(random() % 1024) / 1024;
    for (double& x : p) x *= radius / length;
  }
  return s;
}

// Needles side by side, each a tetrahedron with angles of about `angle` at its tip, tips pointing
// both ways.
inline Surface needles(int count, double angle, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto length = [&] { return 0.5 + static_cast<double>(random() % 512) / 1024; };
  Surface s;
  for (int i = 0; i < count; ++i) {
    const double y = i / 64.0, z = (i % 3) / 128.0, sign = i % 2 == 0 ? 1 : -1;
    const double tip = i % 2 == 0 ? 0 : 1;
    Surface t;
    t.vertices = {{tip, y, z},
                  {tip + sign * length(), y, z},
                  {tip + sign * length(), y + angle, z},
                  {tip + sign * length(), y + angle / 4, z + angle}};
    t.triangles = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    append(s, t);
  }
  return s;
}

// One needle along the x axis, with its tip at the origin and any angle, and small tetrahedra
// around it whose vertices are in the way.
inline Surface needle_among_obstacles(double angle, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto number = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(random() % 1024) / 1024;
  };
  Surface s;
  s.vertices = {{0, 0, 0}, {1, 0, 0}, {0.9, angle, 0}, {0.7, angle / 4, angle}};
  s.triangles = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (int i = 0; i < 24; ++i) {
    const double x = i / 24.0, side = i % 2 == 0 ? 1 : -1, far = number(0.03, 0.06);
    const double y = i % 3 == 0 ? 0 : side * far, z = i % 3 == 0 ? side * far : 0;
    Surface t;
    t.vertices = {{x, y, z},
                  {x + number(0.01, 0.02), y, z},
                  {x, y + number(0.01, 0.02), z},
                  {x, y, z + 0.01}};
    t.triangles = s.triangles;
    t.triangles.resize(4);
    append(s, t);
  }
  return s;
}

// A thin plate between two layers of n x n crumbs: its large facets, without any vertex inside, are
// crossed by hundreds of tetrahedra each.
inline Surface plate_between_crumbs(int n, double gap, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto number = [&](double hi) { return hi * static_cast<double>(random() % 4096) / 4096; };
  Surface s =
      voxels({{{-1.0 / n, 1}, {-1.0 / n, 1}, {-gap, gap}}}, [](int, int, int) { return true; });
  for (int i = 0; i < n * n; ++i) {
    for (const double side : {-1.0, 1.0}) {
      const double size = 0.3 / n;
      const double x = static_cast<double>(i % n) / n + number(size);
      const double y = static_cast<double>(i / n) / n + number(size);
      const double z = side * (2 * gap + number(gap));
      Surface t;
      t.vertices = {{x, y, z}, {x + size, y, z}, {x, y + size, z}, {x, y, z + side * size}};
      t.triangles = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
      append(s, side > 0 ? t : inside_out(t));
    }
  }
  return s;
}

// Thin plates of random directions, one in each cell of an n x n x n grid and nearly as wide as it.
inline Surface slabs(int n, double thickness, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto number = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(random() % 4096) / 4096;
  };
  Surface s;
  for (int i = 0; i < n * n * n; ++i) {
    const std::array<int, 3> cell = {i % n, i / n % n, i / n / n};
    std::array<std::vector<double>, 3> planes;
    const auto thin = static_cast<std::size_t>(random() % 3);
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = k == thin ? number(0.05, 0.9) : number(0.01, 0.1);
      const double to = k == thin ? at + thickness * number(0.5, 1) : number(0.9, 0.99);
      planes[k] = {cell[k] + at, cell[k] + to};
    }
    append(s, voxels(planes, [](int, int, int) { return true; }));
  }
  return s;
}

// Triangles of a simple polygon given counter-clockwise by (x, y) with small dyadic coordinates, by
// cutting ears.
inline std::vector<std::array<std::uint32_t, 3>> cut_ears(
    const std::vector<std::array<double, 2>>& p) {
  const auto area = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return (p[b][0] - p[a][0]) * (p[c][1] - p[a][1]) - (p[b][1] - p[a][1]) * (p[c][0] - p[a][0]);
  };
  std::vector<std::uint32_t> left;
  for (std::uint32_t i = 0; i < p.size(); ++i) left.push_back(i);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  while (left.size() > 2) {
    const std::size_t before = left.size();
    for (std::size_t i = 0; i < left.size() && left.size() > 2; ++i) {
      const std::size_t n = left.size();
      const std::uint32_t a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
      bool ear = area(a, b, c) > 0;
      for (const std::uint32_t v : left) {
        if (v == a || v == b || v == c) continue;
        ear = ear && !(area(a, b, v) >= 0 && area(b, c, v) >= 0 && area(c, a, v) >= 0);
      }
      if (!ear) continue;
      triangles.push_back({a, b, c});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (left.size() == before) return {};
  }
  return triangles;
}

// Chazelle's polyhedron: n wedges cut from above down to the surface z = xy + gap and n from below
// up to z = xy, crosswise. Any convex decomposition has a quadratic number of parts.
inline Surface chazelle(int n, double gap) {
  Surface s;
  const double high = 2.0 * (n + 1) * (n + 1), first = 0.5, last = n + 0.5;
  const auto vertex = [&](double x, double y, double z) {
    for (std::uint32_t v = 0; v < s.vertices.size(); ++v) {
      if (s.vertices[v] == Point{x, y, z}) return v;
    }
    s.vertices.push_back({x, y, z});
    return static_cast<std::uint32_t>(s.vertices.size() - 1);
  };
  // Sawtooth profiles: position k/2 + 1/2 for k = 0 .. 2n; odd k are the cut edges.
  const auto at = [&](int k) { return 0.5 + 0.5 * k; };
  const auto top = [&](int k, double y) { return k % 2 == 0 ? high : at(k) * y + gap; };
  const auto bottom = [&](int k, double x) { return k % 2 == 0 ? -high : at(k) * x; };
  for (int k = 0; k < 2 * n; ++k) {
    const std::uint32_t a = vertex(at(k), first, top(k, first)),
                        b = vertex(at(k + 1), first, top(k + 1, first)),
                        c = vertex(at(k + 1), last, top(k + 1, last)),
                        d = vertex(at(k), last, top(k, last));
    s.triangles.push_back({a, b, c});
    s.triangles.push_back({a, c, d});
    const std::uint32_t e = vertex(first, at(k), bottom(k, first)),
                        f = vertex(first, at(k + 1), bottom(k + 1, first)),
                        g = vertex(last, at(k + 1), bottom(k + 1, last)),
                        h = vertex(last, at(k), bottom(k, last));
    s.triangles.push_back({e, f, g});
    s.triangles.push_back({e, g, h});
  }
  for (const bool far : {false, true}) {
    const double y = far ? last : first;
    std::vector<std::array<double, 2>> side;  // in (x, z), seen against the y axis
    side.push_back({first, -high});
    side.push_back({last, -high});
    for (int k = 2 * n; k >= 0; --k) side.push_back({at(k), top(k, y)});
    for (auto t : cut_ears(side)) {
      if (far) std::swap(t[1], t[2]);
      s.triangles.push_back({vertex(side[t[0]][0], y, side[t[0]][1]),
                             vertex(side[t[1]][0], y, side[t[1]][1]),
                             vertex(side[t[2]][0], y, side[t[2]][1])});
    }
    const double x = y;
    side.clear();  // in (y, z), seen along the x axis
    for (int k = 0; k <= 2 * n; ++k) side.push_back({at(k), bottom(k, x)});
    side.push_back({last, high});
    side.push_back({first, high});
    for (auto t : cut_ears(side)) {
      if (!far) std::swap(t[1], t[2]);
      s.triangles.push_back({vertex(x, side[t[0]][0], side[t[0]][1]),
                             vertex(x, side[t[1]][0], side[t[1]][1]),
                             vertex(x, side[t[2]][0], side[t[2]][1])});
    }
  }
  return s;
}

// One of each kind, small: with labels that separate coplanar triangles, with a wall around a
// cavity, with sharp corners.
inline std::vector<Surface> one_of_each() {
  Surface labelled =
      voxels({{{0, 1, 2, 3}, {0, 1, 2}, {0, 0.5}}}, [](int, int, int) { return true; });
  for (std::size_t t = 0; t < labelled.triangles.size(); ++t) {
    labelled.labels.push_back(labelled.vertices[labelled.triangles[t][0]][0] < 2 ? 1 : 0);
  }
  Surface nested = box(0, 8);
  append(nested, inside_out(box(1, 7)));
  return {box(0, 1),
          perforated_plate(5, 0.25, 2),
          star(1, 0.1, 5),
          chazelle(2, 0.5),
          twisted_prism(5, 0.1, 1, true),
          labelled,
          nested};
}

}  // namespace delmesher::cdt::test_models
