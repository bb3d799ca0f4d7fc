// Sums over triangles that need little arithmetic, because sides cancel.
#pragma once

#include <array>
#include <span>

#include "oracles/base/exact_points.h"
#include "oracles/base/exact_sum.h"

namespace tetproof::oracles {

using TriangleSpan = std::span<const std::array<Index, 3>>;

// Twice the sum of the area vectors of some triangles less that of others; exactly, in squares of
// integer units. That of a triangle is the sum over its sides of those between side and origin.
// Sides that two triangles share in opposite directions cancel, so that only the others take
// arithmetic: none, where both sets have the same outline by the definitions of its points.
std::array<ExactSum, 3> sum_of_areas2(const ExactPoints& points, TriangleSpan triangles,
                                      TriangleSpan less = {});

// Six times the sum of the volumes between the origin and some triangles, positive where these are
// seen clockwise from the origin; exactly, in cubic integer units. Of triangles that are in one
// plane by their definitions only the sides that do not cancel take arithmetic.
ExactSum sum_from_origin6(const ExactPoints& points, TriangleSpan triangles);

}  // namespace tetproof::oracles
