// Figures, comparisons and the page, from a made-up campaign.
#include "reports/report.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "reports/compare.h"
#include "reports/fidelity.h"
#include "reports/figures.h"
#include "reports/html.h"
#include "reports/made_up_runs.h"
#include "reports/tables.h"

namespace tetproof {
namespace {

// The campaign with the measured texts that figures and pages read.
Selection detailed_campaign() {
  Selection selection = campaign();
  for (auto& [mesher, runs] : selection.runs) {
    for (auto& [model, row] : runs) {
      if (!row.mesh) continue;
      row.mesh_json =
          nlohmann::json({{"tetrahedra", row.mesh->tetrahedra},
                          {"face_angle_histogram", {1, 2, 3, 4, 0, 0, 0, 0, 0, 0, 0, 0}},
                          {"dihedral_histogram", {5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 5}}})
              .dump();
      row.stats_json = R"({"phases_seconds": {"read": 1, "refine": 2, "enrich": 1}})";
      row.command = "mesher </script> \"" + row.model_name + "\"";
    }
  }
  return selection;
}

double sum(const Chart::Series& series) {
  double total = 0;
  for (const auto& value : series.values) total += value.value_or(0);
  return total;
}

TEST(Figures, HistogramsAddUpToTheSuccessesOfEachMesher) {
  const Selection selection = detailed_campaign();
  for (const auto& charts : {extreme_angle_charts(selection), average_angle_charts(selection),
                             angle_charts(selection, ""), angle_charts(selection, "hash-a")}) {
    EXPECT_EQ(charts.size() % 2, 0U);
    for (const Chart& chart : charts) {
      EXPECT_EQ(chart.series.size(), 5U) << chart.name;
      for (const auto& series : chart.series) {
        EXPECT_EQ(series.values.size(), chart.categories.size());
        EXPECT_NEAR(sum(series), 100, 1e-9) << chart.name << " " << series.label;
      }
    }
  }
}

TEST(Figures, TheDenominatorIsInTheLabel) {
  const Chart chart = extreme_angle_charts(detailed_campaign())[0];
  EXPECT_EQ(chart.series[0].label, "tetgen-T0 (1)");
  EXPECT_EQ(chart.series[2].label, "cdt (3)");
  // safe-delmesher-e4: 2, 4 and 0.003 degrees, all in the first bin of 5.
  EXPECT_EQ(chart.categories[0], "0-5");
  EXPECT_NEAR(*chart.series[3].values[0], 100, 1e-9);
}

TEST(Figures, Figure13IsOfTheAnglesOfOneModel) {
  const Chart chart = angle_charts(detailed_campaign(), "hash-a")[0];
  EXPECT_NEAR(*chart.series[0].values[3], 40, 1e-9);
  EXPECT_EQ(chart.categories.size(), 12U);
  EXPECT_EQ(chart.categories[11], "165-180");
}

TEST(Figures, CactusCountsSuccessesOnly) {
  const Chart chart = cactus_chart(detailed_campaign());
  for (const auto& series : chart.series) {
    EXPECT_EQ(series.points.size(), series.label == "cdt" || series.label == "safe-delmesher-e4"
                                        ? 3U
                                    : series.label == "tetgen-T0" ? 1U
                                                                  : 2U);
    for (std::size_t i = 1; i < series.points.size(); ++i) {
      EXPECT_LE(series.points[i - 1].second, series.points[i].second);
    }
  }
}

TEST(Figures, DispositionsAddUp) {
  const Chart chart = disposition_chart(campaign());
  for (std::size_t i = 0; i < chart.categories.size(); ++i) {
    double total = 0;
    for (const auto& series : chart.series) total += *series.values[i];
    EXPECT_NEAR(total, 100, 0.02) << chart.categories[i];
  }
}

TEST(Figures, Figure8EstimatesFromVolumeAndShortestEdge) {
  std::vector<RunRow> rows;
  for (const auto& [name, edge, tets] :
       {std::tuple{"figure8-h0.1.off", 0.1, 1000U}, std::tuple{"figure8-h0.01.off", 0.01, 9000U}}) {
    RunRow row = row_of({name, "delmesher", kOk, tets, 5, 1, 0, 0});
    row.mesh->volume = 2;
    row.mesh->shortest_edge = edge;
    rows.push_back(row);
  }
  const Table table = figure_8_table(select_runs(rows));
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][0], "0.1");
  EXPECT_EQ(table.rows[0][5], "2e+03");
  EXPECT_EQ(table.rows[0][6], "0.5");
  EXPECT_EQ(figure_8_chart(select_runs(rows)).series.at(0).points.size(), 2U);
  EXPECT_TRUE(figure_8_table(campaign()).rows.empty());
}

TEST(Compare, SwappingTheSidesInverts) {
  const Selection selection = campaign();
  const Pairing p = pair_up(selection, "tetgen", "safe-delmesher-e4");
  const Pairing q = pair_up(selection, "safe-delmesher-e4", "tetgen");
  EXPECT_EQ(p.models, 3U);
  EXPECT_EQ(p.both, 2U);
  EXPECT_EQ(p.only_first, 0U);
  EXPECT_EQ(p.only_second, 1U);
  EXPECT_EQ(q.only_first, 1U);
  EXPECT_NEAR(*p.time_ratio * *q.time_ratio, 1, 1e-12);
  EXPECT_NEAR(*p.size_ratio, 2, 1e-12);  // 1000/500 and 20000/10000
  EXPECT_NEAR(*p.min_angle[1], -*q.min_angle[1], 1e-12);
  EXPECT_EQ(p.time_probability, q.time_probability);
  EXPECT_EQ(p.mcnemar, q.mcnemar);
}

TEST(Compare, VersionsStandBesideEachOther) {
  const auto file = std::filesystem::path(testing::TempDir()) /
                    ("compare_test_" + std::to_string(getpid()) + ".json");
  std::ofstream(file) << R"({"format": "tetproof-runs", "version": 1, "rows": [
    {"model": "a", "model_sha256": "h", "mesher": "cdt", "version": "1", "flags": "", "limits": "",
     "disposition": "ok", "mesh": {"tetrahedra": 5}, "verdict": {"verdict": "exact"}}]})";
  const Selection selection = load_runs({file}, {file});
  EXPECT_EQ(selection.meshers, (std::vector<std::string>{"cdt", "cdt@base"}));
  EXPECT_EQ(pairs_of(selection).at(0), std::pair(std::string("cdt@base"), std::string("cdt")));
  EXPECT_EQ(pairing_table(selection).rows.size(), 1U);
  std::filesystem::remove(file);
}

TEST(Fidelity, ThePapersNumbersStandThere) {
  std::string all;
  for (const Table& table : fidelity_tables(campaign(), "hash-a")) all += to_markdown(table);
  for (const char* number :
       {"590725", "669177", "172.78", "179.79", "117", "31005", "543356", "180"}) {
    EXPECT_NE(all.find(number), std::string::npos) << number;
  }
  EXPECT_NE(all.find("does not add up"), std::string::npos);
}

TEST(Views, Base64) {
  EXPECT_EQ(base64("", 0), "");
  EXPECT_EQ(base64("f", 1), "Zg==");
  EXPECT_EQ(base64("fo", 2), "Zm8=");
  EXPECT_EQ(base64("foobar", 6), "Zm9vYmFy");
}

TEST(Table, Latex) {
  const Table table = {"n", "100 % of a_b", {"a", "b"}, {{"x & y", "1"}}, {"a note"}};
  const std::string text = to_latex(table);
  EXPECT_NE(text.find("\\caption{100 \\% of a\\_b. a note}"), std::string::npos);
  EXPECT_NE(text.find("x \\& y & 1 \\\\"), std::string::npos);
  EXPECT_NE(text.find("\\begin{tabular}{lr}"), std::string::npos);
}

class ReportFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("report_page_test_" + std::to_string(getpid()));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string text(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::filesystem::path folder_;
};

TEST_F(ReportFolder, ThePageNeedsNothingButItself) {
  write_report(detailed_campaign(), folder_);
  const std::string page = text("report.html");
  const std::regex foreign("(src|href)=\"(?!#|data:)");
  const auto before_scripts = page.substr(0, page.find("<script>"));
  EXPECT_FALSE(std::regex_search(before_scripts, foreign));
  EXPECT_EQ(before_scripts.find("@import"), std::string::npos);
  EXPECT_NE(page.find("THREE.OrbitControls"), std::string::npos);
  EXPECT_NE(page.find("Chart.js v"), std::string::npos);
}

TEST_F(ReportFolder, TheDataOfThePageAreWhole) {
  write_report(detailed_campaign(), folder_);
  const std::string page = text("report.html");
  const std::string start = "id=\"data\">";
  const auto from = page.find(start) + start.size();
  const auto json = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  EXPECT_EQ(json.at("runs").size(), 15U);
  EXPECT_EQ(json.at("runs")[0].size(), json.at("columns").size());
  EXPECT_EQ(json.at("models").size(), 3U);
  EXPECT_EQ(json.at("meshers").size(), 5U);
  EXPECT_EQ(json.at("runs")[0].back(), "mesher </script> \"a\"");
  for (const auto& chart : json.at("charts")) {
    EXPECT_NE(page.find("data-chart=\"" + chart.at("name").get<std::string>() + "\""),
              std::string::npos);
  }
}

TEST_F(ReportFolder, TablesAndHistogramsComeFirst) {
  write_report(campaign(), folder_);
  const std::string page = text("report.html");
  const auto one = page.find("Table 1: "), two = page.find("Table 2: ");
  const auto histogram = page.find("class=\"frame\"");
  ASSERT_NE(histogram, std::string::npos);
  EXPECT_LT(one, two);
  EXPECT_LT(two, histogram);
  for (const char* later : {"id=\"success\"", "id=\"fidelity\"", "id=\"models\""}) {
    EXPECT_LT(histogram, page.find(later)) << later;
  }
}

TEST_F(ReportFolder, EveryTableAndFigureIsAFileToo) {
  write_report(detailed_campaign(), folder_);
  for (const char* name :
       {"report.md", "tables.tex", "runs.csv", "table1.csv", "table2.csv", "table2-all.csv",
        "table2-inside.csv", "table3.csv", "ablation.csv", "figure10-min-face-angle.csv",
        "figure11-average-max-dihedral-angle.csv", "figure13-face-angles.csv", "pairs.csv",
        "slowest.csv", "failures.csv", "phases-chart.csv", "fidelity-table1.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  }
}

TEST_F(ReportFolder, TableThreeIsOfTheModelAskedFor) {
  write_report(campaign(), folder_, {.model = "c", .views = {}});
  EXPECT_NE(text("report.md").find("Table 3: one model, c"), std::string::npos);
  EXPECT_THROW(write_report(campaign(), folder_, {.model = "none", .views = {}}),
               std::runtime_error);
}

TEST_F(ReportFolder, KeptMeshesAreShown) {
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / "a.off")
      << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  std::ofstream(folder_ / "kept.tet")
      << "4 vertices\n1 tets\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 0 1 2 3\n";
  std::ofstream(folder_ / "kept.chamfered.off")
      << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  RunRow row = row_of({"a", "delmesher", kOk, 1, 45, 1, 0, 0});
  row.model_path = folder_ / "a.off";
  row.mesh_path = folder_ / "kept.tet";
  std::vector<std::string> notes;
  const auto parts = collect_views(select_runs({row}), {}, notes);
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[0].label, "input");
  EXPECT_EQ(parts[1].label, "chamfered, delmesher");
  EXPECT_TRUE(parts[2].mesh);
  EXPECT_EQ(parts[2].quality, std::vector<std::uint8_t>{180});  // 45 degrees
  for (const float x : parts[2].vertices) EXPECT_LE(std::fabs(x), 1);
  EXPECT_TRUE(notes.empty());
  row.model_path = folder_ / "gone.off";
  EXPECT_TRUE(collect_views(select_runs({row}), {}, notes).empty());
  EXPECT_EQ(notes.size(), 1U);
}

TEST_F(ReportFolder, AnEmptyCampaignGivesAReport) {
  EXPECT_NO_THROW(write_report(select_runs({}), folder_));
  EXPECT_NE(text("report.html").find("0</b> models"), std::string::npos);
}

}  // namespace
}  // namespace tetproof
