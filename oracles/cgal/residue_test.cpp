// Sums of fractions as residues.
#include "oracles/cgal/residue.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace tetproof::oracles {
namespace {

// Where a product is folded only once, or a sum not reduced, the largest residues show it.
TEST(Residues, AreThoseOfTheRationals) {
  const auto residues = [](const std::array<mpz_class, 3>& x, const mpz_class& w) {
    const auto number = [](const mpz_class& n) { return Number(CGAL::Gmpz(n.get_mpz_t())); };
    std::array<Residue, 3> result;
    EXPECT_TRUE(Residue::of({number(x[0]), number(x[1]), number(x[2])}, number(w), result));
    return result;
  };
  std::vector<mpz_class> values = {0, 1, 2};
  for (const std::uint64_t prime : Residue::kPrimes) {
    for (const long off : {-2L, -1L, 1L}) values.push_back(mpz_class(prime) + off);
  }
  gmp_randclass random(gmp_randinit_default);
  random.seed(7);
  for (const unsigned bits : {61U, 62U, 200U, 400U}) values.push_back(random.get_z_bits(bits) + 1);
  for (const mpz_class& a : values) {
    for (const mpz_class& b : values) {
      if (a == 0) continue;
      // b / a, and its sum with, difference from and product with 1 / b.
      const auto [x, y, z] = residues({b, a * b, 1}, a);
      EXPECT_EQ(y, residues({b, 0, 0}, 1)[0]);
      EXPECT_EQ(x + z, residues({b + 1, 0, 0}, a)[0]);
      EXPECT_EQ(x - z, residues({b - 1, 0, 0}, a)[0]);
      EXPECT_EQ(x * z, residues({b, 0, 0}, a * a)[0]);
      EXPECT_EQ(x * x, residues({b * b, 0, 0}, a * a)[0]);
      EXPECT_NE(x, residues({b + 1, 0, 0}, a)[0]);
    }
  }
}

TEST(Residues, OfFractionsInBinary) {
  std::array<Residue, 3> binary, ratios;
  ASSERT_TRUE(Residue::of({Number(0.375), Number(-0x1p-300), Number(0x1p300)}, Number(1), binary));
  ASSERT_TRUE(Residue::of({Number(3), Number(-8 * 0x1p-300), Number(0x1p303)}, Number(8), ratios));
  EXPECT_EQ(binary, ratios);
}

// Each prime alone would take these for equal.
TEST(Residues, DifferWhereOnePrimeDividesTheDifference) {
  const auto of = [](const mpz_class& n) {
    std::array<Residue, 3> result;
    EXPECT_TRUE(
        Residue::of({Number(CGAL::Gmpz(n.get_mpz_t())), Number(0), Number(0)}, Number(1), result));
    return result[0];
  };
  const mpz_class first(Residue::kPrimes[0]), second(Residue::kPrimes[1]);
  EXPECT_NE(of(first + 5), of(5));
  EXPECT_NE(of(second + 5), of(5));
  EXPECT_EQ(of(first * second + 5), of(5));
}

TEST(Residues, NoneOverAPrime) {
  std::array<Residue, 3> result;
  for (const std::uint64_t prime : Residue::kPrimes) {
    const mpz_class weight = mpz_class(prime) * 3;
    EXPECT_FALSE(Residue::of({Number(1), Number(1), Number(1)},
                             Number(CGAL::Gmpz(weight.get_mpz_t())), result));
  }
}

}  // namespace
}  // namespace tetproof::oracles
