#include "mesher/refine/tetrahedron_shape.h"

#include <cmath>

#include "mesher/geometry/placement.h"
#include "mesher/predicates/stages.h"

namespace delmesher::refine {
namespace {

using Pairs = predicates::polynomials::Triple<BoundedPair>;

double bound(const BoundedPair& a) {
  return std::fabs(a.high) + std::fabs(a.low) + a.error;
}

}  // namespace

std::optional<Vec3> certain_circumcentre(const PointStore& points, const VertexId* v, double grid,
                                         double fraction) {
  const Pairs origin = stages::bounded_pair_point(points, v[0]);
  const auto from_origin = [&](VertexId w) {
    return stages::bounded_pair_point(points, w) - origin;
  };
  const Pairs a = from_origin(v[1]), b = from_origin(v[2]), c = from_origin(v[3]);
  const Pairs bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const BoundedPair aa = dot(a, a), bb = dot(b, b), cc = dot(c, c), volume6 = dot(a, bc),
                    divisor = volume6 + volume6;
  if (divisor.sign() == 0 || divisor.sign() == kUnknownSign) return std::nullopt;
  constexpr std::array kAxes = {&Pairs::x, &Pairs::y, &Pairs::z};
  Pairs dividend;
  Vec3 target = points.nearest(v[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = kAxes[k];
    dividend.*axis = aa * bc.*axis + bb * ca.*axis + cc * ab.*axis;
    target[k] += (dividend.*axis).high / divisor.high;
  }
  const Vec3 center = snap_to_grid(target, grid);
  // What is left of center - origin - dividend / divisor, times the divisor.
  const Pairs reached = stages::exact_pairs(center) - origin;
  double left2 = 0;
  for (const auto axis : kAxes) {
    const double left = bound(reached.*axis * divisor - dividend.*axis);
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
