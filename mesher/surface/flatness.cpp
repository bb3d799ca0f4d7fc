#include "mesher/surface/flatness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mesher/predicates/vector.h"
#include "mesher/surface/half_edges.h"
#include "mesher/surface/resolution.h"

namespace delmesher::surface {
namespace {

using predicates::Vec3;

// As noisy as the corners are, however narrow the triangles. Infinite for a sharp edge.
double bend(const Surface& surface, std::uint32_t h, std::uint32_t g) {
  const auto corner = [&](std::uint32_t edge, std::uint32_t k) {
    return surface.vertices[surface.triangles[edge / 3][(edge % 3 + k) % 3]];
  };
  const std::array<Vec3, 4> p = {corner(h, 0), corner(h, 1), corner(h, 2), corner(g, 2)};
  const Vec3 edge = subtract(p[1], p[0]), t = cross(edge, subtract(p[2], p[0])),
             u = cross(subtract(p[3], p[0]), edge);
  if (!(dot(t, u) > 0)) return HUGE_VAL;
  const double weight_t = norm(t), weight_u = norm(u);
  Vec3 normal, centre;
  for (std::size_t i = 0; i < 3; ++i) {
    normal[i] = t[i] + u[i];
    centre[i] = (edge[i] + (weight_t * (p[2][i] - p[0][i]) + weight_u * (p[3][i] - p[0][i])) /
                               (weight_t + weight_u)) /
                3;
  }
  double largest = 0;
  for (const Vec3& q : p) {
    largest = std::max(largest, std::fabs(dot(normal, subtract(subtract(q, p[0]), centre))));
  }
  return largest / norm(normal);
}

std::vector<double> bends(const Surface& surface) {
  const HalfEdgeGroups edges(surface.triangles, surface.vertices.size());
  std::vector<double> result;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (const auto h = edges[e]; h.size() == 2) result.push_back(bend(surface, h[0], h[1]));
  }
  return result;
}

// Are the bends above `least` what coordinates that are off by `rounding` make of flat faces?
bool explains(double rounding, const std::vector<double>& bends, double least) {
  constexpr double kExplained = 1.25, kMore = 4, kTimes = 4.5;
  const auto count = [&bends](double low, double high) {
    return static_cast<double>(
        std::ranges::count_if(bends, [=](double x) { return x > low && x <= high; }));
  };
  const double most = kExplained * rounding;
  return count(least, most) > kTimes * std::max(1.0, count(std::max(least, most), kMore * most));
}

}  // namespace

double flatness(const Surface& surface) {
  constexpr double kFlat = 0x1p-20;                            // of the diagonal
  constexpr double kUlps = 0x1p-46;                            // of the largest coordinate: 64
  constexpr double kOfRounding = 1.5, kMostRounded = 0x1p-14;  // of the diagonal
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  double largest = 0;
  for (const Vec3& v : surface.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], v[i]);
      high[i] = std::max(high[i], v[i]);
      largest = std::max(largest, std::fabs(v[i]));
    }
  }
  const double diagonal = norm(subtract(high, low));
  if (!(diagonal > 0) || !std::isfinite(diagonal)) return 0;
  const std::vector<double> all = bends(surface);
  const double least = kUlps * largest, most = kFlat * diagonal;
  double flat = least / 4;
  for (const double x : all) {
    if (x <= most) flat = std::max(flat, x);
  }
  const double result = std::min(4 * flat, most);
  const double rounding = rounding_of_coordinates(surface, kMostRounded / kOfRounding * diagonal);
  return explains(rounding, all, least) ? std::max(result, kOfRounding * rounding) : result;
}

}  // namespace delmesher::surface
