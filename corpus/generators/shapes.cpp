#include "corpus/generators/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace tetproof::shapes {
namespace {

double area2(const Planar& a, const Planar& b, const Planar& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool is_ear(const Polygon& polygon, const std::vector<std::uint32_t>& rest, std::size_t i) {
  const std::size_t n = rest.size();
  const std::uint32_t a = rest[(i + n - 1) % n], b = rest[i], c = rest[(i + 1) % n];
  if (!(area2(polygon[a], polygon[b], polygon[c]) > 0)) return false;
  return std::none_of(rest.begin(), rest.end(), [&](std::uint32_t v) {
    if (v == a || v == b || v == c) return false;
    const Planar& p = polygon[v];
    return area2(polygon[a], polygon[b], p) >= 0 && area2(polygon[b], polygon[c], p) >= 0 &&
           area2(polygon[c], polygon[a], p) >= 0;
  });
}

// Two triangles for a quadrangle whose corners are counter-clockwise seen from outside.
void quadrangle(Surface& s, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
                bool flip) {
  if (flip) {
    s.triangles.insert(s.triangles.end(), {{a, b, d}, {b, c, d}});
  } else {
    s.triangles.insert(s.triangles.end(), {{a, b, c}, {a, c, d}});
  }
}

}  // namespace

Planar circle(double turns) {
  const double quarter = 4 * (turns - std::floor(turns));
  const int quadrant = static_cast<int>(quarter) % 4;
  const double f = quarter - std::floor(quarter);
  // Half-angle parametrization; the cubic is close to tan(pi / 4 f) and exact at both ends.
  const double t = f * (0.785398 + 0.214602 * f * f);
  const double x = (1 - t * t) / (1 + t * t), y = 2 * t / (1 + t * t);
  const Planar by_quadrant[4] = {{x, y}, {-y, x}, {-x, -y}, {y, -x}};
  return by_quadrant[quadrant];
}

Polygon polygon(int corners, const std::function<double(int)>& vary, double turned) {
  Polygon result;
  for (int i = 0; i < corners; ++i) {
    const auto [x, y] = circle(static_cast<double>(i) / corners + turned);
    const double radius = vary ? vary(i) : 1;
    result.push_back({radius * x, radius * y});
  }
  return result;
}

std::vector<std::array<std::uint32_t, 3>> triangulate(const Polygon& polygon) {
  std::vector<std::uint32_t> rest(polygon.size());
  std::iota(rest.begin(), rest.end(), 0U);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::size_t at = 0;
  while (rest.size() > 3) {
    std::size_t tried = 0;
    while (tried < rest.size() && !is_ear(polygon, rest, at % rest.size())) ++at, ++tried;
    const std::size_t i = at % rest.size(), n = rest.size();  // any one, if rounding hides all ears
    triangles.push_back({rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    ++at;
  }
  triangles.push_back({rest[0], rest[1], rest[2]});
  return triangles;
}

Surface box(const Point& low, const Point& high) {
  return extrude({{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}},
                 low[2], high[2]);
}

Surface tetrahedron(const Point& a, const Point& b, const Point& c, const Point& d) {
  return {{a, b, c, d}, {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}, {}};
}

Surface extrude(const Polygon& polygon, double bottom, double top) {
  return tower({polygon, polygon}, {bottom, top});
}

Surface spindle(const Point& bottom, const std::vector<std::vector<Point>>& rings,
                const Point& top) {
  Surface s;
  const auto n = static_cast<std::uint32_t>(rings[0].size());
  for (const auto& ring : rings) s.vertices.insert(s.vertices.end(), ring.begin(), ring.end());
  const auto low = static_cast<std::uint32_t>(s.vertices.size()), high = low + 1;
  s.vertices.push_back(bottom);
  s.vertices.push_back(top);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    for (std::uint32_t r = 0; r + 1 < rings.size(); ++r) {
      quadrangle(s, r * n + i, r * n + j, (r + 1) * n + j, (r + 1) * n + i, false);
    }
    const auto last = static_cast<std::uint32_t>(rings.size() - 1) * n;
    s.triangles.push_back({low, j, i});
    s.triangles.push_back({high, last + i, last + j});
  }
  return s;
}

Surface tower(const std::vector<Polygon>& rings, const std::vector<double>& heights,
              const std::function<bool(int)>& flip) {
  Surface s;
  const auto n = static_cast<std::uint32_t>(rings[0].size());
  for (std::size_t r = 0; r < rings.size(); ++r) {
    for (const auto& [x, y] : rings[r]) s.vertices.push_back({x, y, heights[r]});
  }
  const auto last = static_cast<std::uint32_t>(rings.size() - 1) * n;
  for (const auto& [a, b, c] : triangulate(rings.front())) s.triangles.push_back({a, c, b});
  for (const auto& [a, b, c] : triangulate(rings.back())) {
    s.triangles.push_back({last + a, last + b, last + c});
  }
  int number = 0;
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t j = (i + 1) % n, low = r * n, high = low + n;
      quadrangle(s, low + i, low + j, high + j, high + i, flip && flip(number));
      ++number;
    }
  }
  return s;
}

Surface sphere(int rounds, const std::function<double()>& radius) {
  Surface s;
  s.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  s.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                 {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < rounds; ++round) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto fresh = static_cast<std::uint32_t>(s.vertices.size());
      const auto [at, added] = middles.emplace(std::minmax(a, b), fresh);
      if (added) s.vertices.push_back(mix(s.vertices[a], s.vertices[b], 0.5));
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : s.triangles) {
      const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    s.triangles = std::move(finer);
  }
  for (Point& p : s.vertices) {
    const double scale = radius() / std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (double& x : p) x *= scale;
  }
  return s;
}

Surface slab(int n, const std::function<double(int x, int y)>& bottom,
             const std::function<double(int x, int y)>& top) {
  Surface s;
  const auto row = static_cast<std::uint32_t>(n + 1);
  for (const auto* height : {&bottom, &top}) {
    for (int y = 0; y <= n; ++y) {
      for (int x = 0; x <= n; ++x) {
        s.vertices.push_back(
            {static_cast<double>(x) / n, static_cast<double>(y) / n, (*height)(x, y)});
      }
    }
  }
  const std::uint32_t up = row * row;
  const auto v = [&](int x, int y) { return static_cast<std::uint32_t>(y) * row + x; };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const auto a = v(x, y), b = v(x + 1, y), c = v(x + 1, y + 1), d = v(x, y + 1);
      quadrangle(s, a, d, c, b, false);
      quadrangle(s, up + a, up + b, up + c, up + d, (x + y) % 2 == 0);
    }
  }
  for (int i = 0; i < n; ++i) {
    const std::uint32_t sides[4][2] = {{v(i, 0), v(i + 1, 0)},
                                       {v(n, i), v(n, i + 1)},
                                       {v(i + 1, n), v(i, n)},
                                       {v(0, i + 1), v(0, i)}};
    for (const auto& [a, b] : sides) quadrangle(s, a, b, up + b, up + a, false);
  }
  return s;
}

Surface walls(const std::array<std::vector<double>, 3>& lines, const Cells& solid) {
  Surface s;
  std::array<int, 3> cells;
  for (std::size_t i = 0; i < 3; ++i) cells[i] = static_cast<int>(lines[i].size()) - 1;
  const auto filled = [&](const std::array<int, 3>& c) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (c[i] < 0 || c[i] >= cells[i]) return false;
    }
    return solid(c[0], c[1], c[2]);
  };
  const auto corner = [&](const std::array<int, 3>& g) {
    s.vertices.push_back({lines[0][static_cast<std::size_t>(g[0])],
                          lines[1][static_cast<std::size_t>(g[1])],
                          lines[2][static_cast<std::size_t>(g[2])]});
    return static_cast<std::uint32_t>(s.vertices.size() - 1);
  };
  const auto wall = [&](std::array<int, 3> g, std::size_t axis, bool outwards) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const std::uint32_t a = corner(g);
    ++g[u];
    const std::uint32_t b = corner(g);
    ++g[v];
    const std::uint32_t c = corner(g);
    --g[u];
    const std::uint32_t d = corner(g);
    if (outwards) {
      quadrangle(s, a, b, c, d, false);
    } else {
      quadrangle(s, a, d, c, b, false);
    }
  };
  for (int z = 0; z <= cells[2]; ++z) {
    for (int y = 0; y <= cells[1]; ++y) {
      for (int x = 0; x <= cells[0]; ++x) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          std::array<int, 3> before = {x, y, z};
          --before[axis];
          const bool here = filled({x, y, z}), there = filled(before);
          if (here != there) wall({x, y, z}, axis, there);
        }
      }
    }
  }
  return welded(s);
}

void append(Surface& surface, const Surface& other) {
  const auto offset = static_cast<std::uint32_t>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) {
    surface.triangles.push_back({a + offset, b + offset, c + offset});
  }
}

void reverse(Surface& surface) {
  for (auto& t : surface.triangles) std::swap(t[1], t[2]);
}

void move(Surface& surface, const std::function<Point(const Point&)>& map) {
  for (Point& p : surface.vertices) p = map(p);
}

Surface welded(const Surface& surface) {
  Surface result;
  std::map<Point, std::uint32_t> ids;
  for (auto triangle : surface.triangles) {
    for (std::uint32_t& v : triangle) {
      const auto fresh = static_cast<std::uint32_t>(result.vertices.size());
      const auto [at, added] = ids.emplace(surface.vertices[v], fresh);
      if (added) result.vertices.push_back(surface.vertices[v]);
      v = at->second;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

Point mix(const Point& a, const Point& b, double share_of_b) {
  Point p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = a[i] + (b[i] - a[i]) * share_of_b;
  return p;
}

double ulps_away(double x, int steps) {
  for (int i = 0; i < std::abs(steps); ++i) x = std::nextafter(x, steps > 0 ? HUGE_VAL : -HUGE_VAL);
  return x;
}

void turn(Surface& surface, Random& random) {
  std::array<std::size_t, 3> axis = {0, 1, 2};
  std::swap(axis[0], axis[random.below(3)]);
  std::swap(axis[1], axis[1 + random.below(2)]);
  const std::array<double, 3> sign = {random.sign(), random.sign(), random.sign()};
  move(surface, [&](const Point& p) {
    return Point{sign[0] * p[axis[0]], sign[1] * p[axis[1]], sign[2] * p[axis[2]]};
  });
  // A map that mirrors turns the surface inside out.
  const bool odd = (axis[0] > axis[1]) != ((axis[1] > axis[2]) != (axis[0] > axis[2]));
  if ((sign[0] * sign[1] * sign[2] < 0) != odd) reverse(surface);
}

}  // namespace tetproof::shapes
