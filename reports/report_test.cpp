// Figures, comparisons and the page, from a made-up campaign.
#include "reports/report.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "reports/assets.h"
#include "reports/compare.h"
#include "reports/fidelity.h"
#include "reports/figures.h"
#include "reports/html.h"
#include "reports/made_up_runs.h"
#include "reports/series_style.h"
#include "reports/tables.h"

namespace tetproof::report_test {
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

// A campaign of 16 meshers, whose runs have twelve phases.
Selection large_campaign() {
  std::vector<RunRow> rows;
  for (int i = 0; i < 16; ++i) {
    const std::string mesher = "mesher-" + std::to_string(i);
    for (const char* model : {"figure8-h0.1", "figure8-h0.01"}) {
      RunRow row = row_of({model, mesher.c_str(), kOk, 1000, 5, 1, 14, 400});
      row.mesh->volume = row.mesh->shortest_edge = 1;
      row.mesh_json =
          R"({"tetrahedra": 1000, "face_angle_histogram": [1], "dihedral_histogram": [1]})";
      row.stats_json =
          R"({"phases_seconds": {"read": 1, "check": 1, "filter": 1, "chamfer": 1, "delaunay": 1, "segments": 1,
              "facets": 1, "refine": 1, "enrich": 1, "classify": 1, "round": 1, "write": 1}})";
      rows.push_back(row);
    }
  }
  return select_runs(rows);
}

std::vector<Chart> every_chart(const Selection& selection) {
  std::vector<Chart> all = {disposition_chart(selection), time_chart(selection),
                            speed_chart(selection),       phase_chart(selection),
                            cactus_chart(selection),      size_cactus_chart(selection),
                            figure_8_chart(selection)};
  for (const auto& charts :
       {extreme_angle_charts(selection), average_angle_charts(selection),
        angle_charts(selection, ""), angle_charts(selection, selection.models.front())}) {
    all.insert(all.end(), charts.begin(), charts.end());
  }
  return all;
}

// The colours themselves: series_style_test.cpp.
TEST(Figures, NoTwoSeriesOfAChartShareAColour) {
  std::size_t most = 0;
  for (const Selection& selection : {campaign(), detailed_campaign(), large_campaign()}) {
    for (const Chart& chart : every_chart(selection)) {
      std::set<std::uint32_t> light, dark;
      for (const Chart::Series& series : chart.series) {
        const SeriesStyle style = series_style(series.style);
        EXPECT_TRUE(light.insert(style.light).second) << chart.name << ": " << series.label;
        EXPECT_TRUE(dark.insert(style.dark).second) << chart.name << ": " << series.label;
      }
      most = std::max(most, chart.series.size());
    }
  }
  EXPECT_EQ(most, 16U);
  EXPECT_EQ(phase_chart(large_campaign()).series.size(), 12U);
}

TEST(Figures, AMesherHasTheSameColourInEveryChart) {
  const Selection selection = large_campaign();
  std::map<std::string, std::size_t> styles;
  for (const Chart& chart : every_chart(selection)) {
    for (const Chart::Series& series : chart.series) {
      const std::string mesher = series.label.substr(0, series.label.find(' '));
      if (!selection.has(mesher)) continue;
      EXPECT_EQ(styles.emplace(mesher, series.style).first->second, series.style) << chart.name;
    }
  }
  EXPECT_EQ(styles.size(), 16U);
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
  EXPECT_NEAR(*p.size_ratio, std::sqrt(2 * 2.25), 1e-12);  // inside: 400/200 and 9000/4000
  EXPECT_EQ(p.covers, "");
  EXPECT_NEAR(*p.min_angle[1], -*q.min_angle[1], 1e-12);
  EXPECT_EQ(p.time_probability, q.time_probability);
  EXPECT_EQ(p.mcnemar, q.mcnemar);
}

// A hull beside an interior, neither file telling its inside, is not a comparison of sizes.
TEST(Compare, WhatDoesNotCoverTheSameIsMarked) {
  std::vector<RunRow> rows = {row_of({"a", "cdt", kOk, 100, 5, 1, 0, 0}),
                              row_of({"a", "tetgen", kOk, 50, 5, 1, 0, 0})};
  rows[0].region = "hull";
  rows[1].region = "interior";
  EXPECT_EQ(pair_up(select_runs(rows), "cdt", "tetgen").covers, " (hull / interior)");
  const Table table = pairing_table(select_runs(rows));
  const auto at = std::find(table.header.begin(), table.header.end(), "Size ratio");
  EXPECT_EQ(table.rows.at(0).at(0), "tetgen");
  EXPECT_EQ(table.rows.at(0).at(at - table.header.begin()), "2.000 (interior / hull)");
  rows[1].region = "hull";
  EXPECT_EQ(pair_up(select_runs(rows), "cdt", "tetgen").covers, "");
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

TEST(Fidelity, NothingStandsBesideWhatWasNotRun) {
  std::vector<RunRow> rows = {row_of({"a", "delmesher", kOk, 100, 5, 1, 0, 0})};
  for (const Table& table : fidelity_tables(select_runs(rows), "hash-a")) {
    EXPECT_FALSE(has_data(table)) << table.name;
  }
}

TEST(Fidelity, ColumnsSayWhoseNumbersTheyHold) {
  for (const Table& table : fidelity_tables(campaign(), "hash-a")) {
    EXPECT_TRUE(has_data(table)) << table.name;
    EXPECT_EQ(table.title.rfind("Beside the paper's", 0), 0U) << table.title;
    for (std::size_t i = 1; i < table.header.size(); ++i) {
      const std::string& column = table.header[i];
      EXPECT_TRUE(column.find("paper") != std::string::npos ||
                  column.find("here") != std::string::npos)
          << table.name << ": " << column;
    }
  }
}

TEST(Fidelity, ThePapersNumbersStandThere) {
  Selection selection = campaign();
  selection.runs["delmesher-nofilter"]["hash-a"] =
      row_of({"a", "delmesher-nofilter", kOk, 900, 5, 1, 14, 0});
  std::string all;
  for (const Table& table : fidelity_tables(selection, "hash-a")) all += to_markdown(table);
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
  // A link to the paper is fetched by nobody who does not ask for it.
  const std::regex foreign("(src|href)=\"(?!#|data:|https://dl\\.acm\\.org/)");
  const auto before_scripts = page.substr(0, page.find("<script>"));
  EXPECT_FALSE(std::regex_search(before_scripts, foreign));
  EXPECT_EQ(before_scripts.find("@import"), std::string::npos);
  EXPECT_NE(page.find("THREE.OrbitControls"), std::string::npos);
  EXPECT_NE(page.find("Chart.js v"), std::string::npos);
  EXPECT_NE(page.find("<a href=\"https://dl.acm.org/"), std::string::npos);
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

TEST_F(ReportFolder, SectionsWithoutDataAreLeftOut) {
  write_report(campaign(), folder_);
  const std::string page = text("report.html"), markdown = text("report.md");
  // No model of Figure 8, no run without bridges.
  EXPECT_EQ(page.find("id=\"chamfering\""), std::string::npos);
  EXPECT_EQ(page.find("#chamfering"), std::string::npos);
  EXPECT_EQ(markdown.find("## Bridges"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "ablation.csv"));
  EXPECT_NE(page.find("id=\"success\""), std::string::npos);

  RunRow row = row_of({"a", "delmesher", kOk, 100, 5, 1, 0, 0});
  write_report(select_runs({row}), folder_);
  const std::string small = text("report.html");
  for (const char* id : {"compare", "fidelity", "failures", "figure9"}) {
    EXPECT_EQ(small.find("id=\"" + std::string(id) + "\""), std::string::npos) << id;
  }
  const std::regex section("<section id=\"[a-z0-9]*\">\\s*<h2>[^<]*</h2>\\s*</section>");
  EXPECT_FALSE(std::regex_search(small.substr(0, small.find("<script")), section));
}

TEST_F(ReportFolder, UnverifiedMeshesAreInTheHeadline) {
  Selection selection = detailed_campaign();
  for (const char* model : {"hash-a", "hash-b"}) {
    selection.runs.at("cdt").at(model).disposition = Disposition::unverified;
  }
  const ReportFiles files = write_report(selection, folder_);
  EXPECT_NE(files.headline.find("cdt: 1/3, 2 unverified"), std::string::npos) << files.headline;
  EXPECT_NE(files.headline.find("2 meshes are unverified"), std::string::npos);
  const std::string page = text("report.html");
  const std::string top = page.substr(0, page.find("<main>"));
  EXPECT_NE(top.find("<b>1/3</b> cdt, 2 unverified"), std::string::npos)
      << top.substr(top.find("<header"));
  EXPECT_NE(top.find("2 meshes are unverified"), std::string::npos);
  for (const char* file :
       {"report.md", "tables.tex", "table1.csv", "table2.csv", "table2-all.csv"}) {
    EXPECT_NE(text(file).find("1/3, 2 unverified"), std::string::npos) << file;
  }
  EXPECT_NE(text("runs.csv").find(",unverified,"), std::string::npos);
  write_report(detailed_campaign(), folder_);
  const std::string none = text("report.html");
  const auto header = none.find("<header>");
  EXPECT_EQ(none.substr(header, none.find("<main>") - header).find("unverified"),
            std::string::npos);
}

TEST_F(ReportFolder, DifferentLimitsAreInTheHeadline) {
  Selection selection = detailed_campaign();
  for (auto& [model, row] : selection.runs.at("tetgen")) row.key.limits = "wall 5 s";
  EXPECT_NE(write_report(selection, folder_).headline.find("The limits differ"), std::string::npos);
  const std::string page = text("report.html");
  EXPECT_NE(page.substr(0, page.find("<main>")).find("The limits differ"), std::string::npos);
}

TEST(Page, SaysWhatTheBuildLacks) {
  const Selection selection = detailed_campaign();
  Page page;
  page.title = "t";
  page.sections = {
      {"success", "Success", "", {disposition_table(selection)}, {disposition_chart(selection)}}};
  const auto start = [&] {
    const std::string html = to_html(page, selection);
    return html.substr(0, html.find("<script"));
  };
  EXPECT_EQ(start().find("this build lacks"), std::string::npos);
  page.has_charts = page.has_pictures = false;
  const std::string without = start();
  EXPECT_NE(without.find("this build lacks Chart.js"), std::string::npos);
  EXPECT_NE(without.find("this build lacks three.js"), std::string::npos);
  EXPECT_NE(without.find("dispositions-chart.csv"), std::string::npos);
  EXPECT_EQ(without.find("class=\"frame\" data-chart"), std::string::npos);
  EXPECT_EQ(to_html(page, selection).find("Chart.js v"), std::string::npos);
}

TEST(Page, CommandsFoldAndNamesStayWhole) {
  const std::string command =
      "delmesher mesh --delta 10 --tau 1e-3 --acute 60 --region hull --improve off";
  Table table = {"n", "t", {"Mesher", "Flags"}, {{"safe-delmesher-e4", command}}, {}};
  table.folded_columns = {1};
  const std::string html = to_html(table);
  EXPECT_NE(html.find("<span class=\"whole\">safe-delmesher-e4</span>"), std::string::npos) << html;
  EXPECT_NE(html.find("<details class=\"fold\"><summary>command</summary><code>" + command + "<"),
            std::string::npos);
}

TEST_F(ReportFolder, TheLeagueComesFirstAndThePapersTablesLater) {
  write_report(campaign(), folder_);
  const std::string page = text("report.html");
  std::size_t before = 0;
  for (const char* id : {"league", "figures", "success", "speed", "tables", "fidelity"}) {
    const std::size_t at = page.find("id=\"" + std::string(id) + "\"");
    ASSERT_NE(at, std::string::npos) << id;
    EXPECT_LT(before, at) << id;
    before = at;
  }
  EXPECT_LT(page.find("Table 1: "), page.find("Table 2: "));
  EXPECT_LT(page.find("class=\"frame\""), page.find("id=\"models\""));
}

// Of five meshers on three models: who makes most meshes, and on the model of all of them who is
// fastest.
TEST_F(ReportFolder, OpensWithWhatWasRunAndWhoIsBest) {
  Selection selection = campaign();
  for (auto& [mesher, runs] : selection.runs) {
    for (auto& [model, row] : runs) {
      row.host = "box";
      if (mesher == "tetgen") row.key.version = "tetgen 1.6";
      if (model == "hash-c") row.started = "2026-01-03T00:00:00Z";
      if (row.mesh) row.mesh->min_dihedral = mesher == "tetgen" ? 12 : 9;
      if (row.inside) row.inside->min_dihedral = mesher == "tetgen" ? 12 : 9;
    }
  }
  const std::string headline = write_report(selection, folder_).headline;
  for (const char* sentence :
       {"3 models, 5 meshers (", ", tetgen 1.6, cdt 1,",
        ", run from 2026-01-01 to 2026-01-03, on box.\n",
        "are of cdt and safe-delmesher-e4: 3 of 3 models.\n",
        "inside are of tetgen: 12 degrees (median of the 1 model on which all succeed).\n",
        "The fastest is cdt: 0.005 s", "Diazzi, Dai, Panozzo, Attene"}) {
    EXPECT_NE(headline.find(sentence), std::string::npos) << sentence << '\n' << headline;
  }
  const std::string page = text("report.html");
  const auto header = page.find("<header>");
  EXPECT_NE(page.substr(header, page.find("<main>") - header).find("The fastest is"),
            std::string::npos);
}

TEST_F(ReportFolder, EveryTableAndFigureIsAFileToo) {
  write_report(detailed_campaign(), folder_);
  for (const char* name :
       {"report.md", "tables.tex", "runs.csv", "table1.csv", "table2.csv", "table2-all.csv",
        "table2-inside.csv", "table3.csv", "figure10-min-face-angle.csv",
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
  row.key.version = "delmesher 1";
  row.key.flags = "mesh";
  row.model_path = folder_ / "a.off";
  row.mesh_path = folder_ / "kept.tet";
  std::vector<std::string> notes;
  const auto parts = collect_views(select_runs({row}), {}, notes);
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[0].label, "input");
  EXPECT_EQ(parts[1].label, "chamfered, delmesher");
  EXPECT_TRUE(parts[2].mesh);
  EXPECT_TRUE(parts[2].ours);
  EXPECT_EQ(parts[2].quality, std::vector<std::uint8_t>{180});  // 45 degrees
  for (const float x : parts[2].vertices) EXPECT_LE(std::fabs(x), 1);
  EXPECT_TRUE(notes.empty());
  row.model_path = folder_ / "gone.off";
  EXPECT_TRUE(collect_views(select_runs({row}), {}, notes).empty());
  EXPECT_EQ(notes.size(), 1U);
}

// Under any name that it has here, and in any order of the names.
TEST_F(ReportFolder, ThePageOpensOnOurMesh) {
  std::filesystem::create_directories(folder_);
  std::vector<RunRow> rows;
  for (const char* model : {"a", "b"}) {
    for (const char* mesher : {"cdt", "abc", "zzz"}) {
      const std::string name = std::string(model) + mesher;
      std::ofstream(folder_ / (name + ".off"))
          << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
      std::ofstream(folder_ / (name + ".tet"))
          << "4 vertices\n1 tets\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 0 1 2 3\n";
      RunRow row = row_of({model, mesher, kOk, 1, 45, 1, 0, 0});
      row.key.version = std::string(mesher) == "abc" ? "TetGen 1.5" : "delmesher 1";
      row.key.flags = std::string(mesher) == "cdt" ? "cdt --region hull" : "mesh --delta 1";
      row.model_path = folder_ / (name + ".off");
      row.mesh_path = folder_ / (name + ".tet");
      // Our mesh of model a was not kept.
      if (std::string(model) == "a" && std::string(mesher) == "zzz") row.mesh_path.clear();
      rows.push_back(row);
    }
  }
  std::vector<std::string> notes;
  const auto parts = collect_views(select_runs(rows), {}, notes);
  ASSERT_EQ(parts.size(), 7U);
  EXPECT_EQ(parts[0].model, 1U);  // b
  EXPECT_EQ(parts[1].label, "zzz");
  EXPECT_TRUE(parts[1].ours);
  for (std::size_t i = 2; i < parts.size(); ++i) EXPECT_FALSE(parts[i].ours) << parts[i].label;
  EXPECT_TRUE(notes.empty());
  // If there is no room for all parts, every model has its input and its first mesh.
  ViewOptions tight;
  tight.bytes = 500;
  const auto few = collect_views(select_runs(rows), tight, notes);
  EXPECT_EQ(
      std::count_if(few.begin(), few.end(), [](const ViewPart& p) { return p.label == "input"; }),
      2);
  EXPECT_EQ(std::count_if(few.begin(), few.end(), [](const ViewPart& p) { return p.ours; }), 1);
  EXPECT_LT(few.size(), 7U);
}

TEST_F(ReportFolder, ThePageOpensOnTheModelWithTheMostToLookAt) {
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / "a.off")
      << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  const std::string header = "5 vertices\n", vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n.1 .1 .1\n";
  std::ofstream(folder_ / "one.tet") << header << "1 tets\n" << vertices << "4 0 1 2 3\n";
  std::ofstream(folder_ / "two.tet") << header << "2 tets\n"
                                     << vertices << "4 0 1 2 4\n4 0 1 4 3\n";
  std::vector<RunRow> rows;
  for (const auto& [model, tets] : {std::pair("a", 1U), std::pair("b", 2U), std::pair("c", 1U)}) {
    RunRow& row = rows.emplace_back(row_of({model, "delmesher", kOk, tets, 45, 1, 0, 0}));
    row.key.version = "delmesher 1";
    row.key.flags = "mesh";
    row.model_path = folder_ / "a.off";
    row.mesh_path = folder_ / (tets == 1 ? "one.tet" : "two.tet");
  }
  std::vector<std::string> notes;
  const auto largest = collect_views(select_runs(rows), {}, notes);
  ASSERT_EQ(largest.size(), 6U) << (notes.empty() ? "" : notes[0]);
  EXPECT_EQ(largest[0].model, 1U);
  // Two meshes beside each other are more than one larger one.
  rows.push_back(rows[2]);
  rows.back().key.mesher = "delmesher-split";
  EXPECT_EQ(collect_views(select_runs(rows), {}, notes).at(0).model, 2U);
}

TEST_F(ReportFolder, AnEmptyCampaignGivesAReport) {
  EXPECT_NO_THROW(write_report(select_runs({}), folder_));
  EXPECT_NE(text("report.html").find("0</b> models"), std::string::npos);
}

}  // namespace
}  // namespace tetproof::report_test
