// Where points of a stand-in surface are written.
#pragma once

#include <span>

#include "mesher/predicates/points.h"

namespace delmesher::surface {

// The doubles at which v is written: its nearest ones, or, where the surface is a stand-in, those
// of the point with the same parameters on the vertices as `given` (empty if there is no stand-in).
// `scratch` is an empty store, and is left empty.
Vec3 given_place(const PointStore& points, VertexId v, std::span<const Vec3> given,
                 PointStore& scratch);

// Appends the points of `from` that `points` does not have yet, by the same numbers, with the
// vertices of the surface as `given`. Supports are left out.
void append_as_given(const PointStore& from, std::span<const Vec3> given, PointStore& points);

}  // namespace delmesher::surface
