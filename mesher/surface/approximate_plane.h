// Which side of a plane a point certainly is on, in plain doubles: a cheap first answer for many
// points and few planes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "mesher/predicates/points.h"

namespace delmesher::surface {

// The plane through three points known up to their errors.
class ApproximatePlane {
 public:
  ApproximatePlane() = default;
  ApproximatePlane(const Approximation& a, const Approximation& b, const Approximation& c)
      : origin_{a.x, a.y, a.z}, error_(std::max({a.error, b.error, c.error})) {
    const Vec3 u = {b.x - a.x, b.y - a.y, b.z - a.z};
    const Vec3 v = {c.x - a.x, c.y - a.y, c.z - a.z};
    const double size = std::abs(u[0]) + std::abs(u[1]) + std::abs(u[2]) + std::abs(v[0]) +
                        std::abs(v[1]) + std::abs(v[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const double p = u[i] * v[j], q = u[j] * v[i];
      normal_[k] = p - q;
      // Each difference has the rounding of one subtraction and twice the error of a point; a
      // product has that of both factors and its own, the sum once more.
      slack_[k] = 8 * kEpsilon * (std::abs(p) + std::abs(q)) + error_ * (4 * size + 8 * error_);
    }
  }

  // 1: certainly on the side from which a, b, c are counter-clockwise, -1: certainly on the other,
  // 0: unknown.
  int side(const Approximation& p) const {
    const Vec3 d = {p.x - origin_[0], p.y - origin_[1], p.z - origin_[2]};
    const double displacement = 2 * (p.error + error_);
    double sum = 0, bound = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = std::abs(d[k]);
      sum += normal_[k] * d[k];
      bound += slack_[k] * (length + displacement) +
               std::abs(normal_[k]) * (8 * kEpsilon * length + displacement);
    }
    // Far above the error of underflow in the products.
    bound = bound * (1 + 8 * kEpsilon) + 0x1p-1000;
    return sum > bound ? 1 : sum < -bound ? -1 : 0;
  }

 private:
  static constexpr double kEpsilon = 0x1p-53;

  Vec3 origin_{}, normal_{}, slack_{};
  double error_ = 0;
};

}  // namespace delmesher::surface
