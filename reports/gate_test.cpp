// Planted regressions are found, noise is not.
#include "reports/gate.h"

#include <gtest/gtest.h>

#include <random>

namespace tetproof {
namespace {

RunRow run(int model, double seconds = 1, std::uint64_t tetrahedra = 10000) {
  RunRow row;
  row.key = {"hash" + std::to_string(model), "delmesher", "1", "mesh", "l"};
  row.model_name = "m" + std::to_string(model) + ".off";
  row.disposition = Disposition::ok;
  row.cpu_seconds = row.wall_seconds = seconds;
  row.peak_rss_bytes = 100'000'000;
  row.host = "here";
  row.started = "2026-01-01T00:00:00Z";
  row.mesh_json = "{\"tetrahedra\": " + std::to_string(tetrahedra) + "}";
  row.mesh = mesh_columns(row.mesh_json, "");
  row.verdict_json = R"({"verdict": "exact", "oracles": [{"name": "volume", "passed": true}]})";
  return row;
}

std::vector<RunRow> campaign(int models, unsigned seed = 0, double noise = 0) {
  std::mt19937 random(seed);
  std::vector<RunRow> rows;
  for (int i = 0; i < models; ++i) {
    const double u = static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
    rows.push_back(run(i, (0.5 + 0.3 * i) * (1 + noise * (2 * u - 1))));
  }
  return rows;
}

TEST(Gate, ACampaignAgainstItself) {
  const GateReport report = compare_campaigns(campaign(30), campaign(30));
  EXPECT_EQ(report.pairs, 30U);
  EXPECT_TRUE(report.findings.empty());
  EXPECT_TRUE(report.notes.empty());
}

TEST(Gate, EveryWayOfNotBeingOkIsARegression) {
  for (const Disposition d :
       {Disposition::wrong_result, Disposition::rejected, Disposition::crash, Disposition::timeout,
        Disposition::out_of_memory, Disposition::killed}) {
    auto fresh = campaign(10);
    fresh[4].disposition = d;
    const auto report = compare_campaigns(campaign(10), fresh);
    ASSERT_EQ(report.findings.size(), 1U) << disposition_name(d);
    EXPECT_EQ(report.findings[0].kind, FindingKind::disposition);
    EXPECT_EQ(report.findings[0].model, "m4.off");
    // The other way round it is progress.
    const auto back = compare_campaigns(fresh, campaign(10));
    EXPECT_TRUE(back.findings.empty());
    EXPECT_EQ(back.notes.size(), 1U);
  }
}

TEST(Gate, AModelThreeTimesSlowerIsFound) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    auto fresh = campaign(30, seed, 0.15);
    fresh[7].cpu_seconds *= 3;
    const auto report = compare_campaigns(campaign(30, seed + 100, 0.15), fresh);
    ASSERT_EQ(report.findings.size(), 1U) << seed;
    EXPECT_EQ(report.findings[0].kind, FindingKind::time);
    EXPECT_EQ(report.findings[0].model, "m7.off");
  }
}

TEST(Gate, NoiseAloneIsNoRegression) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const auto report = compare_campaigns(campaign(30, seed, 0.2), campaign(30, seed + 100, 0.2));
    EXPECT_TRUE(report.findings.empty()) << seed << ": " << report.findings[0].text;
  }
}

TEST(Gate, AllModelsSlowerIsOneFinding) {
  auto fresh = campaign(30);
  for (RunRow& row : fresh) row.cpu_seconds *= 2;
  const auto report = compare_campaigns(campaign(30), fresh);
  ASSERT_FALSE(report.findings.empty());
  EXPECT_EQ(report.findings[0].model, "");
  EXPECT_EQ(report.findings[0].kind, FindingKind::time);
}

TEST(Gate, ASlowerMachineIsNoRegressionButASlowerModelIs) {
  auto fresh = campaign(30, 1, 0.1);
  for (RunRow& row : fresh) {
    row.cpu_seconds *= 2.5;
    row.host = "there";
  }
  EXPECT_TRUE(compare_campaigns(campaign(30), fresh).findings.empty());
  fresh[3].cpu_seconds *= 3;
  const auto report = compare_campaigns(campaign(30), fresh);
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].model, "m3.off");
}

TEST(Gate, ShortRunsAreNotTimed) {
  auto base = campaign(3), fresh = campaign(3);
  base[0].cpu_seconds = 0.01;
  fresh[0].cpu_seconds = 0.1;
  EXPECT_TRUE(compare_campaigns(base, fresh).findings.empty());
}

TEST(Gate, MoreTetrahedraOrMemory) {
  auto fresh = campaign(10);
  fresh[2] = run(2, 0.5 + 0.3 * 2, 12000);
  fresh[3].peak_rss_bytes *= 2;
  const auto report = compare_campaigns(campaign(10), fresh);
  ASSERT_EQ(report.findings.size(), 2U);
  EXPECT_EQ(report.findings[0].kind, FindingKind::memory);
  EXPECT_EQ(report.findings[1].kind, FindingKind::size);
  EXPECT_EQ(report.findings[1].model, "m2.off");
}

TEST(Gate, ALostVerdictIsARegression) {
  for (const char* verdict :
       {R"({"verdict": "deviating", "oracles": [{"name": "volume", "passed": true}]})",
        R"({"verdict": "exact", "oracles": [{"name": "volume", "passed": false}]})",
        R"({"verdict": "exact", "oracles": []})", R"({"error": "timeout"})", ""}) {
    auto fresh = campaign(5);
    fresh[1].verdict_json = verdict;
    const auto report = compare_campaigns(campaign(5), fresh);
    ASSERT_EQ(report.findings.size(), 1U) << verdict;
    EXPECT_EQ(report.findings[0].kind, FindingKind::verdict) << verdict;
  }
}

TEST(Gate, WhatIsMissingIsFoundUnlessAllowed) {
  auto fresh = campaign(5);
  fresh.pop_back();
  EXPECT_EQ(compare_campaigns(campaign(5), fresh).findings.at(0).kind, FindingKind::missing);
  const auto allowed = compare_campaigns(campaign(5), fresh, {.missing_is_bad = false});
  EXPECT_TRUE(allowed.findings.empty());
  EXPECT_EQ(allowed.notes.size(), 1U);
  EXPECT_EQ(compare_campaigns(fresh, campaign(5)).findings.size(), 0U);
}

}  // namespace
}  // namespace tetproof
