// Numbers with running error bounds: a double, and an unevaluated sum of two doubles.
//
// Both follow the same contract: |exact - value| <= error, or error is not finite (overflow) and
// nothing is known. sign() returns kUnknownSign unless the sign of the exact number is certain.
// Bounds are a posteriori: a correctly rounded operation with result r has error <= u |r|, u =
// 2^-53 (also for sums in the subnormal range, which are exact); products add the error of
// underflow.
#pragma once

#include <cmath>

#include "mesher/arithmetic/floating_point.h"
#include "mesher/base/namespaces.h"

namespace delmesher::arithmetic {

inline constexpr int kUnknownSign = 2;
inline constexpr double kRoundoff = 0x1p-53;
// The terms of an error bound are computed with at most 16 rounded operations, each of relative
// error u: multiplying by 1 + 32 u makes up for them.
inline constexpr double kInflate = 1 + 0x1p-48;
// At most 16 products per operation may underflow, each with an error of at most 2^-1075.
inline constexpr double kUnderflow = 0x1p-1070;

// value +- error. NaN-safe: an infinite or NaN error compares as unknown.
struct Bounded {
  double value = 0;
  double error = 0;

  int sign() const {
    if (value > error) return 1;
    if (value < -error) return -1;
    return value == 0 && error == 0 ? 0 : kUnknownSign;
  }
};

inline Bounded bounded_sum(double value, const Bounded& a, const Bounded& b) {
  return {value, (a.error + b.error + std::fabs(value) * kRoundoff) * kInflate};
}

inline Bounded operator+(const Bounded& a, const Bounded& b) {
  return bounded_sum(a.value + b.value, a, b);
}

inline Bounded operator-(const Bounded& a, const Bounded& b) {
  return bounded_sum(a.value - b.value, a, b);
}

inline Bounded operator*(const Bounded& a, const Bounded& b) {
  const double value = a.value * b.value;
  return {value, (std::fabs(a.value) * b.error + std::fabs(b.value) * a.error + a.error * b.error +
                  std::fabs(value) * kRoundoff + kUnderflow) *
                     kInflate};
}

// high + low +- error, |low| <= ulp(high) / 2.
struct BoundedPair {
  double high = 0;
  double low = 0;
  double error = 0;

  int sign() const {
    // high and low are a rounded sum, so high carries the sign; comparing with the low part moved
    // to the other side rounds once: inflate.
    if (high > (error + std::fabs(low)) * kInflate) return 1;
    if (-high > (error + std::fabs(low)) * kInflate) return -1;
    return high == 0 && low == 0 && error == 0 ? 0 : kUnknownSign;
  }
};

// a + b = sum + tail exactly (Knuth), barring overflow.
inline void two_sum(double a, double b, double& sum, double& tail) {
  sum = a + b;
  const double bb = sum - a;
  tail = (a - (sum - bb)) + (b - bb);
}

// a * b = product + tail (Dekker, without fused operations); exact up to the underflow of five
// partial products. Overflow (beyond 2^996) gives NaN.
inline void two_product(double a, double b, double& product, double& tail) {
  constexpr double kSplit = 0x1p27 + 1;
  product = a * b;
  const double ca = kSplit * a;
  const double ah = ca - (ca - a);
  const double al = a - ah;
  const double cb = kSplit * b;
  const double bh = cb - (cb - b);
  const double bl = b - bh;
  tail = ((ah * bh - product) + ah * bl + al * bh) + al * bl;
}

inline BoundedPair operator+(const BoundedPair& a, const BoundedPair& b) {
  double s, t, v, w;
  two_sum(a.high, b.high, s, t);
  two_sum(a.low, b.low, v, w);
  const double c = t + v;  // rounded
  double s2, t2;
  two_sum(s, c, s2, t2);
  const double d = t2 + w;  // rounded
  BoundedPair result;
  two_sum(s2, d, result.high, result.low);
  result.error = (a.error + b.error + (std::fabs(c) + std::fabs(d)) * kRoundoff) * kInflate;
  return result;
}

inline BoundedPair operator-(const BoundedPair& a) {
  return {-a.high, -a.low, a.error};
}

inline BoundedPair operator-(const BoundedPair& a, const BoundedPair& b) {
  return a + -b;
}

inline BoundedPair operator*(const BoundedPair& a, const BoundedPair& b) {
  double p, tail;
  two_product(a.high, b.high, p, tail);
  const double x = a.high * b.low;  // rounded
  const double y = a.low * b.high;  // rounded
  const double z = x + y;           // rounded
  const double r = tail + z;        // rounded
  BoundedPair result;
  two_sum(p, r, result.high, result.low);
  const double neglected = std::fabs(a.low * b.low);
  const double rounding = (std::fabs(x) + std::fabs(y) + std::fabs(z) + std::fabs(r)) * kRoundoff;
  const double inherited = (std::fabs(a.high) + std::fabs(a.low)) * b.error +
                           (std::fabs(b.high) + std::fabs(b.low)) * a.error + a.error * b.error;
  result.error = (inherited + rounding + neglected + kUnderflow) * kInflate;
  return result;
}

}  // namespace delmesher::arithmetic
