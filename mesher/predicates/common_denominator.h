// Points with denominators, brought to a common one; quotients.
#pragma once

#include <span>

#include "mesher/predicates/exact_point.h"

namespace delmesher::predicates {

// Multiplies numerators and denominators so that all denominators are equal.
void to_common_denominator(std::span<RationalPoint> points);

// x / y for y != 0 with a relative error below 2^-50, as a dyadic number of 53 bits; exact if the
// quotient has that few.
Dyadic leading_digits_of_quotient(const Dyadic& x, const Dyadic& y);

}  // namespace delmesher::predicates
