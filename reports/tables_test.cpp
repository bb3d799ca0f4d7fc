// Tables of a small made-up campaign, against numbers computed by hand.
#include "reports/tables.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <map>

#include "reports/made_up_runs.h"
#include "reports/report.h"

namespace tetproof {
namespace {

TEST(Tables, Table1) {
  const Table table = table_1(campaign());
  auto t = cells(table);
  EXPECT_EQ(table.header,
            (std::vector<std::string>{"Measure", "safe-delmesher-e4", "delmesher-e4"}));
  EXPECT_EQ(t["Models (ok of runs)"]["safe-delmesher-e4"], "3/3");
  EXPECT_EQ(t["Models (ok of runs)"]["delmesher-e4"], "2/3");
  EXPECT_EQ(t["Avg. # tetrahedra"]["safe-delmesher-e4"], "8000");  // 24000 / 3
  EXPECT_EQ(t["Avg. # tetrahedra"]["delmesher-e4"], "15750");      // 31500 / 2
  EXPECT_EQ(t["Avg. # vertices"]["safe-delmesher-e4"], "1600");    // 4800 / 3
  EXPECT_EQ(t["Avg. min face angle"]["safe-delmesher-e4"], "2.00 (14.97)");
  EXPECT_EQ(t["Avg. min face angle"]["delmesher-e4"], "2.00 (14.65)");
  EXPECT_EQ(t["Absolute min face angle"]["safe-delmesher-e4"], "0.003 (14.50)");
  EXPECT_EQ(t["Absolute min face angle"]["delmesher-e4"], "1.00 (14.60)");
  EXPECT_EQ(t["Average time (s)"]["safe-delmesher-e4"], "1.20");  // 3.6 / 3
  EXPECT_EQ(t["Average time (s)"]["delmesher-e4"], "3.10");       // 6.2 / 2
  EXPECT_EQ(t["Average memory (MB)"]["delmesher-e4"], "2");       // 1.575
}

TEST(Tables, ProcessorTimeTakesThePlaceOfWallTimeOnRequest) {
  Selection selection = campaign();
  for (auto& [mesher, runs] : selection.runs) {
    for (auto& [model, row] : runs) row.cpu_seconds = row.wall_seconds / 4;
  }
  use_processor_time(selection);
  const Table table = table_1(selection);
  auto t = cells(table);
  EXPECT_EQ(t["Average time (s)"]["safe-delmesher-e4"], "0.30");  // 3.6 / 3 / 4
  EXPECT_NE(table.notes.back().find("processor time"), std::string::npos);
  const RunRow& row = *selection.ok_run("safe-delmesher-e4", "hash-a");
  EXPECT_DOUBLE_EQ(*row.mesh_seconds, row.wall_seconds / 2);
}

TEST(Tables, Table2IsOverTheCommonSubset) {
  const Table table = table_2(campaign());
  auto t = cells(table);
  EXPECT_EQ(table.header, (std::vector<std::string>{"Measure", "tetgen-T0", "tetgen", "cdt",
                                                    "safe-delmesher-e4", "delmesher-e4"}));
  // Only model a is ok everywhere.
  EXPECT_EQ(t["Avg. # tetrahedra"]["tetgen-T0"], "600");
  EXPECT_EQ(t["Avg. # tetrahedra"]["cdt"], "100");
  EXPECT_EQ(t["Avg. min face angle"]["tetgen"], "5.00");
  EXPECT_EQ(t["Successes (ok of runs)"]["tetgen-T0"], "1/3");
  EXPECT_EQ(t["Successes (ok of runs)"]["cdt"], "3/3");
  EXPECT_NE(table.notes[0].find("the 1 of 3 models"), std::string::npos) << table.notes[0];
}

TEST(Tables, Table2Inside) {
  auto t = cells(table_2_inside(campaign()));
  EXPECT_EQ(t["Avg. # tetrahedra"]["tetgen"], "200");
  EXPECT_EQ(t["Avg. min face angle"]["tetgen"], "10.00");
}

TEST(Tables, Dispositions) {
  auto t = cells(disposition_table(campaign()));
  EXPECT_EQ(t["tetgen-T0"]["ok"], "1");
  EXPECT_EQ(t["tetgen-T0"]["ok %"], "33.3");
  EXPECT_EQ(t["tetgen-T0"]["rejected"], "2");
  EXPECT_EQ(t["tetgen"]["crash"], "1");
  EXPECT_EQ(t["delmesher-e4"]["timeout"], "1");
  EXPECT_EQ(t["cdt"]["ok"], "3");
  EXPECT_EQ(t["cdt"]["timeout"], "0");
}

// In no success rate and in no average, but with a column of its own.
TEST(Tables, UnverifiedMeshesAreNoSuccesses) {
  Selection selection = campaign();
  RunRow& row = selection.runs.at("cdt").at("hash-a");
  row.disposition = Disposition::unverified;
  auto t = cells(disposition_table(selection));
  EXPECT_EQ(t["cdt"]["ok"], "2");
  EXPECT_EQ(t["cdt"]["unverified"], "1");
  EXPECT_EQ(selection.ok_run("cdt", "hash-a"), nullptr);
  EXPECT_EQ(selection.common_models({"cdt"}).size(), 2U);
  auto table2 = cells(table_2(selection));
  EXPECT_EQ(table2["Successes (ok of runs)"]["cdt"], "2/3");
}

TEST(Tables, Speed) {
  auto t = cells(speed_table(campaign()));
  // safe: 100, 166.67, 150 us per tet; median 150; total 3.6 s / 24000.
  EXPECT_EQ(t["safe-delmesher-e4"]["us/tet, median"], "150.00");
  EXPECT_EQ(t["safe-delmesher-e4"]["us/tet, all tets"], "150.00");
  EXPECT_EQ(t["safe-delmesher-e4"]["us/tet meshing only, median"], "75.00");
  // tetgen: 20 and 40; ratios 100/20 = 5 and 150/40 = 3.75 on a and c.
  EXPECT_EQ(t["tetgen"]["us/tet, median"], "30.00");
  EXPECT_EQ(t["safe-delmesher-e4"]["Ratio to tetgen, median (pairs)"], "4.38 (2)");
  EXPECT_EQ(t["tetgen"]["Ratio to tetgen, median (pairs)"], "1.00 (2)");
  EXPECT_EQ(t["tetgen-T0"]["Ratio to tetgen, median (pairs)"], "1.00 (1)");
  EXPECT_EQ(t["cdt"]["Peak bytes/tet, median"], "100");
  EXPECT_EQ(t["safe-delmesher-e4"]["Peak bytes/tet, large, median (models)"], "100 (1)");
}

TEST(Tables, FailuresAreListedWithReasons) {
  const Table table = failure_table(campaign());
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(table.rows[0][0], "b");
  EXPECT_EQ(table.rows[0][1], "tetgen-T0");
  EXPECT_EQ(table.rows[0][2], "rejected");
  EXPECT_NE(to_markdown(table).find("a \\| reason"), std::string::npos);
}

TEST(Selection, TheLatestOfSeveralRunsCounts) {
  RunRow old = row_of({"a", "cdt", kOk, 100, 1, 1, 0, 0});
  RunRow recent = row_of({"a", "cdt", kOk, 200, 1, 1, 0, 0});
  recent.key.version = "2";
  recent.started = "2026-01-02T00:00:00Z";
  for (const auto& rows : {std::vector{old, recent}, std::vector{recent, old}}) {
    const Selection s = select_runs(rows);
    EXPECT_EQ(s.run("cdt", "hash-a")->mesh->tetrahedra, 200u);
    EXPECT_TRUE(s.notes.empty());
  }
  recent.key.model_sha256 = "hash-b";
  EXPECT_EQ(select_runs({old, recent}).notes.size(), 1u);
}

TEST(Tables, OraclesByMesherWithAnExample) {
  const auto verdict = [](const char* mesher, const char* model, const char* json) {
    RunRow row = row_of({model, mesher, kOk, 10, 1, 1, 0, 0});
    row.verdict_json = json;
    return row;
  };
  const Table table = oracle_table(select_runs({
      verdict("tetgen", "a",
              R"({"verdict": "broken", "oracles": [{"name": "complex", "passed": true},
                  {"name": "volume", "passed": false, "findings": ["too much", "x"]}]})"),
      verdict("tetgen", "b",
              R"({"verdict": "exact", "oracles": [{"name": "complex", "passed": true},
                  {"name": "volume", "passed": true}]})"),
      verdict("tetgen", "c", R"({"error": "timeout"})"),
      verdict("cdt", "a", ""),
  }));
  // cdt's file was not verified.
  EXPECT_EQ(table.header, (std::vector<std::string>{"Verdict or oracle", "tetgen"}));
  ASSERT_EQ(table.rows.size(), 8U);
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"files", "3"}));
  EXPECT_EQ(table.rows[1], (std::vector<std::string>{"exact", "1"}));
  EXPECT_EQ(table.rows[4], (std::vector<std::string>{"broken", "1"}));
  EXPECT_EQ(table.rows[5], (std::vector<std::string>{"not verified", "1"}));
  EXPECT_EQ(table.rows[6], (std::vector<std::string>{"complex", "2 of 2"}));
  EXPECT_EQ(table.rows[7], (std::vector<std::string>{"volume", "1 of 2"}));
  ASSERT_EQ(table.notes.size(), 2U);
  EXPECT_EQ(table.notes[1], "tetgen, volume, for example a: too much");
}

TEST(Table, CsvQuoting) {
  const Table table = {"n", "t", {"a", "b"}, {{"x,y", "say \"hi\"\nthere"}}, {}};
  EXPECT_EQ(to_csv(table), "a,b\r\n\"x,y\",\"say \"\"hi\"\"\nthere\"\r\n");
}

TEST(Report, FilesAreWritten) {
  const auto folder =
      std::filesystem::path(testing::TempDir()) / ("report_test_" + std::to_string(getpid()));
  const ReportFiles files = write_report(campaign(), folder);
  for (const char* name :
       {"report.md", "table1.csv", "table2.csv", "table2-inside.csv", "dispositions.csv",
        "oracles.csv", "speed.csv", "not-ok.csv", "runs.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  }
  EXPECT_NE(files.headline.find("Table 2"), std::string::npos);
  std::ifstream runs(folder / "runs.csv");
  int lines = 0;
  for (std::string line; std::getline(runs, line);) ++lines;
  EXPECT_EQ(lines, 16);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace tetproof
