// Arithmetic of 64-bit words and of natural numbers made of them, least significant word first.
// What compilers offer for it beyond ISO C++ is used here and nowhere else; without that, or with
// DELMESHER_PORTABLE_WORDS, plain C++ does the same.
#pragma once

#if defined(__x86_64__) && !defined(DELMESHER_PORTABLE_WORDS)
#include <immintrin.h>
#endif

#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include "mesher/base/namespaces.h"

namespace delmesher::arithmetic {

using Word = std::uint64_t;

struct DoubleWord {
  Word low, high;
};

// The portable forms, which tests compare with the others.
namespace portable {

// a + b + carry and a - b - borrow, with the new carry or borrow (0 or 1).
inline Word add_carry(Word a, Word b, Word& carry) {
  const Word sum = a + b;
  const Word result = sum + carry;
  carry = static_cast<Word>(sum < a) + static_cast<Word>(result < sum);
  return result;
}
inline Word subtract_borrow(Word a, Word b, Word& borrow) {
  const Word difference = a - b;
  const Word result = difference - borrow;
  borrow = static_cast<Word>(a < b) + static_cast<Word>(difference < borrow);
  return result;
}

// a * b + c + d, which always fits.
inline DoubleWord multiply_add(Word a, Word b, Word c, Word d) {
  constexpr Word kHalf = 0xffffffffU;
  const Word a0 = a & kHalf, a1 = a >> 32U, b0 = b & kHalf, b1 = b >> 32U;
  const Word low = a0 * b0, left = a1 * b0, right = a0 * b1;
  const Word middle = (low >> 32U) + (left & kHalf) + (right & kHalf);
  DoubleWord product{(middle << 32U) | (low & kHalf),
                     a1 * b1 + (left >> 32U) + (right >> 32U) + (middle >> 32U)};
  for (const Word x : {c, d}) {
    product.low += x;
    product.high += static_cast<Word>(product.low < x);
  }
  return product;
}

// In two's complement.
inline DoubleWord signed_multiply(Word a, Word b) {
  DoubleWord product = multiply_add(a, b, 0, 0);
  // A negative factor was taken for itself plus 2^64.
  product.high -= (b & -(a >> 63U)) + (a & -(b >> 63U));
  return product;
}

}  // namespace portable

#if defined(__x86_64__) && !defined(DELMESHER_PORTABLE_WORDS)
using Carry = unsigned char;
inline Word add_carry(Word a, Word b, Carry& carry) {
  unsigned long long sum;
  carry = _addcarry_u64(carry, a, b, &sum);
  return sum;
}
inline Word subtract_borrow(Word a, Word b, Carry& borrow) {
  unsigned long long difference;
  borrow = _subborrow_u64(borrow, a, b, &difference);
  return difference;
}
#else
using Carry = Word;
using portable::add_carry;
using portable::subtract_borrow;
#endif

#if defined(__SIZEOF_INT128__) && !defined(DELMESHER_PORTABLE_WORDS)
inline DoubleWord multiply_add(Word a, Word b, Word c, Word d) {
  // ISO C++ has no 128-bit integers: an extension that gcc and clang share.
  __extension__ using Wide = unsigned __int128;
  const Wide t = Wide{a} * b + c + d;
  return {static_cast<Word>(t), static_cast<Word>(t >> 64U)};
}
inline DoubleWord signed_multiply(Word a, Word b) {
  __extension__ using Wide = unsigned __int128;
  __extension__ using SignedWide = __int128;
  const SignedWide t = SignedWide{static_cast<std::int64_t>(a)} * static_cast<std::int64_t>(b);
  return {static_cast<Word>(t), static_cast<Word>(static_cast<Wide>(t) >> 64U)};
}
#else
using portable::multiply_add;
using portable::signed_multiply;
#endif

// --- natural numbers of n words; `out` may be x, but not overlap it otherwise

// Sum of m and n words, m >= n; the carry is returned.
Word add(Word* out, const Word* x, std::size_t m, const Word* y, std::size_t n);
// x - y >= 0, m >= n.
void subtract(Word* out, const Word* x, std::size_t m, const Word* y, std::size_t n);
// -1, 0, 1 as x is below, equal to or above y.
int compare(const Word* x, const Word* y, std::size_t n);
// m + n words, m and n positive; `out` overlaps neither.
void multiply(Word* out, const Word* x, std::size_t m, const Word* y, std::size_t n);
// x * 2^bits, 0 < bits < 64. Returns the bits that are shifted out.
Word shift_left(Word* out, const Word* x, std::size_t n, unsigned bits);
// Floor of x / 2^bits, 0 < bits < 64.
void shift_right(Word* out, const Word* x, std::size_t n, unsigned bits);

}  // namespace delmesher::arithmetic
