// CGAL's exact numbers modulo primes: sums of fractions that are to be equal need not be reduced.
#pragma once

#include <CGAL/Gmpzf.h>

#include <array>
#include <cstdint>
#include <cstdlib>

namespace tetproof::oracles {

using Number = CGAL::Gmpzf;

// Residues modulo the two primes below 2^61 that follow those of exact_sum.cpp.
class Residue {
 public:
  static constexpr std::array<std::uint64_t, 2> kPrimes = {(std::uint64_t{1} << 61) - 45,
                                                           (std::uint64_t{1} << 61) - 229};
  Residue() = default;
  // Residues of x / w, for each of several x. False if a prime divides w.
  static bool of(const std::array<Number, 3>& x, const Number& w, std::array<Residue, 3>& result) {
    for (std::size_t i = 0; i < 2; ++i) {
      const std::uint64_t below = reduced(w, kPrimes[i]);
      if (below == 0) return false;
      const std::uint64_t inverse = inverse_of(below, i);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        result[axis].value_[i] = times(reduced(x[axis], kPrimes[i]), inverse, kPrimes[i]);
      }
    }
    return true;
  }
  friend Residue operator+(const Residue& a, const Residue& b) {
    Residue r;
    for (std::size_t i = 0; i < 2; ++i) r.value_[i] = (a.value_[i] + b.value_[i]) % kPrimes[i];
    return r;
  }
  friend Residue operator-(const Residue& a, const Residue& b) {
    Residue r;
    for (std::size_t i = 0; i < 2; ++i) {
      r.value_[i] = (a.value_[i] + (kPrimes[i] - b.value_[i])) % kPrimes[i];
    }
    return r;
  }
  friend Residue operator*(const Residue& a, const Residue& b) {
    Residue r;
    for (std::size_t i = 0; i < 2; ++i) r.value_[i] = times(a.value_[i], b.value_[i], kPrimes[i]);
    return r;
  }
  friend bool operator==(const Residue&, const Residue&) = default;

 private:
  __extension__ using Wide = unsigned __int128;

  // The product is below 2^122, and 2^61 is congruent to the little by which it exceeds the prime:
  // folded once, it is below 2^70, and twice, below 2^61 + 2^17. A division takes far longer.
  static std::uint64_t times(std::uint64_t a, std::uint64_t b, std::uint64_t prime) {
    constexpr std::uint64_t kPower = std::uint64_t{1} << 61;
    const std::uint64_t excess = kPower - prime;
    const Wide product = static_cast<Wide>(a) * b;
    const Wide once = (product & (kPower - 1)) + (product >> 61) * excess;
    const auto twice = static_cast<std::uint64_t>((once & (kPower - 1)) + (once >> 61) * excess);
    return twice < prime ? twice : twice - prime;
  }
  static std::uint64_t power(std::uint64_t a, std::uint64_t exponent, std::uint64_t prime) {
    std::uint64_t result = 1;
    for (; exponent > 0; exponent /= 2, a = times(a, a, prime)) {
      if (exponent % 2 == 1) result = times(result, a, prime);
    }
    return result;
  }
  // Points that follow each other often have the same weight: 1, or that of their facet's corners.
  static std::uint64_t inverse_of(std::uint64_t a, std::size_t prime) {
    thread_local std::array<std::array<std::uint64_t, 2>, 2> last = {{{1, 1}, {1, 1}}};
    auto& [value, inverse] = last[prime];
    if (value != a) {
      inverse = power(a, kPrimes[prime] - 2, kPrimes[prime]);
      value = a;
    }
    return inverse;
  }
  static std::uint64_t reduced(const Number& x, std::uint64_t prime) {
    const std::uint64_t mantissa = mpz_fdiv_ui(x.man(), prime);
    const auto exponent = static_cast<std::uint64_t>(std::llabs(x.exp()));
    const std::uint64_t two = x.exp() >= 0 ? 2 : (prime + 1) / 2;
    return times(mantissa, power(two, exponent, prime), prime);
  }

  std::array<std::uint64_t, 2> value_{};
};

}  // namespace tetproof::oracles
