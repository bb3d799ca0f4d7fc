#include "mesher/arithmetic/big_integer.h"

#include <algorithm>
#include <bit>

namespace delmesher::arithmetic {

BigInteger::BigInteger(std::int64_t value) {
  if (value == 0) return;
  const auto bits = static_cast<std::uint64_t>(value);
  inline_[0] = value < 0 ? ~bits + 1 : bits;
  size_ = value < 0 ? -1 : 1;
}

BigInteger::BigInteger(const Limb* limbs, std::size_t n, bool negative, std::size_t shift) {
  const std::size_t words = shift / 64;
  const unsigned bits = shift % 64;
  Limb* out = reset(n + words + 1);
  for (std::size_t i = 0; i < words; ++i) out[i] = 0;
  if (n == 0) return;
  if (bits != 0) {
    out[words + n] = shift_left(out + words, limbs, n, bits);
  } else {
    std::memcpy(out + words, limbs, n * sizeof(Limb));
    out[words + n] = 0;
  }
  normalise(n + words + 1, negative);
}

BigInteger& BigInteger::operator=(const BigInteger& other) {
  if (this != &other) {
    assign(other.data(), other.used());
    size_ = other.size_;
  }
  return *this;
}

BigInteger& BigInteger::operator=(BigInteger&& other) noexcept {
  if (this != &other) take(other);
  return *this;
}

BigInteger::Limb* BigInteger::reset(std::size_t n) {
  size_ = 0;
  if (n <= kInlineLimbs) {
    heap_.reset();
    return inline_;
  }
  heap_.reset(new Limb[n]);
  return heap_.get();
}

void BigInteger::assign(const Limb* limbs, std::size_t n) {
  Limb* out = reset(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = limbs[i];
}

void BigInteger::take(BigInteger& other) noexcept {
  heap_ = std::move(other.heap_);
  size_ = other.size_;
  if (!heap_) {
    for (std::size_t i = 0; i < used(); ++i) inline_[i] = other.inline_[i];
  }
  other.size_ = 0;
}

void BigInteger::normalise(std::size_t n, bool negative) {
  const Limb* limbs = data();
  while (n > 0 && limbs[n - 1] == 0) --n;
  size_ = negative ? -static_cast<std::int32_t>(n) : static_cast<std::int32_t>(n);
}

std::size_t BigInteger::bit_length() const {
  const std::size_t n = used();
  return n == 0 ? 0 : 64 * n - static_cast<std::size_t>(std::countl_zero(data()[n - 1]));
}

std::size_t BigInteger::trailing_zeros() const {
  const std::size_t n = used();
  for (std::size_t i = 0; i < n; ++i) {
    if (data()[i] != 0) return 64 * i + static_cast<std::size_t>(std::countr_zero(data()[i]));
  }
  return 0;
}

BigInteger BigInteger::operator-() const {
  BigInteger result = *this;
  result.size_ = -result.size_;
  return result;
}

BigInteger BigInteger::operator<<(std::size_t shift) const {
  return BigInteger(data(), used(), size_ < 0, shift);
}

BigInteger BigInteger::operator>>(std::size_t shift) const {
  const std::size_t words = shift / 64;
  const unsigned bits = shift % 64;
  BigInteger result;
  if (words >= used()) return result;
  const std::size_t n = used() - words;
  Limb* out = result.reset(n);
  if (bits != 0) {
    shift_right(out, data() + words, n, bits);
  } else {
    std::memcpy(out, data() + words, n * sizeof(Limb));
  }
  result.normalise(n, size_ < 0);
  return result;
}

BigInteger BigInteger::add(const BigInteger& a, const BigInteger& b, std::int32_t b_size) {
  const Limb* x = a.data();
  const Limb* y = b.data();
  std::size_t m = a.used(), n = b.used();
  bool x_negative = a.size_ < 0;
  bool y_negative = b_size < 0;
  if (m < n) {
    std::swap(x, y);
    std::swap(m, n);
    std::swap(x_negative, y_negative);
  }
  BigInteger result;
  if (n == 0) {
    result.assign(x, m);
    result.size_ = x_negative ? -static_cast<std::int32_t>(m) : static_cast<std::int32_t>(m);
    return result;
  }
  Limb* out = result.reset(m + 1);
  if (x_negative == y_negative) {
    out[m] = arithmetic::add(out, x, m, y, n);
    result.normalise(m + 1, x_negative);
    return result;
  }
  if (m == n && compare(x, y, n) < 0) {
    std::swap(x, y);
    std::swap(x_negative, y_negative);
  }
  subtract(out, x, m, y, n);
  result.normalise(m, x_negative);
  return result;
}

BigInteger BigInteger::shifted_sum(const BigInteger& a, std::size_t shift, const BigInteger& b,
                                   bool minus) {
  const std::size_t words = shift / 64, n = b.used();
  const unsigned bits = shift % 64;
  std::size_t m = a.used();
  BigInteger result;
  Limb* out = result.reset(std::max(m + words + 1, n) + 1);
  // The shifted a ...
  for (std::size_t i = 0; i < words; ++i) out[i] = 0;
  if (bits != 0) {
    out[words + m] = shift_left(out + words, a.data(), m, bits);
  } else {
    for (std::size_t i = 0; i < m; ++i) out[words + i] = a.data()[i];
    out[words + m] = 0;
  }
  m += words + 1;
  while (m > 0 && out[m - 1] == 0) --m;
  for (; m < n; ++m) out[m] = 0;
  // ... to which b comes.
  const bool negative = a.size_ < 0, other = (b.size_ < 0) != minus;
  if (negative == other) {
    out[m] = arithmetic::add(out, out, m, b.data(), n);
    result.normalise(m + 1, negative);
  } else if (m > n || compare(out, b.data(), n) >= 0) {
    subtract(out, out, m, b.data(), n);
    result.normalise(m, negative);
  } else {
    BigInteger difference;
    subtract(difference.reset(n), b.data(), n, out, m);
    difference.normalise(n, other);
    return difference;
  }
  return result;
}

void BigInteger::drop_bits(std::size_t shift) {
  const std::size_t words = shift / 64;
  const unsigned bits = shift % 64;
  const bool negative = size_ < 0;
  const std::size_t n = used() > words ? used() - words : 0;
  Limb* limbs = heap_ ? heap_.get() : inline_;
  if (words != 0) std::copy(limbs + words, limbs + words + n, limbs);
  if (bits != 0) shift_right(limbs, limbs, n, bits);
  normalise(n, negative);
}

BigInteger operator*(const BigInteger& a, const BigInteger& b) {
  BigInteger result;
  if (a.size_ == 0 || b.size_ == 0) return result;
  const std::size_t m = a.used();
  const std::size_t n = b.used();
  BigInteger::Limb* out = result.reset(m + n);
  if (m >= n) {
    multiply(out, a.data(), m, b.data(), n);
  } else {
    multiply(out, b.data(), n, a.data(), m);
  }
  result.normalise(m + n, (a.size_ < 0) != (b.size_ < 0));
  return result;
}

}  // namespace delmesher::arithmetic
