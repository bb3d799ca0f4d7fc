// Signed integers of a size known at compile time: products add sizes, sums keep them.
#pragma once

#include <array>
#include <cstdint>

namespace delmesher {

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

using Wide = unsigned __int128;

template <int N>
inline FixedInteger<N> operator+(const FixedInteger<N>& a, const FixedInteger<N>& b) {
  FixedInteger<N> sum;
  Wide carry = 0;
  for (int i = 0; i < N; ++i) {
    carry += Wide{a.limb[i]} + b.limb[i];
    sum.limb[i] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  return sum;
}

template <int N>
inline FixedInteger<N> operator-(const FixedInteger<N>& a, const FixedInteger<N>& b) {
  FixedInteger<N> difference;
  std::uint64_t borrow = 0;
  for (int i = 0; i < N; ++i) {
    const Wide d = Wide{a.limb[i]} - b.limb[i] - borrow;
    difference.limb[i] = static_cast<std::uint64_t>(d);
    borrow = static_cast<std::uint64_t>(d >> 64) & 1;
  }
  return difference;
}

// Subtracts b from the limbs of a from `first` on.
template <int N, int M>
inline void subtract_at(FixedInteger<N>& a, int first, const FixedInteger<M>& b) {
  std::uint64_t borrow = 0;
  for (int i = 0; i < M; ++i) {
    const Wide d = Wide{a.limb[first + i]} - b.limb[i] - borrow;
    a.limb[first + i] = static_cast<std::uint64_t>(d);
    borrow = static_cast<std::uint64_t>(d >> 64) & 1;
  }
}

template <int N, int M>
inline FixedInteger<N + M> operator*(const FixedInteger<N>& a, const FixedInteger<M>& b) {
  FixedInteger<N + M> product{};
  for (int i = 0; i < N; ++i) {
    std::uint64_t carry = 0;
    for (int j = 0; j < M; ++j) {
      const Wide t = Wide{a.limb[i]} * b.limb[j] + product.limb[i + j] + carry;
      product.limb[i + j] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    product.limb[i + M] = carry;
  }
  // A negative factor was taken for itself plus 2^(64 size): subtract the other one, shifted.
  if (a.negative()) subtract_at(product, N, b);
  if (b.negative()) subtract_at(product, M, a);
  return product;
}

inline FixedInteger<2> operator*(const FixedInteger<1>& a, const FixedInteger<1>& b) {
  const __int128 p = static_cast<__int128>(static_cast<std::int64_t>(a.limb[0])) *
                     static_cast<std::int64_t>(b.limb[0]);
  return {{static_cast<std::uint64_t>(p), static_cast<std::uint64_t>(static_cast<Wide>(p) >> 64)}};
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
  return negative ? FixedInteger<N>{} - result : result;
}

}  // namespace delmesher
