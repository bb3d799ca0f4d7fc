#include "mesher/surface/edge_bends.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesher/predicates/vector.h"
#include "mesher/surface/half_edges.h"

namespace delmesher::surface {
namespace {

using predicates::Vec3;

// As noisy as the corners are, however narrow the triangles.
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
  return std::copysign(largest / norm(normal), -dot(t, subtract(p[3], p[0])));
}

// Ascending sizes.
class Sizes {
 public:
  explicit Sizes(std::vector<double> sizes) : sizes_(std::move(sizes)) {
    std::sort(sizes_.begin(), sizes_.end());
  }
  const std::vector<double>& all() const { return sizes_; }
  std::ptrdiff_t up_to(double most) const {
    return std::upper_bound(sizes_.begin(), sizes_.end(), most) - sizes_.begin();
  }

 private:
  std::vector<double> sizes_;
};

}  // namespace

std::vector<double> edge_bends(const Surface& surface) {
  const HalfEdgeGroups edges(surface.triangles, surface.vertices.size());
  std::vector<double> result;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (const auto h = edges[e]; h.size() == 2) result.push_back(bend(surface, h[0], h[1]));
  }
  return result;
}

double noise_of_bends(const std::vector<double>& bends, double rounding, double least,
                      double most) {
  constexpr std::ptrdiff_t kFewest = 8, kTimes = 10, kSmaller = 8, kShare = 4;
  std::vector<double> sizes, convex_sizes;
  for (const double x : bends) {
    if (!(std::fabs(x) > rounding)) continue;
    sizes.push_back(std::fabs(x));
    if (x > 0) convex_sizes.push_back(x);
  }
  const Sizes all(std::move(sizes)), convex(std::move(convex_sizes));
  for (const double x : all.all()) {
    if (x <= least) continue;
    if (x > most) break;
    const std::ptrdiff_t up_to = all.up_to(x), more = all.up_to(4 * x) - up_to,
                         quarter = all.up_to(x / 4), smaller = quarter - all.up_to(x / 16),
                         to_one_side = convex.up_to(x);
    if (up_to >= kFewest && up_to >= kTimes * more && kSmaller * smaller >= up_to - quarter &&
        kShare * std::min({up_to - quarter, to_one_side, up_to - to_one_side}) >= up_to) {
      return x;
    }
  }
  return 0;
}

}  // namespace delmesher::surface
