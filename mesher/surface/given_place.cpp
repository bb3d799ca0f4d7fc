#include "mesher/surface/given_place.h"

#include <algorithm>

namespace delmesher::surface {

Vec3 given_place(const PointStore& points, VertexId v, std::span<const Vec3> given,
                 PointStore& scratch) {
  if (given.empty()) return points.nearest(v);
  const auto corner = [&](VertexId w) { return w < given.size() ? given[w] : points.nearest(w); };
  if (points.is_corner(v)) return corner(v);
  PointDefinition d = points.definition(v);
  if (std::ranges::all_of(d.corner, [&](VertexId w) {
        return w == kNone || (points.is_explicit(w) && corner(w) == points.nearest(w));
      })) {
    return points.nearest(v);
  }
  VertexId next = 0;
  for (VertexId& w : d.corner) {
    if (w == kNone) continue;
    const Vec3 x = corner(w);
    w = next++;
    scratch.add_explicit(x[0], x[1], x[2]);
  }
  const Vec3 place = scratch.nearest(scratch.add(d));
  scratch.truncate(0);
  return place;
}

void append_as_given(const PointStore& from, std::span<const Vec3> given, PointStore& points) {
  points.reserve(from.size());
  for (auto v = static_cast<VertexId>(points.size()); v < from.size(); ++v) {
    const bool is_given = v < given.size();
    if (is_given || from.is_explicit(v)) {
      const Vec3 x = is_given ? given[v] : from.nearest(v);
      points.add_explicit(x[0], x[1], x[2]);
    } else {
      points.add(from.definition(v));
    }
  }
}

}  // namespace delmesher::surface
