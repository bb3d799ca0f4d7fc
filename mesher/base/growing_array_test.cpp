#include "mesher/base/growing_array.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <vector>

namespace delmesher::base {
namespace {

struct alignas(32) Wide {
  std::uint32_t value[8];
};

template <class T>
bool is_aligned(const GrowingArray<T>& array) {
  return reinterpret_cast<std::uintptr_t>(array.data()) % alignof(T) == 0;
}

TEST(GrowingArray, HoldsWhatAVectorHolds) {
  std::mt19937 random(5);
  GrowingArray<std::uint32_t> array;
  std::vector<std::uint32_t> vector;
  for (int step = 0; step < 20000; ++step) {
    const auto value = static_cast<std::uint32_t>(random());
    switch (random() % 8) {
      case 0:
        if (!vector.empty()) {
          array.pop_back();
          vector.pop_back();
        }
        break;
      case 1: {
        const std::size_t n =
            vector.size() + random() % 40 - std::min<std::size_t>(20, vector.size());
        array.resize(n, value);
        vector.resize(n, value);
        break;
      }
      case 2: {
        const std::uint32_t more[] = {value, 1, 2};
        array.append(more, more + 3);
        vector.insert(vector.end(), more, more + 3);
        break;
      }
      default:
        array.push_back(value);
        vector.push_back(value);
    }
    ASSERT_EQ(array.size(), vector.size());
  }
  ASSERT_GT(array.size(), 10000U);
  EXPECT_TRUE(std::equal(array.begin(), array.end(), vector.begin(), vector.end()));
  array.push_back(array[0]);
  EXPECT_EQ(array.back(), vector[0]);
}

// From sizes that the allocator keeps in its heap to sizes that get pages of their own.
TEST(GrowingArray, OverAlignedElementsSurviveEveryMove) {
  GrowingArray<Wide> array;
  for (std::uint32_t i = 0; i < 200000; ++i) {
    array.push_back({{i, i + 1, i + 2, i + 3, i + 4, i + 5, i + 6, i + 7}});
    if ((i & (i + 1)) == 0) {
      ASSERT_TRUE(is_aligned(array));
      for (std::uint32_t j = 0; j <= i; ++j) ASSERT_EQ(array[j].value[7], j + 7);
    }
  }
  GrowingArray<Wide> other = std::move(array);
  EXPECT_TRUE(array.empty());  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(other[199999].value[0], 199999U);
  other.release();
  EXPECT_TRUE(other.empty());
}

}  // namespace
}  // namespace delmesher::base
