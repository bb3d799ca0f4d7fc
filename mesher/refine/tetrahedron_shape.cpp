#include "mesher/refine/tetrahedron_shape.h"

#include <cmath>

#include "mesher/arithmetic/bounded.h"
#include "mesher/predicates/placement.h"

namespace delmesher::refine {
namespace {

using arithmetic::BoundedPair;
using Triple = std::array<BoundedPair, 3>;

Triple pairs(const Vec3& a) {
  return {{{a[0], 0, 0}, {a[1], 0, 0}, {a[2], 0, 0}}};
}

// A point of the store, with the digits of its remainder.
Triple pairs(const PointStore& points, VertexId v) {
  const Approximation left = points.remainder(v);
  Triple sum = pairs(points.nearest(v));
  const Triple rest = pairs({left.x, left.y, left.z});
  for (std::size_t k = 0; k < 3; ++k) {
    sum[k] = sum[k] + rest[k];
    sum[k].error += left.error;
  }
  return sum;
}

Triple operator-(const Triple& a, const Triple& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

BoundedPair dot(const Triple& a, const Triple& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double bound(const BoundedPair& a) {
  return std::fabs(a.high) + std::fabs(a.low) + a.error;
}

}  // namespace

std::optional<Vec3> certain_circumcentre(const PointStore& points, const VertexId* v, double grid,
                                         double fraction) {
  const Triple origin = pairs(points, v[0]);
  const Triple a = pairs(points, v[1]) - origin, b = pairs(points, v[2]) - origin,
               c = pairs(points, v[3]) - origin;
  const Triple bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const BoundedPair aa = dot(a, a), bb = dot(b, b), cc = dot(c, c), volume6 = dot(a, bc),
                    divisor = volume6 + volume6;
  if (divisor.sign() == 0 || divisor.sign() == arithmetic::kUnknownSign) return std::nullopt;
  Triple dividend;
  Vec3 target = points.nearest(v[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    dividend[k] = aa * bc[k] + bb * ca[k] + cc * ab[k];
    target[k] += dividend[k].high / divisor.high;
  }
  const Vec3 center = snap_to_grid(target, grid);
  // What is left of center - origin - dividend / divisor, times the divisor.
  const Triple reached = pairs(center) - origin;
  double left2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double left = bound(reached[k] * divisor - dividend[k]);
    left2 += left * left;
  }
  const double scale = fraction * (std::fabs(divisor.high) - divisor.error);
  for (const BoundedPair& length2 :
       {aa, bb, cc, dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)}) {
    // Not certain either if something overflowed to infinity or NaN.
    if (!(left2 <= scale * scale * (length2.high - length2.error))) return std::nullopt;
  }
  return center;
}

}  // namespace delmesher::refine
