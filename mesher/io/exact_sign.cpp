#include "mesher/io/exact_sign.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace delmesher::io {
namespace {

// A signed integer of any size, just enough for the sign of a determinant.
class Integer {
 public:
  Integer() = default;
  // value * 2^-exponent, which has to be an integer.
  Integer(double value, int exponent);

  int sign() const { return limbs_.empty() ? 0 : (negative_ ? -1 : 1); }
  friend Integer operator+(const Integer& a, const Integer& b);
  friend Integer operator-(const Integer& a, Integer b) {
    b.negative_ = !b.negative_;
    return a + b;
  }
  friend Integer operator*(const Integer& a, const Integer& b);

 private:
  using Limbs = std::vector<std::uint32_t>;  // least significant first, no leading zeros
  static bool less(const Limbs& a, const Limbs& b);
  static Limbs sum(const Limbs& a, const Limbs& b);
  static Limbs difference(const Limbs& a, const Limbs& b);  // a >= b
  static void trim(Limbs& a) {
    while (!a.empty() && a.back() == 0) a.pop_back();
  }

  bool negative_ = false;
  Limbs limbs_;
};

// value = mantissa * 2^exponent with an odd mantissa (or 0).
void split(double value, std::int64_t& mantissa, int& exponent) {
  const double fraction = std::frexp(value, &exponent);
  mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  exponent -= 53;
  while (mantissa != 0 && mantissa % 2 == 0) {
    mantissa /= 2;
    ++exponent;
  }
}

Integer::Integer(double value, int exponent) {
  std::int64_t mantissa = 0;
  int own = 0;
  split(value, mantissa, own);
  if (mantissa == 0) return;
  negative_ = mantissa < 0;
  const std::uint64_t magnitude = static_cast<std::uint64_t>(negative_ ? -mantissa : mantissa);
  const unsigned shift = static_cast<unsigned>(own - exponent);
  limbs_.assign(shift / 32 + 3, 0);
  const std::array<std::uint64_t, 2> halves = {magnitude & 0xffffffffU, magnitude >> 32};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::uint64_t shifted = halves[i] << (shift % 32);
    limbs_[shift / 32 + i] |= static_cast<std::uint32_t>(shifted);
    limbs_[shift / 32 + i + 1] |= static_cast<std::uint32_t>(shifted >> 32);
  }
  trim(limbs_);
}

bool Integer::less(const Limbs& a, const Limbs& b) {
  if (a.size() != b.size()) return a.size() < b.size();
  return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

Integer::Limbs Integer::sum(const Limbs& a, const Limbs& b) {
  Limbs out(std::max(a.size(), b.size()) + 1);
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    carry += (i < a.size() ? a[i] : 0ULL) + (i < b.size() ? b[i] : 0ULL);
    out[i] = static_cast<std::uint32_t>(carry);
    carry >>= 32;
  }
  trim(out);
  return out;
}

Integer::Limbs Integer::difference(const Limbs& a, const Limbs& b) {
  Limbs out(a.size());
  std::int64_t borrow = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::int64_t digit = std::int64_t{a[i]} - borrow - (i < b.size() ? std::int64_t{b[i]} : 0);
    borrow = digit < 0 ? 1 : 0;
    if (borrow != 0) digit += std::int64_t{1} << 32;
    out[i] = static_cast<std::uint32_t>(digit);
  }
  trim(out);
  return out;
}

Integer operator+(const Integer& a, const Integer& b) {
  Integer out;
  if (a.negative_ == b.negative_) {
    out.negative_ = a.negative_;
    out.limbs_ = Integer::sum(a.limbs_, b.limbs_);
  } else {
    const bool swap = Integer::less(a.limbs_, b.limbs_);
    out.negative_ = swap ? b.negative_ : a.negative_;
    out.limbs_ = Integer::difference(swap ? b.limbs_ : a.limbs_, swap ? a.limbs_ : b.limbs_);
  }
  return out;
}

Integer operator*(const Integer& a, const Integer& b) {
  Integer out;
  out.negative_ = a.negative_ != b.negative_;
  out.limbs_.assign(a.limbs_.size() + b.limbs_.size(), 0);
  for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.limbs_.size(); ++j) {
      carry += out.limbs_[i + j] + std::uint64_t{a.limbs_[i]} * b.limbs_[j];
      out.limbs_[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    out.limbs_[i + b.limbs_.size()] = static_cast<std::uint32_t>(carry);
  }
  Integer::trim(out.limbs_);
  return out;
}

// The largest power of two that divides all the values.
int common_exponent(std::span<const double> values) {
  int smallest = std::numeric_limits<int>::max();
  for (double value : values) {
    std::int64_t mantissa = 0;
    int exponent = 0;
    split(value, mantissa, exponent);
    if (mantissa != 0) smallest = std::min(smallest, exponent);
  }
  return smallest == std::numeric_limits<int>::max() ? 0 : smallest;
}

}  // namespace

int orient2d_sign(const std::array<double, 2>& a, const std::array<double, 2>& b,
                  const std::array<double, 2>& c) {
  const double acx = a[0] - c[0], bcy = b[1] - c[1], acy = a[1] - c[1], bcx = b[0] - c[0];
  const double left = acx * bcy, right = acy * bcx, det = left - right;
  // Differences carry a relative error of 2^-53 each, products and their difference one more, so
  // 4.1 * 2^-53 of |left| + |right| covers them; the tiny term covers underflow.
  const double bound = 4.6e-16 * (std::fabs(left) + std::fabs(right)) + 1e-290;
  if (std::fabs(det) > bound && std::isfinite(det)) return det > 0 ? 1 : -1;
  if ((acx == 0 || bcy == 0) && (acy == 0 || bcx == 0)) return 0;
  const std::array<double, 6> values = {a[0], a[1], b[0], b[1], c[0], c[1]};
  const int e = common_exponent(values);
  const Integer cx(c[0], e), cy(c[1], e);
  return ((Integer(a[0], e) - cx) * (Integer(b[1], e) - cy) -
          (Integer(a[1], e) - cy) * (Integer(b[0], e) - cx))
      .sign();
}

bool coplanar(const std::array<double, 3>& a, const std::array<double, 3>& b,
              const std::array<double, 3>& c, const std::array<double, 3>& d) {
  std::vector<double> values;
  for (std::size_t i = 0; i < 3; ++i) {
    if (a[i] == b[i] && a[i] == c[i] && a[i] == d[i]) return true;
    values.insert(values.end(), {a[i], b[i], c[i], d[i]});
  }
  const int e = common_exponent(values);
  std::array<std::array<Integer, 3>, 3> m;
  for (std::size_t i = 0; i < 3; ++i) {
    const Integer origin(d[i], e);
    m[0][i] = Integer(a[i], e) - origin;
    m[1][i] = Integer(b[i], e) - origin;
    m[2][i] = Integer(c[i], e) - origin;
  }
  Integer det;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    det = det + m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j]);
  }
  return det.sign() == 0;
}

}  // namespace delmesher::io
