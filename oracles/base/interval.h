// Intervals of doubles, rounded outwards without touching the rounding mode. They only ever certify
// a sign. Where they are not certain, integers decide (exact_points.h).
#pragma once

#include <cmath>
#include <limits>

namespace tetproof::oracles {

struct Interval {
  double low = 0, high = 0;

  Interval() = default;
  Interval(double value) : low(value), high(value) {}  // NOLINT: a double is an interval
  Interval(double l, double h) : low(l), high(h) {}

  double middle() const { return low / 2 + high / 2; }

  // The result of one rounded operation is off by at most half an ulp, or by half the smallest
  // subnormal; the margin is several times that, so its own rounding does no harm. Infinite and
  // NaN bounds stay so and certify nothing.
  static double margin(double x) {
    // A product would be computed each time where rounding modes change, and slowly, as it is tiny.
    constexpr double kFourLeast = 0x1p-1072;
    return std::fabs(x) * 0x1p-51 + kFourLeast;
  }
  static Interval around(double l, double h) { return {l - margin(l), h + margin(h)}; }

  // 1, -1 or 0 if certain, 2 if not (also for an exact zero that is not seen to be one).
  int sign() const {
    if (low > 0) return 1;
    if (high < 0) return -1;
    return low == 0 && high == 0 ? 0 : 2;
  }
};

inline Interval operator+(Interval a, Interval b) {
  return Interval::around(a.low + b.low, a.high + b.high);
}
inline Interval operator-(Interval a, Interval b) {
  return Interval::around(a.low - b.high, a.high - b.low);
}
inline Interval operator-(Interval a) {
  return {-a.high, -a.low};
}
inline Interval operator*(Interval a, Interval b) {
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  const double sum = p + q + r + s;
  if (!(sum - sum == 0)) {  // something has overflowed
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  const double low_pq = p < q ? p : q, low_rs = r < s ? r : s;
  const double high_pq = p < q ? q : p, high_rs = r < s ? s : r;
  return Interval::around(low_pq < low_rs ? low_pq : low_rs, high_pq > high_rs ? high_pq : high_rs);
}

}  // namespace tetproof::oracles
