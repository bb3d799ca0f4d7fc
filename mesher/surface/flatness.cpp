#include "mesher/surface/flatness.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesher/predicates/vector.h"
#include "mesher/surface/half_edges.h"

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

}  // namespace

double flatness(const Surface& surface) {
  constexpr double kFlat = 0x1p-20;       // of the diagonal
  constexpr double kRoundings = 0x1p-46;  // of the largest coordinate: 64 units in the last place
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  double largest = 0;
  for (const Vec3& v : surface.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], v[i]);
      high[i] = std::max(high[i], v[i]);
      largest = std::max(largest, std::fabs(v[i]));
    }
  }
  const double most = kFlat * norm(subtract(high, low));
  if (!(most > 0) || !std::isfinite(most)) return 0;
  double flat = kRoundings / 4 * largest;
  const HalfEdgeGroups edges(surface.triangles, surface.vertices.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges[e];
    if (h.size() != 2) continue;
    const double x = bend(surface, h[0], h[1]);
    if (x <= most) flat = std::max(flat, x);
  }
  return std::min(4 * flat, most);
}

}  // namespace delmesher::surface
