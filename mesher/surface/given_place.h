// Where points are written that are defined by moved vertices of the surface.
#pragma once

#include <span>

#include "mesher/predicates/points.h"

namespace delmesher::surface {

// The doubles at which v is written: its nearest ones, or those of the point with the same
// parameters on the vertices as `given` (empty if they were not moved).
// `scratch` is an empty store, and is left empty.
Vec3 given_place(const PointStore& points, VertexId v, std::span<const Vec3> given,
                 PointStore& scratch);

// Appends the points of `from` that `points` does not have yet, by the same numbers, with the
// vertices of the surface as `given`. Supports are left out.
void append_as_given(const PointStore& from, std::span<const Vec3> given, PointStore& points);

}  // namespace delmesher::surface
