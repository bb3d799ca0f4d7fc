#include "reports/league.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "reports/html.h"
#include "reports/made_up_runs.h"

namespace tetproof::league_test {
namespace {

class League : public testing::Test {
 protected:
  void SetUp() override {
    file_ = std::filesystem::path(testing::TempDir()) / ("families_" + std::to_string(getpid()));
  }
  void TearDown() override { std::filesystem::remove(file_); }
  Families families(const std::string& text) const {
    std::ofstream(file_) << text;
    return Families(file_);
  }
  std::filesystem::path file_;
};

TEST_F(League, RowsAreOrderedBySuccessAndTellItsInterval) {
  const Table table = league_table(campaign());
  ASSERT_EQ(table.rows.size(), 5U);
  EXPECT_EQ(table.rows[0][0], "cdt");  // 3 of 3, as safe-delmesher-e4, which comes after it
  EXPECT_EQ(table.rows[1][0], "safe-delmesher-e4");
  EXPECT_EQ(table.rows[4][0], "tetgen-T0");  // 1 of 3
  const auto found = cells(table);
  EXPECT_EQ(found.at("cdt").at("Ok, % (95 % interval)"), "100.0 (43.9 to 100.0)");
  // (1 + z^2/2 -+ z sqrt(2/3 + z^2/4)) / (3 + z^2) for z = 1.96
  EXPECT_EQ(found.at("tetgen-T0").at("Ok, % (95 % interval)"), "33.3 (6.1 to 79.2)");
  EXPECT_EQ(found.at("tetgen").at("crash"), "1");
  EXPECT_EQ(found.at("tetgen").at("rejected"), "0");
  EXPECT_EQ(found.at("delmesher-e4").at("timeout"), "1");
  EXPECT_EQ(found.at("safe-delmesher-e4").at("tets"), "900");  // inside, of 3000
  EXPECT_EQ(found.at("safe-delmesher-e4").at("s"), "0.50");
}

TEST_F(League, AnUnverifiedMeshIsNoSuccess) {
  Selection selection = campaign();
  selection.runs.at("cdt").at("hash-a").disposition = Disposition::unverified;
  const auto found = cells(league_table(selection));
  EXPECT_EQ(found.at("cdt").at("Ok"), "2");
  EXPECT_EQ(found.at("cdt").at("unverified"), "1");
}

TEST_F(League, PromisesThatDifferAreMixed) {
  Selection selection = campaign();
  EXPECT_EQ(cells(league_table(selection)).at("cdt").at("Promise"), "-");
  for (auto& [model, row] : selection.runs.at("cdt")) row.promise = "exact";
  EXPECT_EQ(cells(league_table(selection)).at("cdt").at("Promise"), "exact");
  selection.runs.at("cdt").at("hash-a").promise = "envelope 0.001";
  EXPECT_EQ(cells(league_table(selection)).at("cdt").at("Promise"), "mixed");
}

TEST_F(League, TheFirstPatternDecides) {
  const Families f = families("# comment\n\nvoron_*,printed\n*bunny*,scans\nvoron_bunny,never\n");
  EXPECT_EQ(f.of("voron_bunny.off"), "printed");
  EXPECT_EQ(f.of("folder/fat_bunny_2.stl"), "scans");
  EXPECT_EQ(f.of("bunn.off"), "other");
  EXPECT_EQ(f.names(), (std::vector<std::string>{"printed", "scans", "never", "other"}));
  EXPECT_THROW(families("no comma\n"), std::runtime_error);
  EXPECT_THROW(families("pattern,\n"), std::runtime_error);
  EXPECT_THROW(Families("/nonexistent"), std::runtime_error);
}

TEST_F(League, EveryModelCountsInOneFamily) {
  const Table table = family_table(campaign(), families("a,first\nb,second\n"));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(cells(table).at("first").at("tetgen"), "1/1");
  EXPECT_EQ(cells(table).at("second").at("tetgen"), "0/1");
  EXPECT_EQ(cells(table).at("other").at("cdt"), "1/1");
  EXPECT_TRUE(family_table(campaign(), {}).rows.empty());
}

TEST_F(League, TheMatrixHasACellForEachRun) {
  const Table table = league_matrix(campaign(), {});
  const auto found = cells(table);
  EXPECT_EQ(found.at("c").at("tetgen-T0"), "rejected");
  EXPECT_EQ(found.at("b").at("tetgen"), "crash");
  EXPECT_EQ(found.at("c").at("delmesher-e4"), "6.00");
  EXPECT_NE(to_html(table).find("<table class=\"heat\">"), std::string::npos);
  EXPECT_EQ(to_html(league_table(campaign())).find("heat"), std::string::npos);
}

// 1000 unknowns: their cube root is 10. A mesh of few unknowns, and one whose solver gave up, do
// not count.
TEST_F(League, ASolverComparesAtEqualUnknowns) {
  Selection selection = campaign();
  EXPECT_TRUE(solver_table(selection).rows.empty());
  const auto told = [](int unknowns, bool converged) {
    return "{\"solver\": {\"unknowns\": " + std::to_string(unknowns) +
           ", \"iterations\": 35, \"condition\": 250.0, \"mean_error\": 0.004, \"converged\": " +
           (converged ? "true" : "false") + "}}";
  };
  auto& runs = selection.runs.at("cdt");
  runs.at("hash-a").mesh_json = told(1000, true);
  runs.at("hash-b").mesh_json = told(8, true);
  runs.at("hash-c").mesh_json = told(27000, false);
  const auto found = cells(solver_table(selection));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.at("cdt").at("Meshes"), "1");
  EXPECT_EQ(found.at("cdt").at("unknowns n"), "1000");
  EXPECT_EQ(found.at("cdt").at("iterations / n^(1/3)"), "3.50");
  EXPECT_EQ(found.at("cdt").at("condition / n^(2/3)"), "2.50");
  EXPECT_EQ(found.at("cdt").at("error x n^(2/3)"), "0.400");
}

// Of a, b and c, all three mesh a and c, in 500 and 10000 and in 1500 and 30000 tetrahedra.
TEST_F(League, MeshersOfAKindAreComparedOnWhatAllOfThemMesh) {
  const std::vector<Table> groups = group_tables(campaign());
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].title, "Those with TetGen, on the 1 models on which all of them succeed");
  const auto found = cells(groups[0]);
  EXPECT_EQ(found.size(), 3U);
  EXPECT_EQ(found.at("delmesher-e4").at("tets"), "500");  // inside
  EXPECT_EQ(found.at("tetgen").at("tets"), "200");
}

TEST_F(League, PairsTellWhoSucceedsAlone) {
  Selection selection = campaign();
  EXPECT_TRUE(pair_table(selection).rows.empty());
  selection.runs["delmesher"] = selection.runs.at("delmesher-e4");
  selection.meshers.emplace_back("delmesher");
  const auto found = cells(pair_table(selection));
  EXPECT_EQ(found.at("tetgen").at("Models"), "3");
  EXPECT_EQ(found.at("tetgen").at("only ours ok"), "0");
  EXPECT_EQ(found.at("tetgen").at("both ok"), "2");
  EXPECT_EQ(found.at("cdt").at("only it ok"), "1");
  EXPECT_EQ(found.at("tetgen").at("tets, it / ours"), "0.40");  // 200 of 500, 4000 of 10000
}

TEST_F(League, FailuresOfAKindAreCountedTogether) {
  Selection selection = campaign();
  auto& runs = selection.runs.at("tetgen-T0");
  for (auto& [model, row] : runs) row.model_name = "d/m" + row.model_name + ".off";
  runs.at("hash-b").reason = "p: d/mb.off: 7 points, 1.5e-3 apart";
  runs.at("hash-c").reason = "p: mc.off: 8 points, -2 apart";
  selection.runs.at("cdt").at("hash-a").disposition = Disposition::wrong_result;
  selection.runs.at("cdt").at("hash-a").reason = "verify: broken: conformity: edge 1\nis gone";
  const Table table = failure_kinds(selection);
  const auto has = [&](const std::vector<std::string>& row) {
    return std::find(table.rows.begin(), table.rows.end(), row) != table.rows.end();
  };
  EXPECT_TRUE(has({"tetgen-T0", "rejected: p: MODEL: # points, # apart", "2", "mb, mc"}));
  EXPECT_TRUE(has({"cdt", "wrong-result: broken: conformity", "1", "a"}));
  EXPECT_TRUE(has({"delmesher-e4", "timeout", "1", "b"}));
}

TEST_F(League, WrongResultsComeWithTheOraclesSentence) {
  Selection selection = campaign();
  EXPECT_TRUE(wrong_result_table(selection).rows.empty());
  RunRow& row = selection.runs.at("tetgen").at("hash-b");
  row.disposition = Disposition::wrong_result;
  row.reason = "verify: broken: conformity: edge 1-2 is gone";
  const Table table = wrong_result_table(selection);
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0][0], "tetgen");
  EXPECT_EQ(table.rows[0][1], "b");
  EXPECT_EQ(table.rows[0][3], row.reason);
  EXPECT_EQ(table.pictures, std::vector<std::string>{""});
  EXPECT_EQ(to_html(table).find("<img"), std::string::npos);
  row.verdict_json = R"({"verdict": "broken", "picture": "<svg/>"})";
  const std::string page = to_html(wrong_result_table(selection));
  EXPECT_NE(page.find("src=\"data:image/svg+xml;base64,PHN2Zy8+\""), std::string::npos);
}

}  // namespace
}  // namespace tetproof::league_test
