// Signed integers of any size; no heap for the sizes that predicates meet.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>

#include "mesher/arithmetic/words.h"
#include "mesher/base/namespaces.h"

namespace delmesher::arithmetic {

// Sign and magnitude. A heap allocation for every temporary would cost more than the arithmetic:
// determinants have dozens of them.
class BigInteger {
 public:
  using Limb = Word;

  BigInteger() = default;
  explicit BigInteger(std::int64_t value);
  // Magnitude limbs[0..n) (least significant first, leading zeros allowed) times 2^shift.
  BigInteger(const Limb* limbs, std::size_t n, bool negative, std::size_t shift = 0);
  BigInteger(const BigInteger& other) { assign(other.data(), other.used()), size_ = other.size_; }
  BigInteger(BigInteger&& other) noexcept { take(other); }
  BigInteger& operator=(const BigInteger& other);
  BigInteger& operator=(BigInteger&& other) noexcept;
  ~BigInteger() = default;

  int sign() const { return (size_ > 0) - (size_ < 0); }
  std::size_t used() const { return static_cast<std::size_t>(size_ < 0 ? -size_ : size_); }
  const Limb* data() const { return heap_ ? heap_.get() : inline_; }
  // Number of bits of the magnitude; 0 for zero.
  std::size_t bit_length() const;
  // Number of trailing zero bits of the magnitude; 0 for zero.
  std::size_t trailing_zeros() const;

  BigInteger operator-() const;
  BigInteger operator<<(std::size_t shift) const;
  // Shifts the magnitude; the bits shifted out are lost (rounds towards zero).
  BigInteger operator>>(std::size_t shift) const;
  friend BigInteger operator+(const BigInteger& a, const BigInteger& b) {
    return add(a, b, b.size_);
  }
  friend BigInteger operator-(const BigInteger& a, const BigInteger& b) {
    return add(a, b, -b.size_);
  }
  friend BigInteger operator*(const BigInteger& a, const BigInteger& b);
  // a 2^shift + b, or a 2^shift - b.
  static BigInteger shifted_sum(const BigInteger& a, std::size_t shift, const BigInteger& b,
                                bool minus);
  void negate() { size_ = -size_; }
  // As operator>>, in place.
  void drop_bits(std::size_t shift);
  friend bool operator==(const BigInteger& a, const BigInteger& b) {
    return a.size_ == b.size_ && std::memcmp(a.data(), b.data(), a.used() * sizeof(Limb)) == 0;
  }

 private:
  static constexpr std::size_t kInlineLimbs = 20;

  static BigInteger add(const BigInteger& a, const BigInteger& b, std::int32_t b_size);
  // Makes room for n limbs, forgetting the value.
  Limb* reset(std::size_t n);
  void assign(const Limb* limbs, std::size_t n);
  void take(BigInteger& other) noexcept;
  // Sets the size from n possibly zero leading limbs.
  void normalise(std::size_t n, bool negative);

  std::int32_t size_ = 0;  // number of limbs, negative for negative numbers
  std::unique_ptr<Limb[]> heap_;
  Limb inline_[kInlineLimbs];
};

}  // namespace delmesher::arithmetic
