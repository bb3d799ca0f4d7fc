#include "oracles/base/exact_sum.h"

#include "oracles/base/exact_points.h"

namespace tetproof::oracles {
namespace {

// The largest two primes below 2^61. No record can be made to fool them: the sums are over points
// that other oracles decide.
const std::array<mpz_class, 2>& primes() {
  static const std::array<mpz_class, 2> list = {(mpz_class(1) << 61) - 1,
                                                (mpz_class(1) << 61) - 31};
  return list;
}

// The inverses of a denominator modulo the primes. Terms that follow each other often have the same
// one, as the components of vectors do.
struct Inverses {
  mpz_class denominator;
  std::array<mpz_class, 2> values;
  bool known = true;  // no prime divides it
};

const Inverses& inverses(const mpz_class& denominator) {
  thread_local Inverses last;
  if (last.denominator == denominator) return last;
  last.denominator = denominator;
  last.known = true;
  for (std::size_t i = 0; i < 2; ++i) {
    last.known = mpz_invert(last.values[i].get_mpz_t(), denominator.get_mpz_t(),
                            primes()[i].get_mpz_t()) != 0 &&
                 last.known;
  }
  return last;
}

mpz_class residue(const mpz_class& n, const mpz_class& p) {
  mpz_class r;
  mpz_fdiv_r(r.get_mpz_t(), n.get_mpz_t(), p.get_mpz_t());
  return r;
}

}  // namespace

void ExactSum::add_fraction(const ExactNumber& value) {
  if (!fractions_) fractions_ = std::make_unique<Fractions>();
  Fractions& sum = *fractions_;
  mpz_class term = value.numerator() << kFraction;
  const mpz_class denominator = value.denominator();
  mpz_fdiv_q(term.get_mpz_t(), term.get_mpz_t(), denominator.get_mpz_t());
  sum.fixed += term;
  ++sum.count;
  const Inverses& inverse = inverses(denominator);
  sum.known = inverse.known && sum.known;
  for (std::size_t i = 0; i < 2; ++i) {
    const mpz_class& p = primes()[i];
    sum.residues[i] =
        residue(sum.residues[i] + residue(value.numerator(), p) * inverse.values[i], p);
  }
}

mpz_class ExactSum::fixed() const {
  mpz_class result = integers_ << kFraction;
  if (fractions_) result += fractions_->fixed;
  return result;
}

bool operator==(const ExactSum& a, const ExactSum& b) {
  if (!a.fractions_ && !b.fractions_) return a.integers_ == b.integers_;
  static const ExactSum::Fractions kNothing{};
  const ExactSum::Fractions &p = a.fractions_ ? *a.fractions_ : kNothing,
                            &q = b.fractions_ ? *b.fractions_ : kNothing;
  if (!p.known || !q.known) return false;  // a chance of 2^-60
  if (abs(mpz_class(a.fixed() - b.fixed())) > p.count + q.count) return false;
  for (std::size_t i = 0; i < 2; ++i) {
    const mpz_class off = p.residues[i] + a.integers_ - q.residues[i] - b.integers_;
    if (residue(off, primes()[i]) != 0) return false;
  }
  return true;
}

bool within(const ExactSum& a, const ExactSum& b, long factor, const ExactSum& c) {
  return abs(mpz_class(a.fixed() - b.fixed())) * factor <= c.fixed();
}

std::array<std::uint64_t, 2> ExactSum::rounded() const {
  constexpr std::size_t kBits = 24;
  mpz_class value = fixed();
  if (value <= 0) return {0, 0};
  value <<= kBits;  // so that there are more of them
  std::size_t length = mpz_sizeinbase(value.get_mpz_t(), 2);
  mpz_class half = 1;
  half <<= length - kBits - 1;
  value += half;
  length = mpz_sizeinbase(value.get_mpz_t(), 2);
  value >>= length - kBits;
  return {length, value.get_ui()};
}

double ExactSum::value(long exponent) const {
  if (!fractions_) return to_double(ExactNumber(integers_), exponent);
  return to_double(ExactNumber(fixed()), exponent - static_cast<long>(kFraction));
}

double difference(const ExactSum& a, const ExactSum& b, long exponent) {
  return to_double(ExactNumber(mpz_class(a.fixed() - b.fixed())),
                   exponent - static_cast<long>(ExactSum::kFraction));
}

}  // namespace tetproof::oracles
