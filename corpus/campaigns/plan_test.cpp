#include "corpus/campaigns/plan.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace tetproof {
namespace {

Model model(const std::string& name, std::uint64_t bytes) {
  return {"/" + name, name, name, bytes};
}

RunRow row(const std::string& name, const std::string& mesher, std::uint64_t bytes, double cpu,
           double oracles, std::uint64_t memory) {
  RunRow r;
  r.key = {name, mesher, "1", "f", "l"};
  r.model_name = name;
  r.model_bytes = bytes;
  r.disposition = Disposition::ok;
  r.cpu_seconds = cpu;
  r.verify_seconds = oracles;
  r.peak_rss_bytes = memory;
  return r;
}

TEST(Plan, WhatWasMeasuredCostsWhatItDid) {
  const Plan plan = plan_of({model("a", 100), model("b", 1000)}, {"m"},
                            {row("a", "m", 100, 2, 1, 500), row("b", "m", 1000, 50, 10, 9000),
                             row("a", "other", 100, 1e6, 0, 1)},
                            1, 60);
  ASSERT_EQ(plan.meshers.size(), 1U);
  EXPECT_EQ(plan.meshers[0].measured, 2U);
  EXPECT_DOUBLE_EQ(plan.seconds, 63);
  EXPECT_DOUBLE_EQ(plan.longest_run, 60);
  EXPECT_DOUBLE_EQ(plan.longest_shard, 63);
  EXPECT_EQ(plan.peak_bytes, 9000U);
}

// Three small models at 0.03 s and 5 bytes for each byte, and large ones at ten times that, which
// are too far away to count for a small one.
TEST(Plan, TheRestIsLikeTheNearestInSize) {
  std::vector<RunRow> rows;
  for (int n = 0; n < 9; ++n) {
    rows.push_back(row("s" + std::to_string(n), "m", 100, 2, 1, 500));
    rows.push_back(row("l" + std::to_string(n), "m", 10000, 2000, 1000, 500000));
  }
  const Plan plan = plan_of({model("0e30", 110)}, {"m"}, rows, 1, 1e9);
  EXPECT_EQ(plan.meshers[0].measured, 0U);
  EXPECT_NEAR(plan.seconds, 3.3, 1e-9);
  EXPECT_EQ(plan.peak_bytes, 550U);
  EXPECT_NEAR(plan_of({model("0e30", 20000)}, {"m"}, rows, 1, 1e9).seconds, 6000, 1e-6);
  // A run ends at its limit, and then the oracles have their time.
  EXPECT_NEAR(plan_of({model("0e30", 20000)}, {"m"}, rows, 1, 100).seconds, 1100, 1e-6);
}

TEST(Plan, ShardsAreThoseOfTheCampaign) {
  std::vector<Model> models;
  std::vector<RunRow> rows;
  for (int n = 0; n < 40; ++n) {
    const std::string hash = std::string(1, "0123456789abcdef"[n % 16]) + std::to_string(n);
    models.push_back(model(hash, 100));
    rows.push_back(row(hash, "m", 100, 1, 0, 1));
  }
  const Plan plan = plan_of(models, {"m"}, rows, 4, 60);
  std::size_t largest = 0;
  for (unsigned s = 1; s <= 4; ++s) largest = std::max(largest, shard_of(models, s, 4).size());
  EXPECT_DOUBLE_EQ(plan.longest_shard, static_cast<double>(largest));
  const std::string text = to_text(plan, 4, 2);
  EXPECT_NE(text.find("40 runs"), std::string::npos) << text;
  EXPECT_NE(text.find("lost task"), std::string::npos) << text;
}

// Models that all cost the same leave nothing to chance.
TEST(Plan, OfASample) {
  Plan plan;
  plan.by_model = {2, 2, 2};
  plan.seconds = 6;
  const Extrapolation same = extrapolated(plan, 10, 4);
  EXPECT_DOUBLE_EQ(same.seconds, 20);
  EXPECT_DOUBLE_EQ(same.low, 20);
  EXPECT_DOUBLE_EQ(same.high, 20);
  EXPECT_DOUBLE_EQ(same.longest_shard, 6);
  // One in a hundred costs 99 hours, in a collection ten times as large. The number of such models
  // is nearly a Poisson variable of mean 10 whose mean was estimated from one: standard deviation
  // about sqrt(10 + 100), so the interval reaches from almost none to about three times as much.
  plan.by_model.assign(100, 0);
  plan.by_model[37] = 360000;
  plan.seconds = 360000;
  const Extrapolation tail = extrapolated(plan, 1000, 50);
  EXPECT_DOUBLE_EQ(tail.seconds, 3600000);
  EXPECT_LT(tail.low, 0.2 * tail.seconds);
  EXPECT_GT(tail.high, 2.5 * tail.seconds);
  EXPECT_LT(tail.high, 4.5 * tail.seconds);
  EXPECT_GE(tail.longest_shard, 360000);
  EXPECT_NE(to_text(tail, 50, 2).find("1000 models like these: 1000.00 h"), std::string::npos);
  EXPECT_THROW(extrapolated(plan, 99, 1), std::runtime_error);
  EXPECT_THROW(extrapolated({}, 99, 1), std::runtime_error);
}

TEST(Plan, NeedsSomethingMeasuredOfEveryMesher) {
  EXPECT_THROW(plan_of({model("a", 100)}, {"m"}, {row("a", "n", 100, 1, 0, 1)}, 1, 60),
               std::runtime_error);
  RunRow killed = row("a", "m", 100, 1, 0, 1);
  killed.disposition = Disposition::killed;
  EXPECT_THROW(plan_of({model("a", 100)}, {"m"}, {killed}, 1, 60), std::runtime_error);
}

}  // namespace
}  // namespace tetproof
