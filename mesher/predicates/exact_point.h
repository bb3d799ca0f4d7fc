// The exact coordinates of points as dyadic numbers, for code that no predicate serves.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesher/arithmetic/dyadic.h"
#include "mesher/predicates/points.h"

namespace delmesher::predicates {

using DyadicPoint = std::array<Dyadic, 3>;

// Coordinates are numerator / denominator; the denominator is odd and positive.
struct RationalPoint {
  DyadicPoint numerator;
  BigInteger denominator{1};
};

// The exact coordinates of a point of any kind.
RationalPoint exact_point(const PointStore& points, VertexId v);

// The exact coordinates of points of any kind, all times the same positive integer: for signs that
// do not depend on it.
std::vector<DyadicPoint> scaled_exact_points(const PointStore& points,
                                             std::span<const VertexId> vertices);

// Exact without a denominator, else to 2^-256 of the largest coordinate.
DyadicPoint dyadic_point(const PointStore& points, VertexId v);

}  // namespace delmesher::predicates
