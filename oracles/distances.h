// Squared distances of exact points, in integer units (ExactPoints::exponent).
#pragma once

#include <gmpxx.h>

#include <array>

#include "oracles/exact_points.h"

namespace tetproof::oracles {

mpq_class squared_distance_to_segment(const ExactPoints& points, Index v, Index a, Index b);
// Of the insides of two segments: at most that of their lines where that is reached inside both;
// negative if it is not (then an end is involved).
mpq_class squared_distance_inside(const ExactPoints& points, Index a, Index b, Index c, Index d);
// Of a vertex to the closed triangle where its foot lies on it; negative if it does not.
mpq_class squared_distance_to_face(const ExactPoints& points, Index v,
                                   const std::array<Index, 3>& triangle);
// The same wherever its foot lies.
mpq_class squared_distance_to_triangle(const ExactPoints& points, Index v,
                                       const std::array<Index, 3>& triangle);

// Of a squared distance, in units of length, whatever its size.
double square_root(const mpq_class& squared, long exponent);
// value * 2^exponent, exactly.
mpq_class times_power_of_two(mpq_class value, long exponent);

}  // namespace tetproof::oracles
