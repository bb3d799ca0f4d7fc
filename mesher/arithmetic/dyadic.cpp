#include "mesher/arithmetic/dyadic.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace delmesher::arithmetic {
namespace {

Dyadic normalised(Dyadic x, std::int64_t exponent) {
  if (x.sign() == 0) return x;
  const std::size_t zeros = x.mantissa.trailing_zeros();
  if (zeros != 0) x.mantissa.drop_bits(zeros);
  x.exponent = static_cast<std::int32_t>(exponent + static_cast<std::int64_t>(zeros));
  return x;
}

// ldexp(x, exponent) for a whole number below 2^54: without a call where no power of two is beyond
// the normal doubles.
double scaled(double x, int exponent) {
  if (exponent < -1022 || exponent > 969) return std::ldexp(x, exponent);
  return x * std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52U);
}

// The 64 bits of the magnitude from this one on.
std::uint64_t bits_from(const BigInteger& x, std::size_t first) {
  const std::size_t word = first / 64, bits = first % 64;
  if (word >= x.used()) return 0;
  const std::uint64_t low = x.data()[word] >> bits;
  return bits == 0 || word + 1 == x.used() ? low : low | x.data()[word + 1] << (64 - bits);
}

// a + b, or a - b.
Dyadic sum(const Dyadic& a, const Dyadic& b, bool minus) {
  if (b.sign() == 0) return a;
  if (a.sign() == 0) {
    Dyadic result = b;
    if (minus) result.mantissa.negate();
    return result;
  }
  const auto [low, high] = std::minmax(a.exponent, b.exponent);
  const auto shift = static_cast<std::size_t>(high - low);
  if (a.exponent == high) {
    return normalised({BigInteger::shifted_sum(a.mantissa, shift, b.mantissa, minus)}, low);
  }
  Dyadic result{BigInteger::shifted_sum(b.mantissa, shift, a.mantissa, minus)};
  if (minus) result.mantissa.negate();
  return normalised(std::move(result), low);
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
  return sum(a, b, false);
}

Dyadic operator-(const Dyadic& a, const Dyadic& b) {
  return sum(a, b, true);
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  return normalised({a.mantissa * b.mantissa}, std::int64_t{a.exponent} + b.exponent);
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
    return {sign * scaled(magnitude, number.exponent), 0.0};
  }
  std::uint64_t magnitude = bits_from(number.mantissa, static_cast<std::size_t>(drop));
  // The mantissa is odd: exactly half an ulp was dropped only if a single bit was dropped.
  const bool above_half = (bits_from(number.mantissa, static_cast<std::size_t>(drop - 1)) & 1) != 0;
  if (above_half && (drop > 1 || (magnitude & 1) != 0)) ++magnitude;
  const auto exponent = static_cast<int>(number.exponent + drop);
  const double value = scaled(static_cast<double>(magnitude), exponent);
  if (!(value <= std::numeric_limits<double>::max())) return {sign * kInfinity, kInfinity};
  // Half an ulp; below the smallest subnormal number, that number.
  return {sign * value, scaled(1.0, std::max(exponent - 1, -1074))};
}

}  // namespace delmesher::arithmetic
