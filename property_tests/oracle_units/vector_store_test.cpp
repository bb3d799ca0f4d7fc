#include "oracles/base/vector_store.h"

#include <gtest/gtest.h>

#include <random>

namespace tetproof::oracles {
namespace {

using Numerators = std::array<mpz_class, 3>;

mpz_class number_of(std::mt19937& random, std::size_t bits) {
  mpz_class x = 0;
  for (std::size_t bit = 0; bit < bits; bit += 32) x = (x << 32) + std::uint32_t(random());
  return random() % 2 == 0 ? x : mpz_class(-x);
}

// Of nothing to many digits, of either sign, and more than an ordinary block holds.
TEST(VectorStore, ReturnsWhatWasPut) {
  std::mt19937 random(1);
  VectorStore store;
  std::vector<Numerators> put;
  const ExactNumber::Denominator shared(mpz_class(7));
  for (int n = 0; n < 3000; ++n) {
    const std::size_t bits = n % 1000 == 999 ? 64 * 9000 : 32 * (n % 20);
    put.push_back({number_of(random, bits), number_of(random, 64), number_of(random, bits / 2)});
    store.push_back(put.back(), n % 2 == 0 ? shared : ExactNumber::Denominator());
  }
  ASSERT_EQ(store.size(), put.size());
  const VectorStore copy = store;
  Numerators x;
  for (std::size_t n = 0; n < put.size(); ++n) {
    copy.numerators(n, x);
    ASSERT_EQ(x, put[n]) << n;
    const std::array<ExactNumber, 3> vector = store[n];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(vector[axis].numerator(), put[n][axis]) << n;
      ASSERT_EQ(vector[axis].denominator(), n % 2 == 0 ? 7 : 1) << n;
    }
  }
}

// What is read from the store may be changed; the store may not.
TEST(VectorStore, IsNotChangedThroughWhatItReturns) {
  VectorStore store;
  store.push_back({mpz_class(-5), mpz_class(0), mpz_class(1) << 100}, {});
  Numerators x;
  store.numerators(0, x);
  for (mpz_class& n : x) n *= 3;
  store.push_back({mpz_class(1), mpz_class(2), mpz_class(3)}, {});
  store.numerators(0, x);
  EXPECT_EQ(x, (Numerators{mpz_class(-5), mpz_class(0), mpz_class(1) << 100}));
}

}  // namespace
}  // namespace tetproof::oracles
