#include "mesher/arithmetic/dyadic.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace delmesher::arithmetic {
namespace {

Dyadic normalised(BigInteger mantissa, std::int64_t exponent) {
  Dyadic result;
  if (mantissa.sign() == 0) return result;
  const std::size_t zeros = mantissa.trailing_zeros();
  result.mantissa = zeros == 0 ? std::move(mantissa) : mantissa >> zeros;
  result.exponent = static_cast<std::int32_t>(exponent + static_cast<std::int64_t>(zeros));
  return result;
}

}  // namespace

Dyadic Dyadic::from_double(double value) {
  const DoubleParts parts = decompose(value);
  const BigInteger::Limb limb = parts.magnitude;
  Dyadic result;
  result.mantissa = BigInteger(&limb, 1, parts.negative);
  result.exponent = parts.exponent;
  return result;
}

Dyadic operator+(const Dyadic& a, const Dyadic& b) {
  if (a.sign() == 0) return b;
  if (b.sign() == 0) return a;
  const std::int32_t low = std::min(a.exponent, b.exponent);
  return normalised((a.mantissa << static_cast<std::size_t>(a.exponent - low)) +
                        (b.mantissa << static_cast<std::size_t>(b.exponent - low)),
                    low);
}

Dyadic operator-(const Dyadic& a, const Dyadic& b) {
  Dyadic negative;
  negative.mantissa = -b.mantissa;
  negative.exponent = b.exponent;
  return a + negative;
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  return normalised(a.mantissa * b.mantissa, std::int64_t{a.exponent} + b.exponent);
}

Rounded round_to_double(const Dyadic& number) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (number.sign() == 0) return {0.0, 0.0};
  const auto length = static_cast<std::int64_t>(number.mantissa.bit_length());
  const std::int64_t top = number.exponent + length;  // 2^(top - 1) <= |number| < 2^top
  const double sign = number.sign();
  if (top > 1024) return {sign * kInfinity, kInfinity};
  if (top < -1074) return {0.0, std::numeric_limits<double>::denorm_min()};  // below half of it
  // Subnormal results have fewer bits than 53.
  const std::int64_t keep = std::min<std::int64_t>(53, top + 1074);
  const std::int64_t drop = length - keep;
  if (drop <= 0) {
    const auto magnitude = static_cast<double>(number.mantissa.data()[0]);
    return {sign * std::ldexp(magnitude, number.exponent), 0.0};
  }
  const BigInteger head = number.mantissa >> static_cast<std::size_t>(drop);
  std::uint64_t magnitude = head.sign() == 0 ? 0 : head.data()[0];
  const BigInteger half = number.mantissa >> static_cast<std::size_t>(drop - 1);
  // The mantissa is odd: exactly half an ulp was dropped only if a single bit was dropped.
  const bool above_half = half.sign() != 0 && (half.data()[0] & 1) != 0;
  if (above_half && (drop > 1 || (magnitude & 1) != 0)) ++magnitude;
  const auto exponent = static_cast<int>(number.exponent + drop);
  const double value = std::ldexp(static_cast<double>(magnitude), exponent);
  if (!(value <= std::numeric_limits<double>::max())) return {sign * kInfinity, kInfinity};
  // Half an ulp; below the smallest subnormal number, that number.
  return {sign * value, std::ldexp(1.0, std::max(exponent - 1, -1074))};
}

}  // namespace delmesher::arithmetic
