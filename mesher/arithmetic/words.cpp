#include "mesher/arithmetic/words.h"

namespace delmesher::arithmetic {

Word add(Word* out, const Word* x, std::size_t m, const Word* y, std::size_t n) {
  Carry carry = 0;
  for (std::size_t i = 0; i < n; ++i) out[i] = add_carry(x[i], y[i], carry);
  for (std::size_t i = n; i < m; ++i) out[i] = add_carry(x[i], 0, carry);
  return carry;
}

void subtract(Word* out, const Word* x, std::size_t m, const Word* y, std::size_t n) {
  Carry borrow = 0;
  for (std::size_t i = 0; i < n; ++i) out[i] = subtract_borrow(x[i], y[i], borrow);
  for (std::size_t i = n; i < m; ++i) out[i] = subtract_borrow(x[i], 0, borrow);
}

int compare(const Word* x, const Word* y, std::size_t n) {
  for (std::size_t i = n; i-- > 0;) {
    if (x[i] != y[i]) return x[i] < y[i] ? -1 : 1;
  }
  return 0;
}

// By rows. The numbers of predicates have up to a few dozen words, where nothing else is faster.
void multiply(Word* out, const Word* x, std::size_t m, const Word* y, std::size_t n) {
  Word carry = 0;
  for (std::size_t i = 0; i < m; ++i) {
    const DoubleWord t = multiply_add(x[i], y[0], carry, 0);
    out[i] = t.low;
    carry = t.high;
  }
  out[m] = carry;
  for (std::size_t j = 1; j < n; ++j) {
    carry = 0;
    for (std::size_t i = 0; i < m; ++i) {
      const DoubleWord t = multiply_add(x[i], y[j], out[i + j], carry);
      out[i + j] = t.low;
      carry = t.high;
    }
    out[m + j] = carry;
  }
}

Word shift_left(Word* out, const Word* x, std::size_t n, unsigned bits) {
  Word carry = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Word word = x[i];
    out[i] = (word << bits) | carry;
    carry = word >> (64U - bits);
  }
  return carry;
}

void shift_right(Word* out, const Word* x, std::size_t n, unsigned bits) {
  for (std::size_t i = 0; i + 1 < n; ++i) out[i] = (x[i] >> bits) | (x[i + 1] << (64U - bits));
  if (n > 0) out[n - 1] = x[n - 1] >> bits;
}

}  // namespace delmesher::arithmetic
