#include "corpus/generators/rotate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace tetproof {
namespace {

using delmesher::Surface;
using Point = std::array<double, 3>;

double to_precision(double x, Precision precision) {
  if (precision == Precision::single) return static_cast<double>(static_cast<float>(x));
  if (precision == Precision::decimals) {
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, x, std::chars_format::general, 6).ptr;
    std::from_chars(text, end, x);
  }
  return x;
}

// A weight with a full mantissa.
double weight(Random& random) {
  return random.between(0.2, 1);
}

Point between(const Surface& s, const std::vector<std::uint32_t>& corners, Random& random) {
  Point p{0, 0, 0};
  double sum = 0;
  for (const std::uint32_t v : corners) {
    const double w = weight(random);
    for (std::size_t i = 0; i < 3; ++i) p[i] += w * s.vertices[v][i];
    sum += w;
  }
  for (double& x : p) x /= sum;
  return p;
}

std::uint32_t add_vertex(Surface& s, const Point& p) {
  s.vertices.push_back(p);
  return static_cast<std::uint32_t>(s.vertices.size() - 1);
}

void add_triangle(Surface& s, const std::array<std::uint32_t, 3>& corners, std::uint32_t like) {
  s.triangles.push_back(corners);
  if (!s.labels.empty()) s.labels.push_back(s.labels[like]);
}

}  // namespace

Quaternion rotation_from(Random& random) {
  Quaternion rotation;
  for (int& x : rotation) x = random.integer(1, 99) * (random.chance(0.5) ? 1 : -1);
  return rotation;
}

Surface rotated(const Surface& surface, const Quaternion& rotation, Precision precision) {
  const auto [w, x, y, z] = rotation;
  const int n = w * w + x * x + y * y + z * z;
  if (n == 0) throw std::invalid_argument("a rotation is expected");
  const std::array<std::array<int, 3>, 3> matrix = {{
      {w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
      {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
      {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z},
  }};
  Surface result = surface;
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    const Point& p = surface.vertices[v];
    for (std::size_t i = 0; i < 3; ++i) {
      const double sum = matrix[i][0] * p[0] + matrix[i][1] * p[1] + matrix[i][2] * p[2];
      result.vertices[v][i] = to_precision(sum / n, precision);
    }
  }
  return result;
}

Surface coarsened(const Surface& surface, int bits, Random& random) {
  if (surface.vertices.empty()) return surface;
  Point low = surface.vertices[0], high = low, origin{};
  for (const Point& p : surface.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  double longest = 0, farthest = 0;
  const std::size_t moved = random.below(3);
  for (std::size_t i = 0; i < 3; ++i) {
    longest = std::max(longest, high[i] - low[i]);
    if (i != moved && random.chance(0.3)) continue;
    // Below a power of two roundings are half as large as above it.
    const double power = std::ldexp(1.0, random.integer(-2, 25));
    origin[i] = random.sign() * power * (random.chance(0.5) ? 1 : 1 + random.unit());
    farthest = std::max(farthest, std::fabs(origin[i]));
  }
  if (!(longest > 0) || !std::isfinite(longest)) return surface;
  const double size = std::ldexp(1.0, std::ilogb(farthest) - 52 + bits);
  Surface result = surface;
  for (Point& p : result.vertices) {
    for (std::size_t i = 0; i < 3; ++i) p[i] = origin[i] + (p[i] - low[i]) / longest * size;
  }
  return result;
}

void add_noise(Surface& surface, double amplitude, Random& random) {
  double largest = 0;
  for (const Point& p : surface.vertices) {
    for (const double x : p) largest = std::max(largest, std::fabs(x));
  }
  for (Point& p : surface.vertices) {
    for (double& x : p) x += random.between(-1, 1) * amplitude * largest;
  }
}

void split_at_rounded_point(Surface& s, std::uint32_t t, Random& random) {
  const auto [a, b, c] = s.triangles[t];
  const std::uint32_t m = add_vertex(s, between(s, {a, b, c}, random));
  s.triangles[t] = {a, b, m};
  add_triangle(s, {b, c, m}, t);
  add_triangle(s, {c, a, m}, t);
}

void split_at_rounded_point(Surface& s, std::uint32_t t, int h, Random& random) {
  const auto k = static_cast<std::size_t>(h);
  split_edge_at(s, t, h, between(s, {s.triangles[t][k], s.triangles[t][(k + 1) % 3]}, random));
}

void split_edge_at(Surface& s, std::uint32_t t, int h, const Point& p) {
  const auto k = static_cast<std::size_t>(h);
  const std::uint32_t a = s.triangles[t][k], b = s.triangles[t][(k + 1) % 3],
                      c = s.triangles[t][(k + 2) % 3];
  for (std::uint32_t u = 0; u < s.triangles.size(); ++u) {
    for (std::size_t l = 0; l < 3; ++l) {
      if (s.triangles[u][l] != b || s.triangles[u][(l + 1) % 3] != a) continue;
      const std::uint32_t d = s.triangles[u][(l + 2) % 3], m = add_vertex(s, p);
      s.triangles[t] = {a, m, c};
      add_triangle(s, {m, b, c}, t);
      s.triangles[u] = {b, m, d};
      add_triangle(s, {m, a, d}, u);
      return;
    }
  }
}

}  // namespace tetproof
