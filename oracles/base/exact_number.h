// An exact number: an integer, or one over an odd denominator, not in lowest terms. Only the
// coordinates of points on three planes, and of points placed relative to those, have denominators;
// all others pay for it with a null test.
#pragma once

#include <gmpxx.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

namespace tetproof::oracles {

class ExactNumber {
 public:
  // Odd, above 1; null: 1. Every coordinate has one, so an empty one is as small as possible.
  // Numbers share theirs, so most comparisons are of pointers.
  class Denominator {
    struct Shared {
      mpz_class value;
      std::atomic<std::uint32_t> uses = 1;
    };

   public:
    Denominator() = default;
    explicit Denominator(mpz_class value)
        : shared_(value == 1 ? nullptr : new Shared{std::move(value)}) {}
    Denominator(const Denominator& other) : shared_(other.shared_) {
      if (shared_ != nullptr) shared_->uses.fetch_add(1, std::memory_order_relaxed);
    }
    Denominator(Denominator&& other) noexcept : shared_(std::exchange(other.shared_, nullptr)) {}
    Denominator& operator=(Denominator other) noexcept {
      std::swap(shared_, other.shared_);
      return *this;
    }
    ~Denominator() {
      if (shared_ != nullptr && shared_->uses.fetch_sub(1, std::memory_order_acq_rel) == 1) {
        delete shared_;  // NOLINT: counted
      }
    }

    explicit operator bool() const { return shared_ != nullptr; }
    const mpz_class& operator*() const { return shared_->value; }
    bool operator==(const Denominator& other) const {
      if (shared_ == other.shared_) return true;
      return shared_ != nullptr && other.shared_ != nullptr && **this == *other;
    }

   private:
    Shared* shared_ = nullptr;
  };

  ExactNumber() = default;
  ExactNumber(long value) : numerator_(value) {}  // NOLINT: an integer is such a number
  ExactNumber(int value) : numerator_(value) {}   // NOLINT
  ExactNumber(mpz_class value) : numerator_(std::move(value)) {}  // NOLINT
  // The rational must be in lowest terms and have an odd denominator.
  explicit ExactNumber(const mpq_class& value)
      : numerator_(value.get_num()), denominator_(mpz_class(value.get_den())) {}
  // Numbers over one denominator, which must be odd.
  static std::array<ExactNumber, 3> over(std::array<mpz_class, 3> numerators,
                                         const Denominator& shared) {
    return {ExactNumber(std::move(numerators[0]), shared),
            ExactNumber(std::move(numerators[1]), shared),
            ExactNumber(std::move(numerators[2]), shared)};
  }

  bool is_integer() const { return !denominator_; }
  const mpz_class& numerator() const { return numerator_; }
  const Denominator& shared_denominator() const { return denominator_; }
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
    return {mpz_class(a.numerator_ * b.numerator_), product(a.denominator_, b.denominator_)};
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

  // Vectors whose components have one denominator, as most have, keep it, and it is computed once.
  using Vector = std::array<ExactNumber, 3>;
  static bool uniform(const Vector& v) {
    return v[0].same_denominator(v[1]) && v[0].same_denominator(v[2]);
  }
  // q - p, of uniform vectors.
  static Vector difference(const Vector& p, const Vector& q) {
    Vector result;
    if (p[0].same_denominator(q[0])) {
      for (std::size_t i = 0; i < 3; ++i) {
        result[i] = {mpz_class(q[i].numerator_ - p[i].numerator_), q[0].denominator_};
      }
      return result;
    }
    const mpz_class d = p[0].denominator(), e = q[0].denominator();
    mpz_class times_p = e, times_q = d;
    Denominator common;
    if (mpz_divisible_p(e.get_mpz_t(), d.get_mpz_t()) != 0) {
      common = q[0].denominator_;
      times_p = e / d;
      times_q = 1;
    } else if (mpz_divisible_p(d.get_mpz_t(), e.get_mpz_t()) != 0) {
      common = p[0].denominator_;
      times_p = 1;
      times_q = d / e;
    } else {
      common = Denominator(mpz_class(d * e));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      mpz_class n = q[i].numerator_ * times_q;
      mpz_submul(n.get_mpz_t(), p[i].numerator_.get_mpz_t(), times_p.get_mpz_t());
      result[i] = {std::move(n), common};
    }
    return result;
  }
  // Dot product of uniform vectors. The sum takes the memory of one number.
  static ExactNumber dot(const Vector& u, const Vector& v) {
    mpz_class sum = u[0].numerator_ * v[0].numerator_;
    for (std::size_t i = 1; i < 3; ++i) {
      mpz_addmul(sum.get_mpz_t(), u[i].numerator_.get_mpz_t(), v[i].numerator_.get_mpz_t());
    }
    return {std::move(sum), product(u[0].denominator_, v[0].denominator_)};
  }
  static Vector cross(const Vector& u, const Vector& v) {
    const Denominator common = product(u[0].denominator_, v[0].denominator_);
    Vector result;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      mpz_class n = u[j].numerator_ * v[k].numerator_;
      mpz_submul(n.get_mpz_t(), u[k].numerator_.get_mpz_t(), v[j].numerator_.get_mpz_t());
      result[i] = {std::move(n), common};
    }
    return result;
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

  static Denominator product(const Denominator& a, const Denominator& b) {
    if (!a || !b) return a ? a : b;
    return Denominator(mpz_class(*a * *b));
  }
  bool same_denominator(const ExactNumber& b) const { return denominator_ == b.denominator_; }
  // Over the larger denominator if it is a multiple of the other one, else over the product: common
  // divisors take far longer to find than the arithmetic that they would save.
  ExactNumber plus(const ExactNumber& b, int sign) const {
    mpz_class n;
    const auto sum = [&](const mpz_class& p, const mpz_class& q) {
      sign > 0 ? mpz_add(n.get_mpz_t(), p.get_mpz_t(), q.get_mpz_t())
               : mpz_sub(n.get_mpz_t(), p.get_mpz_t(), q.get_mpz_t());
    };
    if (!b.denominator_) {
      sum(numerator_, mpz_class(b.numerator_ * *denominator_));
      return {std::move(n), denominator_};
    }
    if (!denominator_) {
      sum(mpz_class(numerator_ * *b.denominator_), b.numerator_);
      return {std::move(n), b.denominator_};
    }
    const mpz_class &p = *denominator_, &q = *b.denominator_;
    if (mpz_divisible_p(p.get_mpz_t(), q.get_mpz_t()) != 0) {
      sum(numerator_, mpz_class(b.numerator_ * mpz_class(p / q)));
      return {std::move(n), denominator_};
    }
    if (mpz_divisible_p(q.get_mpz_t(), p.get_mpz_t()) != 0) {
      sum(mpz_class(numerator_ * mpz_class(q / p)), b.numerator_);
      return {std::move(n), b.denominator_};
    }
    sum(mpz_class(numerator_ * q), mpz_class(b.numerator_ * p));
    return {std::move(n), Denominator(mpz_class(p * q))};
  }

  mpz_class numerator_;
  Denominator denominator_;
};

inline mpq_class ratio(const ExactNumber& a, const ExactNumber& b) {
  return a.rational() / b.rational();
}

}  // namespace tetproof::oracles
