// Against values of textbooks and of R 4.2 (wilcox.test, binom.test, p.adjust).
#include "reports/statistics.h"

#include <gtest/gtest.h>

namespace tetproof::statistics_test {
namespace {

TEST(Statistics, MeanMedianQuantile) {
  EXPECT_EQ(mean({}), std::nullopt);
  EXPECT_EQ(median({}), std::nullopt);
  EXPECT_EQ(minimum({}), std::nullopt);
  EXPECT_EQ(mean({1, 2, 6}), 3);
  EXPECT_EQ(minimum({3, 1, 2}), 1);
  EXPECT_EQ(median({3}), 3);
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(quantile({4, 1, 2, 3, 5}, 0.25), 2);
  EXPECT_EQ(quantile({0, 10}, 0.95), 9.5);
}

TEST(Statistics, WilsonInterval) {
  const Interval i = wilson_interval(8, 10);
  EXPECT_NEAR(i.low, 0.4901625, 1e-6);
  EXPECT_NEAR(i.high, 0.9433178, 1e-6);
  EXPECT_EQ(wilson_interval(0, 0).high, 1);
  EXPECT_NEAR(wilson_interval(5, 5).high, 1, 1e-15);
}

TEST(Statistics, McNemar) {
  EXPECT_EQ(mcnemar_test(0, 0), 1);
  EXPECT_NEAR(mcnemar_test(0, 5), 0.0625, 1e-12);
  EXPECT_NEAR(mcnemar_test(10, 2), 0.03857422, 1e-8);
  EXPECT_NEAR(mcnemar_test(2, 10), mcnemar_test(10, 2), 1e-15);
  EXPECT_NEAR(mcnemar_test(7, 7), 1, 1e-12);
}

TEST(Statistics, WilcoxonExact) {
  EXPECT_EQ(wilcoxon_test({}), 1);
  EXPECT_EQ(wilcoxon_test({0, 0}), 1);
  EXPECT_NEAR(wilcoxon_test({1, 2, 3, 4, 5}), 0.0625, 1e-12);  // 2 of 32 patterns
  EXPECT_NEAR(wilcoxon_test({-1, 2, 3, 4, 5}), 0.125, 1e-12);
  // Hollander and Wolfe's depression scale: V = 5, p = 0.03906.
  EXPECT_NEAR(wilcoxon_test({0.952, -0.147, 1.022, 0.430, 0.620, 0.590, 0.490, -0.080, 0.010}),
              0.0390625, 1e-9);
}

TEST(Statistics, WilcoxonApproximated) {
  // With ties: the rank sum is 18.5 of 21.
  EXPECT_NEAR(wilcoxon_test({1, 1, 1, 2, 2, -1}), 0.10475748984973068, 1e-12);
  std::vector<double> many;
  for (int i = 1; i <= 40; ++i) many.push_back(i);
  EXPECT_LT(wilcoxon_test(many), 1e-7);
  for (std::size_t i = 0; i < many.size(); i += 2) many[i] = -many[i];
  EXPECT_GT(wilcoxon_test(many), 0.7);
}

TEST(Statistics, Holm) {
  EXPECT_TRUE(holm_adjusted({}).empty());
  const auto adjusted = holm_adjusted({0.01, 0.04, 0.03});
  EXPECT_NEAR(adjusted[0], 0.03, 1e-12);
  EXPECT_NEAR(adjusted[1], 0.06, 1e-12);
  EXPECT_NEAR(adjusted[2], 0.06, 1e-12);
  EXPECT_EQ(holm_adjusted({0.9, 0.8})[0], 1);
}

}  // namespace
}  // namespace tetproof::statistics_test
