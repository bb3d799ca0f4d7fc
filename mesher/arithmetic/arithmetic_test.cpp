// Integers, dyadic numbers and error bounds against GMP's own classes.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "mesher/arithmetic/big_integer.h"
#include "mesher/arithmetic/bounded.h"
#include "mesher/arithmetic/dyadic.h"
#include "mesher/arithmetic/fixed_integer.h"
#include "mesher/arithmetic/words.h"

namespace delmesher::arithmetic {
namespace {

mpz_class import(const std::uint64_t* limbs, std::size_t n) {
  mpz_class z;
  mpz_import(z.get_mpz_t(), n, -1, 8, 0, 0, limbs);
  return z;
}

mpz_class value(const BigInteger& x) {
  const mpz_class magnitude = import(x.data(), x.used());
  return x.sign() < 0 ? mpz_class(-magnitude) : magnitude;
}

template <int N>
mpz_class value(const FixedInteger<N>& x) {
  mpz_class z = import(x.limb.data(), N);
  if (x.negative()) z -= mpz_class(1) << (64 * N);
  return z;
}

mpq_class value(const Dyadic& x) {
  mpq_class q = value(x.mantissa);
  if (x.exponent >= 0) return q * (mpz_class(1) << static_cast<unsigned>(x.exponent));
  return q / (mpz_class(1) << static_cast<unsigned>(-x.exponent));
}

class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t below(std::uint64_t n) { return engine_() % n; }

  // Limbs with runs of zeros and ones, where carries go wrong.
  std::uint64_t limb() {
    switch (below(5)) {
      case 0:
        return 0;
      case 1:
        return ~std::uint64_t{0};
      case 2:
        return std::uint64_t{1} << below(64);
      default:
        return engine_();
    }
  }

  BigInteger big(std::size_t most_limbs) {
    std::vector<std::uint64_t> limbs(below(most_limbs + 1));
    for (auto& x : limbs) x = limb();
    return BigInteger(limbs.data(), limbs.size(), below(2) != 0, below(3) * below(70));
  }

  template <int N>
  FixedInteger<N> fixed() {
    FixedInteger<N> x;
    for (auto& l : x.limb) l = limb();
    return x;
  }

  double number(int low, int high) {
    const double m = 1 + std::ldexp(static_cast<double>(engine_() >> 12), -52);
    const int e = low + static_cast<int>(below(static_cast<std::uint64_t>(high - low)));
    return (below(2) != 0 ? m : -m) * std::ldexp(1.0, e);
  }

 private:
  std::mt19937_64 engine_;
};

// Random words, many of them all zeros or all ones, so that carries run far.
Word random_word(std::mt19937_64& random) {
  switch (random() % 4) {
    case 0:
      return 0;
    case 1:
      return ~Word{0};
    case 2:
      return Word{1} << (random() % 64);
    default:
      return random();
  }
}

TEST(Words, BothFormsAgreeWithGmp) {
  std::mt19937_64 random(29);
  const auto natural = [](Word x) { return import(&x, 1); };
  const auto of_both = [&](const DoubleWord& x) {
    return mpz_class((natural(x.high) << 64) + natural(x.low));
  };
  for (int round = 0; round < 20000; ++round) {
    const Word a = random_word(random), b = random_word(random), c = random_word(random),
               d = random_word(random);
    const mpz_class expected = natural(a) * natural(b) + natural(c) + natural(d);
    ASSERT_EQ(of_both(multiply_add(a, b, c, d)), expected);
    ASSERT_EQ(of_both(portable::multiply_add(a, b, c, d)), expected);

    const auto whole = [&](Word x) { return mpz_class(natural(x) - (mpz_class(x >> 63U) << 64)); };
    mpz_class product = whole(a) * whole(b);
    if (product < 0) product += mpz_class(1) << 128;
    ASSERT_EQ(of_both(signed_multiply(a, b)), product);
    ASSERT_EQ(of_both(portable::signed_multiply(a, b)), product);

    for (const Word before : {Word{0}, Word{1}}) {
      auto carry = static_cast<Carry>(before), borrow = static_cast<Carry>(before);
      Word portable_carry = before, portable_borrow = before;
      const Word sum = add_carry(a, b, carry), rest = subtract_borrow(a, b, borrow);
      ASSERT_EQ(mpz_class((natural(carry) << 64) + natural(sum)),
                natural(a) + natural(b) + natural(before));
      ASSERT_EQ(mpz_class(natural(rest) - (natural(borrow) << 64)),
                natural(a) - natural(b) - natural(before));
      ASSERT_EQ(portable::add_carry(a, b, portable_carry), sum);
      ASSERT_EQ(portable::subtract_borrow(a, b, portable_borrow), rest);
      ASSERT_EQ(portable_carry, carry);
      ASSERT_EQ(portable_borrow, borrow);
    }
  }
}

TEST(Words, NaturalNumbersAgreeWithGmp) {
  std::mt19937_64 random(31);
  for (int round = 0; round < 5000; ++round) {
    std::vector<Word> x(1 + random() % 40), y(1 + random() % x.size());
    for (Word& w : x) w = random_word(random);
    for (Word& w : y) w = random_word(random);
    const std::size_t m = x.size(), n = y.size();
    const mpz_class p = import(x.data(), m), q = import(y.data(), n);
    std::vector<Word> out(m + n + 1, 7);
    out[m] = add(out.data(), x.data(), m, y.data(), n);
    ASSERT_EQ(import(out.data(), m + 1), p + q);
    if (p >= q) {
      subtract(out.data(), x.data(), m, y.data(), n);
      ASSERT_EQ(import(out.data(), m), p - q);
    }
    multiply(out.data(), x.data(), m, y.data(), n);
    ASSERT_EQ(import(out.data(), m + n), p * q);
    ASSERT_EQ(out[m + n], 7U);  // nothing beyond is written
    const auto bits = static_cast<unsigned>(1 + random() % 63);
    out[m] = shift_left(out.data(), x.data(), m, bits);
    ASSERT_EQ(import(out.data(), m + 1), mpz_class(p << bits));
    shift_right(out.data(), x.data(), m, bits);
    ASSERT_EQ(import(out.data(), m), mpz_class(p >> bits));
    std::vector<Word> z = x;
    ASSERT_EQ(compare(x.data(), z.data(), m), 0);
    z[random() % m] ^= Word{1} << (random() % 64);
    const mpz_class r = import(z.data(), m);
    ASSERT_EQ(compare(x.data(), z.data(), m), cmp(p, r) < 0 ? -1 : 1);
    // In place.
    const Word carry = add(x.data(), x.data(), m, y.data(), n);
    ASSERT_EQ(mpz_class(import(x.data(), m) + (mpz_class(carry) << (64 * m))), p + q);
  }
}

TEST(BigInteger, AgreesWithGmp) {
  Numbers random(1);
  int on_heap = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::size_t limbs = i % 10 == 0 ? 60 : 6;
    const BigInteger a = random.big(limbs);
    const BigInteger b = i % 7 == 0 ? a : random.big(limbs);
    const mpz_class x = value(a), y = value(b);
    ASSERT_EQ(value(a + b), mpz_class(x + y));
    ASSERT_EQ(value(a - b), mpz_class(x - y));
    ASSERT_EQ(value(a * b), mpz_class(x * y));
    ASSERT_EQ(value(-a), mpz_class(-x));
    const auto shift = random.below(200);
    ASSERT_EQ(value(a << shift), mpz_class(x << shift));
    mpz_class truncated;
    mpz_tdiv_q_2exp(truncated.get_mpz_t(), x.get_mpz_t(), shift);
    ASSERT_EQ(value(a >> shift), truncated);
    BigInteger dropped = a;
    dropped.drop_bits(shift);
    ASSERT_EQ(value(dropped), truncated);
    ASSERT_EQ(value(BigInteger::shifted_sum(a, shift, b, false)), mpz_class((x << shift) + y));
    ASSERT_EQ(value(BigInteger::shifted_sum(a, shift, b, true)), mpz_class((x << shift) - y));
    dropped.negate();
    ASSERT_EQ(value(dropped), mpz_class(-truncated));
    ASSERT_EQ(a.sign(), sgn(x));
    if (sgn(x) != 0) {
      ASSERT_EQ(a.bit_length(), mpz_sizeinbase(x.get_mpz_t(), 2));
      ASSERT_EQ(a.trailing_zeros(), mpz_scan1(x.get_mpz_t(), 0));
    }
    BigInteger copy = a;
    const BigInteger& same = copy;
    copy = same;
    BigInteger moved = std::move(copy);
    copy = b;
    ASSERT_EQ(value(moved), x);
    ASSERT_EQ(value(copy), y);
    moved = std::move(copy);
    ASSERT_EQ(value(moved), y);
    on_heap += a.used() > 20 ? 1 : 0;
  }
  EXPECT_GT(on_heap, 100);
}

// Products are exact; sums and differences are checked modulo 2^(64 N), as they wrap.
template <int N, int M>
void check_fixed(Numbers& random) {
  const mpz_class modulus = mpz_class(1) << (64 * N);
  for (int i = 0; i < 3000; ++i) {
    const auto a = random.fixed<N>();
    const auto b = random.fixed<N>();
    const auto c = random.fixed<M>();
    ASSERT_EQ(value(a * c), mpz_class(value(a) * value(c)));
    ASSERT_EQ(mpz_class((value(a + b) - value(a) - value(b)) % modulus), 0);
    ASSERT_EQ(mpz_class((value(a - b) - value(a) + value(b)) % modulus), 0);
    ASSERT_EQ(a.sign(), sgn(value(a)));
    const bool negative = random.below(2) != 0;
    const int shift = static_cast<int>(random.below(64 * N - 64 + 1));
    const std::uint64_t limb = random.limb() >> 1;
    const mpz_class shifted = import(&limb, 1) << static_cast<unsigned>(shift);
    ASSERT_EQ(value(fixed_integer<N>(&limb, 1, negative, shift)),
              negative ? mpz_class(-shifted) : shifted);
  }
}

TEST(FixedInteger, AgreesWithGmp) {
  Numbers random(2);
  check_fixed<1, 1>(random);
  check_fixed<1, 2>(random);
  check_fixed<2, 1>(random);
  check_fixed<2, 3>(random);
  check_fixed<4, 4>(random);
  check_fixed<12, 8>(random);
}

// Nearest, ties to even, everywhere from subnormal numbers to overflow.
TEST(Dyadic, RoundsToNearestEven) {
  Numbers random(3);
  int subnormal = 0, infinite = 0, exact = 0, ties = 0;
  for (int i = 0; i < 40000; ++i) {
    Dyadic x = Dyadic::from_double(random.number(-20, 20));
    if (i % 3 != 0) x = x * Dyadic::from_double(random.number(-20, 20));
    if (i % 4 == 0) {  // a tie: odd multiple of half an ulp
      const std::uint64_t odd = (std::uint64_t{1} << 53) + (random.below(1 << 20) << 1) + 1;
      x.mantissa = BigInteger(&odd, 1, random.below(2) != 0);
    }
    x.exponent += static_cast<int>(random.below(2300)) - 1200;
    const Rounded r = round_to_double(x);
    const mpq_class q = value(x);
    if (std::isinf(r.value)) {
      // At or beyond the middle between the largest double and 2^1024.
      const mpq_class limit = (mpq_class(1) << 1024) - (mpq_class(1) << 970);
      ASSERT_GE(mpq_class(abs(q)), limit);
      ASSERT_EQ(r.value > 0, sgn(q) > 0);
      ++infinite;
      continue;
    }
    const mpq_class off = abs(mpq_class(q - mpq_class(r.value)));
    ASSERT_LE(off, mpq_class(r.error));
    for (const double towards : {-HUGE_VAL, HUGE_VAL}) {
      const double other = std::nextafter(r.value, towards);
      if (std::isinf(other)) continue;
      const mpq_class other_off = abs(mpq_class(q - mpq_class(other)));
      ASSERT_LE(off, other_off);
      if (off == other_off) {
        ++ties;
        ASSERT_EQ(std::bit_cast<std::uint64_t>(r.value) & 1, 0U) << "tie not to even";
      }
    }
    subnormal += r.value != 0 && std::fabs(r.value) < 0x1p-1022 ? 1 : 0;
    exact += r.error == 0 ? 1 : 0;
    if (r.error == 0) {
      ASSERT_EQ(sgn(off), 0);
    }
  }
  EXPECT_GT(subnormal, 100);
  EXPECT_GT(infinite, 100);
  EXPECT_GT(exact, 100);
  EXPECT_GT(ties, 1000);
}

TEST(Dyadic, ArithmeticIsExact) {
  Numbers random(4);
  for (int i = 0; i < 5000; ++i) {
    const double a = random.number(-1074, 1023), b = random.number(-1074, 1023);
    const Dyadic x = Dyadic::from_double(a), y = Dyadic::from_double(b);
    ASSERT_EQ(value(x + y), mpq_class(mpq_class(a) + mpq_class(b)));
    ASSERT_EQ(value(x - y), mpq_class(mpq_class(a) - mpq_class(b)));
    ASSERT_EQ(value(x * y), mpq_class(mpq_class(a) * mpq_class(b)));
    ASSERT_EQ((x - x).sign(), 0);
  }
}

mpq_class middle(const Bounded& x) {
  return mpq_class(x.value);
}

mpq_class middle(const BoundedPair& x) {
  return mpq_class(x.high) + mpq_class(x.low);
}

// Random sums, differences and products: the exact number stays within the bound, and the bound
// does not become useless.
template <class T>
void check_bounds(Numbers& random, int low, int high, double usual_error) {
  int useful = 0, finite = 0;
  for (int i = 0; i < 3000; ++i) {
    T x{};
    mpq_class exact = 0;
    for (int k = 0; k < 8; ++k) {
      const double d = random.number(low, high);
      T y{};
      if constexpr (std::is_same_v<T, Bounded>) {
        y.value = d;
      } else {
        y.high = d;
      }
      const auto operation = random.below(3);
      if (operation == 0) x = x + y, exact += mpq_class(d);
      if (operation == 1) x = x - y, exact -= mpq_class(d);
      if (operation == 2) x = x * y, exact *= mpq_class(d);
    }
    if (!std::isfinite(x.error)) continue;
    if constexpr (std::is_same_v<T, Bounded>) {
      if (!std::isfinite(x.value)) continue;
    } else {
      if (!std::isfinite(x.high) || !std::isfinite(x.low)) continue;
    }
    ++finite;
    ASSERT_LE(mpq_class(abs(mpq_class(exact - middle(x)))), mpq_class(x.error));
    if (x.sign() != kUnknownSign) {
      ASSERT_EQ(x.sign(), sgn(exact));
    }
    if (mpq_class(x.error) <= abs(exact) * mpq_class(usual_error)) ++useful;
  }
  EXPECT_GT(finite, 1000);
  if (usual_error > 0) {
    EXPECT_GT(useful, 2500);
  }
}

TEST(Bounded, ContainsTheExactNumber) {
  Numbers random(5);
  check_bounds<Bounded>(random, -10, 10, 1e-13);
  check_bounds<Bounded>(random, -600, 500, 0);
  check_bounds<Bounded>(random, -1074, -300, 0);
}

TEST(BoundedPair, ContainsTheExactNumber) {
  Numbers random(6);
  check_bounds<BoundedPair>(random, -10, 10, 1e-28);
  check_bounds<BoundedPair>(random, -600, 500, 0);
  check_bounds<BoundedPair>(random, -1074, -300, 0);
}

}  // namespace
}  // namespace delmesher::arithmetic
