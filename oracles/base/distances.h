// Squared distances of exact points, in squares of integer units (ExactPoints::exponent).
#pragma once

#include <gmpxx.h>

#include <array>

#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

mpq_class squared_distance_to_segment(const ExactPoints& points, Index v, Index a, Index b);
// The distance of the lines through ab and cd, where both are reached strictly inside their
// segments. Negative elsewhere (then an end decides), and for parallel segments.
mpq_class squared_distance_inside(const ExactPoints& points, Index a, Index b, Index c, Index d);
// The distance of a vertex from a closed triangle on which its foot lies; negative if the foot is
// outside, or the triangle is flat.
mpq_class squared_distance_to_face(const ExactPoints& points, Index v,
                                   const std::array<Index, 3>& triangle);
// Is that distance zero?
bool lies_on_face(const ExactPoints& points, Index v, const std::array<Index, 3>& triangle);
// The distance from the closed triangle, wherever the foot lies.
mpq_class squared_distance_to_triangle(const ExactPoints& points, Index v,
                                       const std::array<Index, 3>& triangle);

// The root of a squared distance in integer units, in units of length; no size over- or underflows
// before the result.
double square_root(const mpq_class& squared, long exponent);
// The component of a vector along another one, given their product in integer units, in units of
// length; and the length of one vector over that of another, likewise. No size over- or underflows
// before the result, and what is not 0 is at least the smallest double.
double component(const ExactNumber& product, const ExactVector& along, long exponent);
double length_over(const ExactVector& vector, const ExactVector& along, long exponent);
// value * 2^exponent, exactly.
mpq_class times_power_of_two(mpq_class value, long exponent);

}  // namespace tetproof::oracles
