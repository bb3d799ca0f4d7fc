#include "oracles/surface/edge_noise.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "oracles/base/box.h"
#include "oracles/base/edge_key.h"
#include "oracles/base/vectors.h"

namespace tetproof::oracles {
namespace {

struct Bend {
  double size;  // negative: sharp
  bool concave;
};

// Of the edge from the first to the second corner, with the third on its left.
Bend bend(const std::array<Position, 4>& corners) {
  const Position along = minus(corners[1], corners[0]), left = minus(corners[2], corners[0]),
                 right = minus(corners[3], corners[0]);
  const Position m = cross(along, left), n = cross(right, along);
  const bool concave = dot(m, right) > 0;
  if (!(dot(m, n) > 0)) return {-1, concave};
  const Position sum = {m[0] + n[0], m[1] + n[1], m[2] + n[2]};
  const std::array<double, 4> heights = {0, dot(sum, along), dot(sum, left), dot(sum, right)};
  const double a = length(m), b = length(n);
  const double centroid = (heights[1] * (a + b) + heights[2] * a + heights[3] * b) / (3 * (a + b));
  double most = 0;
  for (const double h : heights) most = std::max(most, std::fabs(h - centroid));
  return {most / length(sum), concave};
}

// Of vertices times `scale`, in the same units.
std::vector<Bend> bends(const Polyhedron& surface, double scale) {
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
  std::vector<Bend> result;
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

double noise_of_edges(const Polyhedron& surface, double resolved) {
  constexpr double kRounding = 0x1p-46, kMost = 0x1p-16, kSlack = 1e-6;
  const Box box = box_of(surface.vertices);
  if (!(box.diagonal() > 0) || !std::isfinite(box.diagonal())) return 0;
  // Else products of three lengths might be beyond doubles.
  const double scale = std::ldexp(1, -std::max(std::ilogb(box.diagonal()), -1000));
  const double diagonal = box.diagonal() * scale,
               least = std::max(kRounding * box.largest() * scale, resolved * diagonal);
  std::vector<Bend> noisy = bends(surface, scale);
  std::erase_if(noisy, [&](const Bend& b) { return !(b.size > least); });
  std::ranges::sort(noisy, {}, &Bend::size);
  // Of the first ones, how many are concave?
  std::vector<std::ptrdiff_t> concave(1, 0);
  for (const Bend& b : noisy) concave.push_back(concave.back() + (b.concave ? 1 : 0));
  const auto up_to = [&](double x) {
    return std::ranges::upper_bound(noisy, x, {}, &Bend::size) - noisy.begin();
  };
  // Of those from place `from` to place `to`, on the side that has fewer.
  const auto fewer = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
    const std::ptrdiff_t n =
        concave[static_cast<std::size_t>(to)] - concave[static_cast<std::size_t>(from)];
    return std::min(n, to - from - n);
  };
  double result = 0;
  for (std::size_t n = resolved > 0 ? 14 : 7; n < noisy.size(); ++n) {
    const double x = noisy[n].size;
    if (x > kMost * diagonal * (1 + kSlack)) break;
    const auto count = up_to(x), quarter = up_to(x / 4), large = count - quarter;
    if (fewer(0, count) + 1 >= 6 * fewer(count, up_to(4 * x)) && 5 * large >= count &&
        10 * (quarter - up_to(x / 16)) >= large && 5 * (fewer(0, count) + 1) >= count &&
        10 * (fewer(quarter, count) + 1) >= large) {
      result = x;
    }
  }
  return result / diagonal * (1 + kSlack);
}

}  // namespace tetproof::oracles
