// Campaigns one after another, made up.
#include "reports/history.h"

#include <gtest/gtest.h>

#include "reports/made_up_runs.h"

namespace tetproof::history_test {
namespace {

HistoryStep step(const std::string& name, const std::vector<Made>& runs) {
  std::vector<RunRow> rows;
  for (const Made& made : runs) rows.push_back(row_of(made));
  for (RunRow& row : rows) {
    row.key.version = "of " + name;
    row.cpu_seconds = row.wall_seconds;
    if (row.mesh) row.mesh->min_dihedral = row.mesh->min_face_angle / 2;
  }
  return {name, select_runs(rows)};
}

// Model b fails in the second campaign, c is new in it, a is larger in the third.
std::vector<HistoryStep> three_steps() {
  return {
      step("one", {{"a", "ours", kOk, 1000, 10, 1, 0, 0}, {"b", "ours", kOk, 500, 20, 1, 0, 0}}),
      step("two", {{"a", "ours", kOk, 1000, 10, 1, 0, 0},
                   {"b", "ours", Disposition::crash, 0, 0, 1, 0, 0},
                   {"c", "ours", kOk, 70, 20, 1, 0, 0}}),
      step("three", {{"a", "ours", kOk, 1300, 10, 1, 0, 0},
                     {"b", "ours", Disposition::crash, 0, 0, 1, 0, 0},
                     {"c", "ours", kOk, 70, 20, 1, 0, 0}})};
}

using Rows = std::vector<std::vector<std::string>>;

TEST(History, SumsAreOverTheModelsMeshedInAllCampaigns) {
  const Table table = history_table(three_steps());
  ASSERT_EQ(table.rows.size(), 3U);
  const std::vector<std::string> tetrahedra = {"1000", "1000", "1300"};
  const std::vector<std::string> successes = {"2/2", "2/3", "2/3"};
  for (std::size_t r = 0; r < 3; ++r) {
    ASSERT_EQ(table.rows[r].size(), table.header.size());
    EXPECT_EQ(table.rows[r][3], successes[r]);
    EXPECT_EQ(table.rows[r][5], "1");
    EXPECT_EQ(table.rows[r][6], tetrahedra[r]);
    EXPECT_EQ(table.rows[r][8], "10.00");
  }
}

TEST(History, ChangesNameTheCampaignThatBroughtThem) {
  const Table table = history_changes(three_steps());
  EXPECT_EQ(table.rows, (Rows{{"ours", "b", "disposition", "ok", "crash", "two", "of two"},
                              {"ours", "a", "tetrahedra", "1000", "1300", "three", "of three"}}));
}

TEST(History, ACampaignBesideItselfChangesNothing) {
  const std::vector<HistoryStep> steps = {three_steps()[0], three_steps()[0]};
  EXPECT_TRUE(history_changes(steps).rows.empty());
  const Chart chart = history_size_chart(steps);
  ASSERT_EQ(chart.series.size(), 1U);
  for (const auto& [x, y] : chart.series[0].points) EXPECT_EQ(y, 1);
}

TEST(History, SmallDifferencesAndNoiseAreNoChanges) {
  const auto pair = [](const Made& before, const Made& after) {
    return history_changes({step("one", {before}), step("two", {after})}).rows;
  };
  const Made base = {"a", "ours", kOk, 1000, 10, 0.1, 0, 0};
  EXPECT_EQ(pair(base, {"a", "ours", kOk, 1040, 9, 0.15, 0, 0}), Rows{});
  EXPECT_EQ(pair(base, {"a", "ours", kOk, 1060, 10, 0.1, 0, 0}).size(), 1U);
  EXPECT_EQ(pair(base, {"a", "ours", kOk, 1000, 7, 0.1, 0, 0}).size(), 2U);  // and the dihedral
  EXPECT_EQ(pair(base, {"a", "ours", kOk, 1000, 10, 0.4, 0, 0}).size(), 1U);
  EXPECT_EQ(pair({"a", "ours", kOk, 20, 10, 0.1, 0, 0}, {"a", "ours", kOk, 40, 10, 0.1, 0, 0}),
            Rows{});
}

TEST(History, AMesherThatACampaignLacksIsPassedOver) {
  const std::vector<HistoryStep> steps = {step("one", {{"a", "ours", kOk, 1000, 10, 1, 0, 0}}),
                                          step("two", {{"a", "other", kOk, 10, 10, 1, 0, 0}}),
                                          step("three", {{"a", "ours", kOk, 2000, 10, 1, 0, 0}})};
  const Table table = history_changes(steps);
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0][5], "three");
  EXPECT_EQ(history_table(steps).rows.size(), 3U);
}

}  // namespace
}  // namespace tetproof::history_test
