// Exact dyadic numbers: integer times power of two. Every finite double is one.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "mesher/arithmetic/big_integer.h"
#include "mesher/base/namespaces.h"

namespace delmesher::arithmetic {

// mantissa * 2^exponent with an odd mantissa, or zero with exponent 0.
struct Dyadic {
  BigInteger mantissa;
  std::int32_t exponent = 0;

  static Dyadic from_double(double value);
  int sign() const { return mantissa.sign(); }
};

Dyadic operator+(const Dyadic& a, const Dyadic& b);
Dyadic operator-(const Dyadic& a, const Dyadic& b);
Dyadic operator*(const Dyadic& a, const Dyadic& b);

// A double and a bound on its distance from the number it stands for (0 if exact).
struct Rounded {
  double value;
  double error;
};

// The nearest double, ties to even; infinite with infinite error beyond the range of doubles.
Rounded round_to_double(const Dyadic& number);

// A finite nonzero double as (odd integer) * 2^exponent with sign; magnitude 0 for zero.
struct DoubleParts {
  std::uint64_t magnitude;
  std::int32_t exponent;
  bool negative;
};
inline DoubleParts decompose(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto biased = static_cast<std::int32_t>((bits >> 52) & 0x7ff);
  std::uint64_t magnitude = bits & ((std::uint64_t{1} << 52) - 1);
  if (biased != 0) magnitude |= std::uint64_t{1} << 52;
  if (magnitude == 0) return {0, 0, false};
  const int zeros = std::countr_zero(magnitude);
  // Subnormal numbers have the exponent of the smallest normal ones.
  return {magnitude >> zeros, std::max(biased, 1) - 1075 + zeros, (bits >> 63) != 0};
}

}  // namespace delmesher::arithmetic
