// Sums of many exact numbers. A common denominator would outgrow all memory, so terms with
// denominators are kept as residues modulo two primes of 61 bits and as a value in fixed point. Two
// sums that are called equal are so, except for a chance of 2^-120.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "oracles/base/exact_number.h"

namespace tetproof::oracles {

class ExactSum {
 public:
  ExactSum() = default;
  explicit ExactSum(const ExactNumber& value) { *this += value; }
  ExactSum(const ExactSum& other)
      : integers_(other.integers_),
        fractions_(other.fractions_ ? std::make_unique<Fractions>(*other.fractions_) : nullptr) {}
  ExactSum(ExactSum&&) noexcept = default;
  ExactSum& operator=(const ExactSum& other) {
    return *this = ExactSum(other);  // NOLINT: copied, then moved
  }
  ExactSum& operator=(ExactSum&&) noexcept = default;
  ~ExactSum() = default;

  ExactSum& operator+=(const ExactNumber& value) {
    if (value.is_integer()) {
      integers_ += value.numerator();
    } else {
      add_fraction(value);
    }
    return *this;
  }
  ExactSum& operator-=(const ExactNumber& value) { return *this += -value; }

  // Exact without denominators, else equal as far as residues tell.
  friend bool operator==(const ExactSum& a, const ExactSum& b);
  int sign() const { return sgn(fixed()); }
  // Is |a - b| times `factor` at most c? Terms with denominators count in fixed point.
  friend bool within(const ExactSum& a, const ExactSum& b, long factor, const ExactSum& c);
  // Of a positive sum, to be compared: the nearest number of 24 bits, of two the larger one, as its
  // exponent and its bits. Else zeros.
  std::array<std::uint64_t, 2> rounded() const;
  // The value, or the difference, times 2^exponent, to an ulp.
  double value(long exponent) const;
  friend double difference(const ExactSum& a, const ExactSum& b, long exponent);

 private:
  // The terms with denominators.
  struct Fractions {
    mpz_class fixed;  // in units of 2^-kFraction, off by less than one for each term
    std::array<mpz_class, 2> residues{};
    unsigned long count = 0;
    bool known = true;  // no prime divided a denominator
  };
  static constexpr unsigned kFraction = 128;  // bits of the fixed point

  void add_fraction(const ExactNumber& value);
  mpz_class fixed() const;

  mpz_class integers_;  // the other terms
  std::unique_ptr<Fractions> fractions_;
};

}  // namespace tetproof::oracles
