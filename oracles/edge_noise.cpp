#include "oracles/edge_noise.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "oracles/edge_key.h"
#include "oracles/vectors.h"

namespace tetproof::oracles {
namespace {

struct Size {
  double diagonal = 0, largest = 0;
};

Size size_of(const std::vector<Position>& vertices) {
  Position low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  Size size;
  for (const Position& p : vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
      size.largest = std::max(size.largest, std::fabs(p[i]));
    }
  }
  size.diagonal = vertices.empty() ? 0 : distance(high, low);
  return size;
}

double length(const Position& u) {
  return std::sqrt(dot(u, u));
}

// Of the edge from the first to the second corner, with the third on its left. Negative: sharp.
double bend(const std::array<Position, 4>& corners) {
  const Position along = minus(corners[1], corners[0]), left = minus(corners[2], corners[0]),
                 right = minus(corners[3], corners[0]);
  const Position m = cross(along, left), n = cross(right, along);
  if (!(dot(m, n) > 0)) return -1;
  const Position sum = {m[0] + n[0], m[1] + n[1], m[2] + n[2]};
  const std::array<double, 4> heights = {0, dot(sum, along), dot(sum, left), dot(sum, right)};
  const double a = length(m), b = length(n);
  const double centroid = (heights[1] * (a + b) + heights[2] * a + heights[3] * b) / (3 * (a + b));
  double most = 0;
  for (const double h : heights) most = std::max(most, std::fabs(h - centroid));
  return most / length(sum);
}

// Of vertices times `scale`, in the same units.
std::vector<double> bends(const Polyhedron& surface, double scale) {
  const auto place = [&](Index v) {
    const Position& p = surface.vertices[v];
    return Position{p[0] * scale, p[1] * scale, p[2] * scale};
  };
  std::vector<std::pair<std::uint64_t, Index>> across;  // directed edge, and the third corner
  across.reserve(3 * surface.triangles.size());
  for (const auto& [a, b, c] : surface.triangles) {
    across.emplace_back(directed_key(a, b), c);
    across.emplace_back(directed_key(b, c), a);
    across.emplace_back(directed_key(c, a), b);
  }
  std::sort(across.begin(), across.end());
  std::vector<double> result;
  for (const auto& [key, third] : across) {
    const auto from = static_cast<Index>(key >> 32), to = static_cast<Index>(key);
    if (from > to) continue;
    const auto other =
        std::lower_bound(across.begin(), across.end(), std::pair(directed_key(to, from), Index{0}));
    if (other == across.end() || other->first != directed_key(to, from)) continue;
    result.push_back(bend({place(from), place(to), place(third), place(other->second)}));
  }
  return result;
}

}  // namespace

double noise_of_edges(const Polyhedron& surface) {
  constexpr double kRounding = 0x1p-46, kMost = 0x1p-16, kSlack = 1e-6;
  const Size size = size_of(surface.vertices);
  if (!(size.diagonal > 0) || !std::isfinite(size.diagonal)) return 0;
  // Else products of three lengths might be beyond doubles.
  const double scale = std::ldexp(1, -std::max(std::ilogb(size.diagonal), -1000));
  std::vector<double> noisy = bends(surface, scale);
  const double least = kRounding * size.largest * scale, diagonal = size.diagonal * scale;
  std::erase_if(noisy, [&](double x) { return !(x > least); });
  std::sort(noisy.begin(), noisy.end());
  const auto up_to = [&](double x) {
    return std::upper_bound(noisy.begin(), noisy.end(), x) - noisy.begin();
  };
  double result = 0;
  for (std::size_t n = 7; n < noisy.size(); ++n) {
    const double x = noisy[n];
    if (x > kMost * diagonal * (1 + kSlack)) break;
    const auto count = up_to(x), quarter = up_to(x / 4);
    if (count + 1 >= 9 * (up_to(4 * x) - count) && 5 * (count - quarter) >= count &&
        10 * (quarter - up_to(x / 16)) >= count - quarter) {
      result = x;
    }
  }
  return result / diagonal * (1 + kSlack);
}

}  // namespace tetproof::oracles
