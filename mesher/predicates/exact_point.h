// The exact coordinates of points as dyadic numbers, for code that no predicate serves.
#pragma once

#include <array>

#include "mesher/arithmetic/dyadic.h"
#include "mesher/predicates/points.h"

namespace delmesher::predicates {

using DyadicPoint = std::array<Dyadic, 3>;

// Of a point of any kind.
DyadicPoint exact_point(const PointStore& points, VertexId v);

}  // namespace delmesher::predicates
