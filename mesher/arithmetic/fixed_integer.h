// Signed integers of a size known at compile time: products add sizes, sums keep them.
#pragma once

#include <array>
#include <cstdint>

#include "mesher/arithmetic/words.h"
#include "mesher/base/namespaces.h"

namespace delmesher::arithmetic {

// Two's complement, least significant limb first. Nothing checks for overflow: callers prove that
// values fit (see predicates/polynomials.h). Products cannot overflow.
template <int N>
struct FixedInteger {
  std::array<std::uint64_t, N> limb;

  bool negative() const { return (limb[N - 1] >> 63) != 0; }

  int sign() const {
    if (negative()) return -1;
    std::uint64_t any = 0;
    for (const std::uint64_t x : limb) any |= x;
    return any != 0 ? 1 : 0;
  }
};

template <int N>
inline FixedInteger<N> operator+(const FixedInteger<N>& a, const FixedInteger<N>& b) {
  FixedInteger<N> sum;
  Carry carry = 0;
  for (int i = 0; i < N; ++i) sum.limb[i] = add_carry(a.limb[i], b.limb[i], carry);
  return sum;
}

template <int N>
inline FixedInteger<N> operator-(const FixedInteger<N>& a, const FixedInteger<N>& b) {
  FixedInteger<N> difference;
  Carry borrow = 0;
  for (int i = 0; i < N; ++i) difference.limb[i] = subtract_borrow(a.limb[i], b.limb[i], borrow);
  return difference;
}

// Subtracts b from the limbs of a from `first` on if the mask is all ones, nothing if it is 0.
// Signs are random: branches would be mispredicted.
template <int N, int M>
inline void subtract_masked(FixedInteger<N>& a, int first, const FixedInteger<M>& b,
                            std::uint64_t mask) {
  Carry borrow = 0;
  for (int i = 0; i < M; ++i) {
    a.limb[first + i] = subtract_borrow(a.limb[first + i], b.limb[i] & mask, borrow);
  }
}

template <int N, int M>
inline FixedInteger<N + M> operator*(const FixedInteger<N>& a, const FixedInteger<M>& b) {
  FixedInteger<N + M> product{};
  for (int i = 0; i < N; ++i) {
    std::uint64_t carry = 0;
    for (int j = 0; j < M; ++j) {
      const DoubleWord t = multiply_add(a.limb[i], b.limb[j], product.limb[i + j], carry);
      product.limb[i + j] = t.low;
      carry = t.high;
    }
    product.limb[i + M] = carry;
  }
  // A negative factor was taken for itself plus 2^(64 size): subtract the other one, shifted.
  subtract_masked(product, N, b, -(a.limb[N - 1] >> 63));
  subtract_masked(product, M, a, -(b.limb[M - 1] >> 63));
  return product;
}

inline FixedInteger<2> operator*(const FixedInteger<1>& a, const FixedInteger<1>& b) {
  const DoubleWord p = signed_multiply(a.limb[0], b.limb[0]);
  return {{p.low, p.high}};
}

// limbs[0..size) * 2^shift, which must be below 2^(64 N - 1), with a sign.
template <int N>
inline FixedInteger<N> fixed_integer(const std::uint64_t* limbs, int size, bool negative,
                                     int shift) {
  FixedInteger<N> result{};
  const int words = shift / 64;
  const int bits = shift % 64;
  for (int i = 0; i < size; ++i) {
    result.limb[i + words] |= limbs[i] << bits;
    if (bits != 0 && i + words + 1 < N) result.limb[i + words + 1] = limbs[i] >> (64 - bits);
  }
  // Complement and add one if negative.
  const std::uint64_t mask = -std::uint64_t{negative};
  Carry carry = static_cast<Carry>(negative);
  for (int i = 0; i < N; ++i) result.limb[i] = add_carry(result.limb[i] ^ mask, 0, carry);
  return result;
}

}  // namespace delmesher::arithmetic
