// An exact number: an integer, or one over an odd denominator. Only the coordinates of points on
// three planes, and of points placed relative to those, have denominators; all others pay for it
// with a null test.
#pragma once

#include <gmpxx.h>

#include <memory>
#include <utility>

namespace tetproof::oracles {

class ExactNumber {
  // Odd, above 1; null: 1. Every coordinate has one, so an empty one is as small as possible.
  class Denominator {
   public:
    Denominator() = default;
    explicit Denominator(mpz_class value)
        : value_(value == 1 ? nullptr : std::make_unique<mpz_class>(std::move(value))) {}
    Denominator(const Denominator& other)
        : value_(other.value_ ? std::make_unique<mpz_class>(*other.value_) : nullptr) {}
    Denominator(Denominator&&) noexcept = default;
    Denominator& operator=(const Denominator& other) {
      return *this = Denominator(other);  // NOLINT: copied, then moved
    }
    Denominator& operator=(Denominator&&) noexcept = default;
    ~Denominator() = default;

    explicit operator bool() const { return value_ != nullptr; }
    const mpz_class& operator*() const { return *value_; }

   private:
    std::unique_ptr<mpz_class> value_;
  };

 public:
  ExactNumber() = default;
  ExactNumber(long value) : numerator_(value) {}  // NOLINT: an integer is such a number
  ExactNumber(int value) : numerator_(value) {}   // NOLINT
  ExactNumber(mpz_class value) : numerator_(std::move(value)) {}  // NOLINT
  // The rational must be in lowest terms and have an odd denominator.
  explicit ExactNumber(const mpq_class& value) : numerator_(value.get_num()) {
    denominator_ = Denominator(mpz_class(value.get_den()));
  }

  bool is_integer() const { return !denominator_; }
  const mpz_class& numerator() const { return numerator_; }
  mpz_class denominator() const { return denominator_ ? *denominator_ : mpz_class(1); }
  mpq_class rational() const {
    if (!denominator_) return mpq_class(numerator_);
    mpq_class result(numerator_, *denominator_);
    result.canonicalize();
    return result;
  }

  // Sets an integer, in memory that is there already.
  void assign(const mpz_class& value) {
    numerator_ = value;
    denominator_ = {};
  }

  ExactNumber operator-() const { return {mpz_class(-numerator_), denominator_}; }
  friend ExactNumber operator+(const ExactNumber& a, const ExactNumber& b) {
    if (a.same_denominator(b)) return {mpz_class(a.numerator_ + b.numerator_), a.denominator_};
    return a.plus(b, 1);
  }
  friend ExactNumber operator-(const ExactNumber& a, const ExactNumber& b) {
    if (a.same_denominator(b)) return {mpz_class(a.numerator_ - b.numerator_), a.denominator_};
    return a.plus(b, -1);
  }
  friend ExactNumber operator*(const ExactNumber& a, const ExactNumber& b) {
    Denominator denominator = a.denominator_ ? a.denominator_ : b.denominator_;
    if (a.denominator_ && b.denominator_) {
      denominator = Denominator(mpz_class(*a.denominator_ * *b.denominator_));
    }
    return {mpz_class(a.numerator_ * b.numerator_), std::move(denominator)};
  }
  ExactNumber& operator+=(const ExactNumber& b) {
    if (is_integer() && b.is_integer()) {
      numerator_ += b.numerator_;
    } else {
      *this = *this + b;
    }
    return *this;
  }
  ExactNumber& operator-=(const ExactNumber& b) {
    if (is_integer() && b.is_integer()) {
      numerator_ -= b.numerator_;
    } else {
      *this = *this - b;
    }
    return *this;
  }

  // Times 2^exponent. The result must have an odd denominator as well.
  ExactNumber shifted(long exponent) const {
    mpz_class n = numerator_;
    if (exponent >= 0) {
      n <<= static_cast<unsigned long>(exponent);
    } else {
      n >>= static_cast<unsigned long>(-exponent);
    }
    return {std::move(n), denominator_};
  }

  friend int sgn(const ExactNumber& a) { return sgn(a.numerator_); }
  friend int cmp(const ExactNumber& a, const ExactNumber& b) {
    if (a.same_denominator(b)) return cmp(a.numerator_, b.numerator_);
    return sgn(a - b);
  }
  friend ExactNumber abs(const ExactNumber& a) { return sgn(a) < 0 ? -a : a; }
  friend bool operator==(const ExactNumber& a, const ExactNumber& b) { return cmp(a, b) == 0; }
  friend auto operator<=>(const ExactNumber& a, const ExactNumber& b) { return cmp(a, b) <=> 0; }

 private:
  ExactNumber(mpz_class numerator, Denominator denominator)
      : numerator_(std::move(numerator)), denominator_(std::move(denominator)) {}

  bool same_denominator(const ExactNumber& b) const {
    if (!denominator_ || !b.denominator_) return !denominator_ && !b.denominator_;
    return *denominator_ == *b.denominator_;
  }
  // Over the least common denominator: sums of many numbers share most factors.
  ExactNumber plus(const ExactNumber& b, int sign) const {
    const mpz_class p = denominator(), q = b.denominator(), common = gcd(p, q),
                    a_times = q / common, b_times = p / common;
    mpz_class n = numerator_ * a_times + sign * b.numerator_ * b_times;
    return {std::move(n), Denominator(mpz_class(p * a_times))};
  }

  mpz_class numerator_;
  Denominator denominator_;
};

inline mpq_class ratio(const ExactNumber& a, const ExactNumber& b) {
  return a.rational() / b.rational();
}

}  // namespace tetproof::oracles
