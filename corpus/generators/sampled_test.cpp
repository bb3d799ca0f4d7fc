#include <gtest/gtest.h>

#include "corpus/generators/families.h"
#include "corpus/generators/generate.h"

namespace tetproof {
namespace {

TEST(Sampled, MembersAreCertifiedTheSameAndOfTheirSize) {
  const Family* family = find_family("isosurface");
  ASSERT_NE(family, nullptr);
  for (std::uint64_t i = 0; i < 4; ++i) {
    const auto member = generate(*family, 20261129, i, {}),
               again = generate(*family, 20261129, i, {});
    ASSERT_TRUE(member) << i;
    EXPECT_EQ(member->vertices, again->vertices);
    EXPECT_EQ(member->triangles, again->triangles);
    EXPECT_GT(member->triangles.size(), 200U);
    EXPECT_LT(member->triangles.size(), 40000U);
  }
}

TEST(Sampled, LargeOnesAreLeftToThoseWhoNameThem) {
  ASSERT_NE(find_family("large_isosurface"), nullptr);
  for (const Family& family : families()) {
    EXPECT_EQ(std::string(family.name).find("isosurface"), std::string::npos);
  }
  FamilyMember member{Random(1)};
  EXPECT_GT(find_family("large_isosurface")->make(member).triangles.size(), 5000U);
}

}  // namespace
}  // namespace tetproof
