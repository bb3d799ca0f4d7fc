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
      const double slack =
          8 * kEpsilon * (std::abs(p) + std::abs(q)) + error_ * (4 * size + 8 * error_);
      per_length_ += slack + 8 * kEpsilon * std::abs(normal_[k]);
      per_displacement_ += slack + std::abs(normal_[k]);
    }
    per_length_ *= 1 + 16 * kEpsilon;
    per_displacement_ *= 1 + 16 * kEpsilon;
  }

  // 1: certainly on the side from which a, b, c are counter-clockwise, -1: certainly on the other,
  // 0: unknown.
  int side(const Approximation& p) const {
    const Vec3 d = {p.x - origin_[0], p.y - origin_[1], p.z - origin_[2]};
    const double length = std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
    const double sum = normal_[0] * d[0] + normal_[1] * d[1] + normal_[2] * d[2];
    // Far above the error of underflow in the products.
    const double bound =
        per_length_ * length + per_displacement_ * (2 * (p.error + error_)) + 0x1p-1000;
    return sum > bound ? 1 : sum < -bound ? -1 : 0;
  }

 private:
  static constexpr double kEpsilon = 0x1p-53;

  Vec3 origin_{}, normal_{};
  double error_ = 0;
  // How much a point's sum may be off, for its distance along an axis and for its displacement.
  double per_length_ = 0, per_displacement_ = 0;
};

}  // namespace delmesher::surface
