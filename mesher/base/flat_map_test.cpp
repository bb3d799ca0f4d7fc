#include "mesher/base/flat_map.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace delmesher::base {
namespace {

TEST(FlatMap, AnswersLikeAnOrderedMap) {
  std::mt19937_64 random(3);
  // Few keys, so that they are set, changed and erased again and again; and keys that differ in
  // their high or low bits only, so that they collide.
  for (const int shift : {0, 20, 40, 54}) {
    FlatMap map;
    std::map<std::uint64_t, std::uint32_t> reference;
    for (int step = 0; step < 20000; ++step) {
      const std::uint64_t key = (random() % 600) << shift;
      const auto value = static_cast<std::uint32_t>(random());
      if (random() % 2 == 0) {
        map.set(key, value);
        reference[key] = value;
      } else {
        map.erase(key);
        reference.erase(key);
      }
      ASSERT_EQ(map.size(), reference.size());
      const std::uint64_t asked = (random() % 600) << shift;
      const auto found = reference.find(asked);
      ASSERT_EQ(map.get(asked, 12345), found == reference.end() ? 12345 : found->second);
    }
    for (const auto& [key, value] : reference) ASSERT_EQ(map.get(key, 0), value);
  }
}

TEST(FlatMap, EmptyHasNothing) {
  FlatMap map;
  map.erase(5);
  EXPECT_EQ(map.get(5, 7), 7U);
}

}  // namespace
}  // namespace delmesher::base
