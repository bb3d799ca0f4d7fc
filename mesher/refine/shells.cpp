#include "mesher/refine/shells.h"

#include <cmath>

#include "mesher/geometry/vector.h"

namespace delmesher::refine {

Shells::Shells(const Plc& plc, const PointStore& points, std::span<const std::uint8_t> apex)
    : radius_(apex.size(), 0) {
  for (const PlcSegment& segment : plc.segments) {
    const double length =
        distance(points.nearest(segment.vertex[1]), points.nearest(segment.vertex[0]));
    for (const VertexId v : segment.vertex) {
      if (v >= radius_.size() || apex[v] == 0) continue;
      if (radius_[v] == 0 || length < radius_[v]) radius_[v] = length;
    }
  }
}

// How far from its end v a subsegment of that length crosses a shell in its middle third, as a
// fraction of the length; 0 if v is not an apex.
double Shells::fraction_from(VertexId v, double length) const {
  if (v >= radius_.size() || radius_[v] == 0) return 0;
  const double ratio = radius_[v] / length;
  return std::ldexp(ratio, -1 - std::ilogb(ratio * 1.5));
}

double Shells::split_fraction(VertexId a, VertexId b, double length) const {
  const double from_a = fraction_from(a, length), from_b = fraction_from(b, length);
  if (from_a == 0 && from_b == 0) return 0.5;
  const bool at_a =
      from_b == 0 || (from_a != 0 && std::abs(from_a - 0.5) <= std::abs(from_b - 0.5));
  return at_a ? from_a : 1 - from_b;
}

}  // namespace delmesher::refine
