#include "mesher/predicates/common_denominator.h"

#include <algorithm>
#include <vector>

namespace delmesher::predicates {
namespace {

// The number as a double in [1/2, 1], up to rounding, times 2^exponent.
double normalised_double(const Dyadic& x, std::int32_t& exponent) {
  exponent = x.exponent + static_cast<std::int32_t>(x.mantissa.bit_length());
  return round_to_double({x.mantissa, x.exponent - exponent}).value;
}

}  // namespace

void to_common_denominator(std::span<RationalPoint> points) {
  std::vector<BigInteger> distinct;
  for (const RationalPoint& p : points) {
    if (p.denominator == BigInteger(1)) continue;
    if (std::find(distinct.begin(), distinct.end(), p.denominator) == distinct.end()) {
      distinct.push_back(p.denominator);
    }
  }
  for (RationalPoint& p : points) {
    const BigInteger own = p.denominator;
    for (const BigInteger& d : distinct) {
      if (d == own) continue;
      p.denominator = p.denominator * d;
      for (Dyadic& x : p.numerator) x = x * Dyadic{d, 0};
    }
  }
}

Dyadic leading_digits_of_quotient(const Dyadic& x, const Dyadic& y) {
  if (x.sign() == 0) return {};
  std::int32_t ex = 0, ey = 0;
  const double dx = normalised_double(x, ex), dy = normalised_double(y, ey);
  Dyadic quotient = Dyadic::from_double(dx / dy);
  quotient.exponent += ex - ey;
  return quotient;
}

}  // namespace delmesher::predicates
