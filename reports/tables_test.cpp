// Tables of a small made-up campaign, against numbers computed by hand.
#include "reports/tables.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "reports/compare.h"
#include "reports/figures.h"
#include "reports/made_up_runs.h"
#include "reports/measures.h"
#include "reports/report.h"

namespace tetproof::tables_test {
namespace {

TEST(Tables, Table1) {
  const Table table = table_1(campaign());
  auto t = cells(table);
  EXPECT_EQ(table.header, (std::vector<std::string>{"Measure", "safe-delmesher-e4", "delmesher-e4",
                                                    "tetgen-T0", "tetgen", "cdt"}));
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

// Two of three meshes were measured for their shapes; cdt has none.
TEST(Tables, ShapesAreAveragedOverTheMeshesMeasuredForThem) {
  Selection selection = campaign();
  const auto measured = [&](const char* model, double mean_gamma, double below_5) {
    RunRow& row = selection.runs.at("safe-delmesher-e4").at(std::string("hash-") + model);
    row.mesh->mean_gamma = mean_gamma;
    row.mesh->share_below_5 = below_5;
  };
  EXPECT_FALSE(cells(table_1(selection)).contains("Avg. mean gamma"));
  measured("a", 0.5, 0.01);
  measured("b", 0.7, 0.03);
  for (const Table& table : {table_1(selection), table_2_all(selection)}) {
    auto t = cells(table);
    EXPECT_EQ(t["Avg. mean gamma"]["safe-delmesher-e4"], "0.600");
    EXPECT_EQ(t["Avg. % of tets below 5 degrees"]["safe-delmesher-e4"], "2.000");
    EXPECT_EQ(t["Avg. mean gamma"]["cdt"], "-");
    EXPECT_FALSE(t.contains("Avg. mean SICN"));
    EXPECT_TRUE(table.notes.back().starts_with("gamma: "));
  }
  auto t = cells(table_3(selection, "hash-b"));
  EXPECT_EQ(t["mean gamma"]["safe-delmesher-e4"], "0.700");
  EXPECT_EQ(t["mean gamma"]["cdt"], "-");
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

// A mesher by a name of the user's, and one that never succeeds.
Selection campaign_with_others() {
  std::vector<RunRow> rows;
  for (const auto& [mesher, runs] : campaign().runs) {
    for (const auto& [model, row] : runs) rows.push_back(row);
  }
  for (const Made& made :
       std::initializer_list<Made>{{"a", "mine", kOk, 700, 7, 1, 0, 300},
                                   {"b", "mine", kOk, 800, 7, 1, 0, 300},
                                   {"a", "hopeless", Disposition::crash, 0, 0, 0, 0, 0}}) {
    rows.push_back(row_of(made));
  }
  return select_runs(rows);
}

TEST(Tables, EveryMesherThatWasRunIsInTables1And2) {
  const Selection selection = campaign_with_others();
  for (const Table& table : {table_1(selection), table_2(selection), table_2_all(selection)}) {
    for (const std::string& mesher : selection.meshers) {
      EXPECT_EQ(std::count(table.header.begin(), table.header.end(), mesher), 1)
          << table.name << " " << mesher;
    }
  }
  EXPECT_EQ(cells(table_1(selection))["Models (ok of runs)"]["mine"], "2/2");
  EXPECT_EQ(cells(table_1(selection))["Models (ok of runs)"]["hopeless"], "0/1");
  EXPECT_EQ(cells(table_1(selection))["Avg. # tetrahedra"]["mine"], "750");
}

TEST(Tables, AMesherWithoutSuccessDoesNotEmptyTable2) {
  const Table table = table_2(campaign_with_others());
  auto t = cells(table);
  EXPECT_EQ(t["Avg. # tetrahedra"]["tetgen"], "500");  // model a
  EXPECT_EQ(t["Avg. # tetrahedra"]["hopeless"], "-");
  EXPECT_EQ(t["Successes (ok of runs)"]["hopeless"], "0/1");
  EXPECT_NE(to_markdown(table).find("none of their successes can be compared: hopeless."),
            std::string::npos);
}

// Only model a is ok with all five; a and c are with the other four.
TEST(Tables, TheNoteNamesTheMesherThatCostsMostModels) {
  const Table table = table_2(campaign());
  EXPECT_NE(table.notes[0].find("Without tetgen-T0 they would be over 2."), std::string::npos)
      << table.notes[0];
}

TEST(Tables, RegionsAreTold) {
  Selection selection = campaign();
  for (auto& [model, row] : selection.runs.at("cdt")) row.region = "hull";
  for (auto& [model, row] : selection.runs.at("tetgen")) row.region = "interior";
  selection.runs.at("tetgen").at("hash-c").region = "hull";
  auto t = cells(table_1(selection));
  EXPECT_EQ(t["Region"]["cdt"], "hull");
  EXPECT_EQ(t["Region"]["tetgen"], "mixed");
  EXPECT_EQ(t["Region"]["tetgen-T0"], "not told");
  // Beside each number, too.
  EXPECT_EQ(t["Avg. # tetrahedra"]["cdt"], "200 (hull)");
  EXPECT_EQ(t["Avg. # tetrahedra"]["tetgen"], "5250 (mixed)");
  EXPECT_EQ(t["Avg. # tetrahedra"]["tetgen-T0"], "600");
  EXPECT_EQ(cells(table_2(selection))["Avg. # tetrahedra"]["cdt"], "100 (hull)");
}

TEST(Tables, CaptionsTellTheLimitsAndWhetherTheyDiffer) {
  Selection selection = campaign();
  EXPECT_EQ(table_1(selection).caption, "Limits of each run: l.");
  EXPECT_FALSE(limits_differ(selection, selection.meshers));
  for (auto& [model, row] : selection.runs.at("tetgen")) row.key.limits = "wall 5 s";
  EXPECT_TRUE(limits_differ(selection, selection.meshers));
  EXPECT_FALSE(limits_differ(selection, {"cdt", "delmesher-e4"}));
  const std::string caption = limits_caption(selection, selection.meshers);
  EXPECT_NE(caption.find("The limits differ:"), std::string::npos) << caption;
  EXPECT_NE(caption.find("tetgen: wall 5 s"), std::string::npos) << caption;
  for (const Table& table :
       {table_1(selection), table_2(selection), table_2_all(selection), table_2_inside(selection),
        disposition_table(selection), speed_table(selection), time_table(selection),
        pairing_table(selection), table_3(selection, "hash-a"), slowest_table(selection)}) {
    EXPECT_EQ(table.caption.rfind("The limits differ:", 0), 0U) << table.name;
    EXPECT_NE(to_markdown(table).find(table.caption), std::string::npos);
    EXPECT_NE(to_latex(table).find("The limits differ:"), std::string::npos);
  }
  // Mixed limits of one mesher.
  selection.runs.at("cdt").at("hash-a").key.limits = "wall 9 s";
  EXPECT_EQ(limits_caption(selection, {"cdt"}), "Limits of each run: l or wall 9 s.");
  EXPECT_TRUE(limits_differ(selection, {"cdt"}));
}

TEST(Tables, TimeOfTheOraclesIsShownWhereRunsAreListed) {
  Selection selection = campaign();
  EXPECT_EQ(cells(time_table(selection))["cdt"]["oracles, all s"], "-");
  selection.runs.at("cdt").at("hash-a").verify_seconds = 1.25;
  selection.runs.at("cdt").at("hash-b").verify_seconds = 3.25;
  EXPECT_EQ(cells(time_table(selection))["cdt"]["oracles, all s"], "4.5");
  EXPECT_EQ(cells(time_table(selection))["cdt"]["oracles, median s"], "2.25");
  EXPECT_EQ(cells(table_1(selection))["Average time of the oracles (s)"]["cdt"], "2.25");
  EXPECT_EQ(slowest_table(selection).header.back(), "Oracles, s");
  selection.runs.at("tetgen").at("hash-b").verify_seconds = 7;
  const Table failures = failure_table(selection);
  EXPECT_TRUE(std::any_of(failures.rows.begin(), failures.rows.end(),
                          [](const auto& row) { return row[1] == "tetgen" && row[4] == "7.00"; }));
}

TEST(Tables, NothingIsShownOfWhatThereIsNot) {
  for (const Table& table :
       {table_1(select_runs({})), table_2(select_runs({})), ablation_table(campaign()),
        figure_8_table(campaign()), oracle_table(campaign()), phase_table(campaign())}) {
    EXPECT_FALSE(has_data(table)) << table.name;
  }
  EXPECT_TRUE(has_data(table_1(campaign())));
  EXPECT_FALSE(has_data({"n", "t", {"a", "b"}, {{"x", "-"}, {"y", ""}}, {}}));
}

TEST(Selection, BareCommandsGetShortNames) {
  std::vector<RunRow> rows;
  for (const char* mesher :
       {"cmd:/opt/bin/mesh.py {in} {out.mesh}", "cmd:'/usr/bin/mesh.py -q {in} {out.msh}'",
        "cmd,region=hull:prog {in} {out.mesh}", "named", "delmesher"}) {
    rows.push_back(row_of({"a", mesher, kOk, 10, 1, 1, 0, 0}));
  }
  std::vector<std::string> notes;
  shorten_commands(rows, notes);
  std::vector<std::string> names;
  for (const RunRow& row : rows) names.push_back(row.key.mesher);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"cmd:mesh.py", "cmd:mesh.py-2", "cmd:prog",
                                             "delmesher", "named"}));
  ASSERT_EQ(notes.size(), 3U);
  EXPECT_NE(notes[0].find(" is the mesher given as cmd"), std::string::npos);
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
  EXPECT_EQ(table2["Successes (ok of runs)"]["cdt"], "2/3, 1 unverified");
  EXPECT_EQ(cells(table_1(selection))["Models (ok of runs)"]["cdt"], "2/3, 1 unverified");
  EXPECT_EQ(cells(table_2_all(selection))["Successes (ok of runs)"]["cdt"], "2/3, 1 unverified");
  EXPECT_NE(to_markdown(pairing_table(selection)).find("cdt 1"), std::string::npos);
  const Table table3 = table_3(selection, "hash-a");
  EXPECT_EQ(std::count(table3.header.begin(), table3.header.end(), "cdt"), 0);
  EXPECT_NE(to_markdown(table3).find("unverified: cdt"), std::string::npos);
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

// Sizes and times relative to the default, over the models on which both are ok.
TEST(Tables, DeviationsStandBesideTheDefault) {
  std::vector<RunRow> rows;
  for (const Made& made :
       std::initializer_list<Made>{{"a", "delmesher-split", kOk, 1000, 4, 1, 0, 0},
                                   {"b", "delmesher-split", kOk, 3000, 6, 1, 0, 0},
                                   {"c", "delmesher-split", Disposition::crash, 0, 0, 1, 0, 0},
                                   {"a", "delmesher+order", kOk, 2000, 3, 1, 0, 0},
                                   {"b", "delmesher+order", Disposition::timeout, 0, 0, 1, 0, 0},
                                   {"c", "delmesher+order", kOk, 77, 3, 1, 0, 0},
                                   {"a", "delmesher-e4", kOk, 9000, 3, 1, 0, 1500},
                                   {"b", "delmesher-e4", kOk, 9000, 2, 1, 0, 1500},
                                   {"a", "tetgen", kOk, 1000, 4, 1, 0, 0}}) {
    rows.push_back(row_of(made));
    rows.back().cpu_seconds = made.tets / 1000.0;
  }
  const Selection selection = select_runs(rows);
  const Table table = deviation_table(selection);
  ASSERT_EQ(table.rows.size(), 3U);
  auto t = cells(table);
  EXPECT_EQ(t["delmesher-split"]["ok of runs"], "2/3");
  EXPECT_EQ(t["delmesher-split"]["All tetrahedra"], "1.000");
  EXPECT_EQ(t["delmesher+order"]["ok of runs"], "2/3");
  EXPECT_EQ(t["delmesher+order"]["Models with both"], "1");
  EXPECT_EQ(t["delmesher+order"]["All tetrahedra"], "2.000");
  EXPECT_EQ(t["delmesher+order"]["Time"], "2.000");
  EXPECT_EQ(t["delmesher-e4"]["All tetrahedra"], "0.750");  // 3000 inside of 4000
  EXPECT_EQ(t["delmesher-e4"]["per model"], "1.000");       // median of 1.5 and 0.5
  EXPECT_EQ(t["delmesher-e4"]["Min face angle"], "5.000");  // inside: twice 3 and 2
  EXPECT_EQ(t["delmesher-e4"]["Time"], "6.000");            // median of 9 and 3
  const Chart chart = deviation_chart(selection);
  EXPECT_EQ(chart.categories, (std::vector<std::string>{"delmesher-e4", "delmesher+order"}));
  EXPECT_FALSE(has_data(deviation_table(campaign())));
  EXPECT_TRUE(deviation_chart(campaign()).empty());
}

TEST(Tables, LimitsThatStruckAreCounted) {
  Selection selection = campaign();
  EXPECT_FALSE(has_data(limit_table(selection)));
  EXPECT_FALSE(has_data(ladder_table(selection)));
  const auto stats = [](int stops, double acute, const char* capped) {
    return R"({"parameters": {"acute": 60}, "guarantee": {"acute": )" + std::to_string(acute) +
           R"(}, "ladder": {"larger_tau": )" + std::to_string(stops > 0 ? 1 : 0) +
           R"(, "other_orders": )" + std::to_string(stops) +
           R"(, "untangle": 0}, "limits": {"refinement_capped": )" + capped +
           R"(, "cdt_restarts": 2, "thinned": 5}})";
  };
  auto& runs = selection.runs.at("safe-delmesher-e4");
  runs.at("hash-a").stats_json = stats(3, 60, "false");
  runs.at("hash-b").stats_json = stats(33, 90, "true");
  runs.at("hash-c").stats_json = stats(0, 60, "false");
  const Table table = limit_table(selection);
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0],
            (std::vector<std::string>{"safe-delmesher-e4", "3", "1", "1", "6", "15"}));
  const std::vector<std::vector<std::string>> taken = {
      {"safe-delmesher-e4", "3", "larger_tau", "2", "2"},
      {"safe-delmesher-e4", "3", "other_orders", "2", "36"}};
  EXPECT_EQ(ladder_table(selection).rows, taken);
}

// A copy that ended in another way than its model is a change of mind, whichever of them is ok.
// Runs that were killed or not verified say nothing.
TEST(Tables, MeshersThatChangeTheirMindAreReported) {
  std::vector<RunRow> rows;
  for (const Made& made : std::initializer_list<Made>{
           {"dir/a.off", "netgen", kOk, 1000, 4, 1, 0, 0},
           {"dir/a@t1.off", "netgen", kOk, 1200, 4, 1, 0, 0},  // another mesh, but one
           {"dir/a@t2.off", "netgen", Disposition::crash, 0, 0, 1, 0, 0},
           {"dir/a@n1.off", "netgen", Disposition::killed, 0, 0, 1, 0, 0},
           {"dir/a@s1.off", "netgen", Disposition::unverified, 0, 0, 1, 0, 0},
           {"b.off", "netgen", Disposition::rejected, 0, 0, 1, 0, 0},
           {"b@t1.off", "netgen", kOk, 90, 4, 1, 0, 0},
           {"b@t12.off", "netgen", Disposition::timeout, 0, 0, 1, 0, 0},
           {"b@e1.off", "netgen", Disposition::rejected, 0, 0, 1, 0, 0},
           {"b@r1.off", "netgen", kOk, 90, 4, 1, 0, 0},        // rotated, not exactly
           {"b@test.off", "netgen", kOk, 90, 4, 1, 0, 0},      // no copy
           {"other/b@t1.off", "netgen", kOk, 90, 4, 1, 0, 0},  // of a model that was not run
           {"a.off", "tetgen", kOk, 1000, 4, 1, 0, 0}}) {      // no copies
    rows.push_back(row_of(made));
  }
  const Selection selection = select_runs(rows);
  using Row = std::vector<std::string>;
  EXPECT_EQ(
      vary_table(selection).rows,
      (std::vector<Row>{{"netgen", "turned by an exact matrix", "4", "1", "3", "1", "1"},
                        {"netgen", "one edge split at its midpoint", "1", "1", "0", "0", "0"}}));
  const Table changes = vary_changes_table(selection);
  ASSERT_EQ(changes.rows.size(), 3U);
  EXPECT_EQ(changes.rows[0],
            (Row{"netgen", "b@t1", "turned by an exact matrix", "rejected: a | reason", "ok"}));
  EXPECT_EQ(changes.rows[1], (Row{"netgen", "b@t12", "turned by an exact matrix",
                                  "rejected: a | reason", "timeout: a | reason"}));
  EXPECT_EQ(changes.rows[2],
            (Row{"netgen", "a@t2", "turned by an exact matrix", "ok", "crash: a | reason"}));
  EXPECT_TRUE(vary_table(campaign()).rows.empty());
  EXPECT_TRUE(vary_changes_table(campaign()).rows.empty());
}

// Copies of a model have their ratios to it. A copy that is not ok has none, but is counted.
TEST(Tables, RotatedCopiesStandBesideTheirModels) {
  std::vector<RunRow> rows;
  for (const Made& made : std::initializer_list<Made>{
           {"dir/a.off", "cdt", kOk, 1000, 4, 1, 0, 0},
           {"dir/a@r1.off", "cdt", kOk, 1050, 4, 1, 0, 0},
           {"dir/a@r2.off", "cdt", kOk, 3000, 1, 1, 0, 0},
           {"dir/a@r1s.off", "cdt", Disposition::crash, 0, 0, 1, 0, 0},
           {"dir/a@r2s.off", "cdt", kOk, 1400, 2, 1, 0, 0},
           {"dir/a@rest.off", "cdt", kOk, 77, 4, 1, 0, 0},     // no rotation
           {"other/a@r1.off", "cdt", kOk, 50000, 4, 1, 0, 0},  // of a model that was not run
           {"dir/a.off", "tetgen", kOk, 1000, 4, 1, 0, 0}}) {  // no copies
    rows.push_back(row_of(made));
  }
  const Table table = rotated_table(select_runs(rows));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"cdt", "as given", "2", "2", "1077", "-", "-",
                                                     "-", "-", "-", "-", "-"}));
  EXPECT_EQ(table.rows[1],
            (std::vector<std::string>{"cdt", "rotated", "3", "3", "4050", "2.02", "2.02", "3",
                                      "50.0 %", "50.0 %", "0.625", "-"}));
  EXPECT_EQ(table.rows[2],
            (std::vector<std::string>{"cdt", "rotated, float32", "2", "1", "1400", "1.4", "1.4",
                                      "1.4", "0.0 %", "100.0 %", "0.5", "-"}));
  ASSERT_EQ(table.notes.size(), 2U);
  EXPECT_NE(table.notes[1].find("1 runs are not ok"), std::string::npos);
  EXPECT_TRUE(rotated_table(campaign()).rows.empty());
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
  EXPECT_EQ(table.rows[5], (std::vector<std::string>{"unverified", "1"}));
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
  for (const char* name : {"report.md", "table1.csv", "table2.csv", "table2-inside.csv",
                           "dispositions.csv", "speed.csv", "not-ok.csv", "runs.csv"}) {
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
}  // namespace tetproof::tables_test
