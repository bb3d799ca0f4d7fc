#include "oracles/base/simplex_set.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace tetproof::oracles {
namespace {

// Against a std::set, with few corners so that many edges and faces share their lowest one.
template <std::size_t N>
void compare_with_set(std::mt19937& random, Index corners, int count) {
  std::uniform_int_distribution<Index> corner(0, corners - 1);
  std::vector<std::array<Index, N>> given;
  std::set<std::set<Index>> wanted;
  while (count-- > 0) {
    std::array<Index, N> simplex;
    for (Index& v : simplex) v = corner(random);
    const std::set<Index> distinct(simplex.begin(), simplex.end());
    if (distinct.size() < N) continue;
    given.push_back(simplex);
    wanted.insert(distinct);
  }
  const SimplexSet<N> found(given);
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t n = 0; n < found.size(); ++n) {
    ASSERT_EQ(found.find(found[n]), n);
    ASSERT_TRUE(wanted.contains(std::set<Index>(found[n].begin(), found[n].end())));
    if (n > 0) {
      ASSERT_LT(found[n - 1], found[n]);
    }
  }
  for (int asked = 0; asked < 200; ++asked) {
    std::array<Index, N> simplex;
    for (Index& v : simplex) v = corner(random) * 2;  // half of them beyond all corners
    const bool there = wanted.contains(std::set<Index>(simplex.begin(), simplex.end()));
    ASSERT_EQ(found.contains(simplex), there);
  }
}

TEST(SimplexSet, HoldsWhatWasGivenOnceInAnyOrder) {
  std::mt19937 random(17);
  for (const int count : {0, 1, 30, 400}) {
    compare_with_set<2>(random, 12, count);
    compare_with_set<3>(random, 12, count);
  }
}

}  // namespace
}  // namespace tetproof::oracles
