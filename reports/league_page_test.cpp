// On made-up campaigns whose numbers can be worked out by hand.
#include "reports/league_page.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <regex>

#include "reports/csv.h"
#include "reports/export.h"
#include "reports/made_up_runs.h"

namespace tetproof::league_page_test {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

class LeaguePage : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("league_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path path(const std::string& name) const { return folder_ / name; }

  static RunRow run(const char* model, const char* mesher, unsigned tets = 10,
                    Disposition disposition = kOk) {
    RunRow row = row_of({model, mesher, disposition, tets, 20, 1, 0, 0});
    row.cpu_seconds = 1;
    row.verdict_json = R"({"verdict": "exact"})";
    row.mesh_json = "{\"tetrahedra\": " + std::to_string(tets) + ", \"min_dihedral\": 12}";
    return row;
  }
  fs::path campaign(const std::string& name, const std::vector<RunRow>& rows) const {
    ResultsDatabase database(path(name), ResultsDatabase::Mode::write);
    for (const RunRow& row : rows) database.store(row);
    return path(name);
  }
  std::string page(const std::vector<fs::path>& campaigns,
                   const LeagueOptions& options = {}) const {
    write_league(campaigns, path("page.md"), options);
    return text_of(path("page.md"));
  }
  // The column of each run.
  std::vector<std::string> column(const std::string& name) const {
    const auto rows = parse_csv(text_of(path("page.csv")));
    const auto at = std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin();
    std::vector<std::string> cells;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      cells.push_back(rows[i][static_cast<std::size_t>(at)]);
    }
    return cells;
  }
  fs::path folder_;
};

TEST_F(LeaguePage, APageOfItsOwnRunsIsTheSame) {
  const fs::path runs =
      campaign("runs", {run("a", "delmesher", 5), run("b", "delmesher", 7), run("a", "netgen", 9),
                        run("b", "netgen", 0, Disposition::crash)});
  const std::string first = page({runs}, {.families = {}, .commit = "abc1234", .left_out = {}});
  const std::string csv = text_of(path("page.csv")), meshers = text_of(path("page_meshers.csv"));
  EXPECT_NE(meshers.find("1 of abc1234"), std::string::npos) << meshers;
  const std::string tables = text_of(path("page_tables.md"));
  EXPECT_EQ(page({path("page.csv")}), first);
  EXPECT_EQ(text_of(path("page_tables.md")), tables);
  EXPECT_EQ(text_of(path("page.csv")), csv);
  EXPECT_EQ(text_of(path("page_meshers.csv")), meshers);
}

TEST_F(LeaguePage, RunsOfEqualVersionsStayAndOthersTakeTheirPlace) {
  page({campaign("first", {run("a", "netgen", 1), run("b", "netgen", 0, Disposition::killed),
                           run("c", "netgen", 1)})});
  RunRow other = run("c", "netgen", 2);
  other.key.version = "2";
  page(
      {path("page.csv"), campaign("later", {run("a", "netgen", 2), run("b", "netgen", 2), other})});
  EXPECT_EQ(column("tetrahedra"), (std::vector<std::string>{"1", "2", "2"}));
}

TEST_F(LeaguePage, ALaterRunWithASolverTakesThePlaceOfOneWithout) {
  page({campaign("first", {run("a", "netgen", 1)})});
  RunRow solved = run("a", "netgen", 3);
  solved.mesh_json = R"({"tetrahedra": 3, "solver": {"unknowns": 1000, "iterations": 20,
    "converged": true, "condition": 2.5, "mean_error": 0.01}})";
  const fs::path later = campaign("later", {solved});
  page({path("page.csv"), later});
  EXPECT_EQ(column("tetrahedra"), std::vector<std::string>{"3"});
  EXPECT_EQ(column("iterations"), std::vector<std::string>{"20"});
  EXPECT_EQ(column("condition"), std::vector<std::string>{"2.5"});
}

TEST_F(LeaguePage, LimitsThatDifferAreMadeEqual) {
  RunRow slow = run("a", "delmesher"), quick = run("b", "delmesher"), narrow = run("a", "netgen");
  slow.key.limits = quick.key.limits = "wall 6000 s, cpu 600 s, memory 0 MiB";
  narrow.key.limits = "wall 400 s, cpu 20 s, memory 2 MiB";
  slow.cpu_seconds = 21;
  quick.cpu_seconds = 20;
  quick.peak_rss_bytes = 3 << 20;
  std::string text = page({campaign("runs", {slow, quick, narrow})});
  text += text_of(path("page_tables.md"));
  EXPECT_NE(text.find("the least of them, 20 s of processor time and 2 MiB"), std::string::npos);
  for (const char* how : {"timeout", "out-of-memory"}) {
    const std::regex row("delmesher \\| +" + std::string(how) + " \\| +1 \\|");
    EXPECT_TRUE(std::regex_search(text, row)) << text;
  }
  EXPECT_EQ(column("disposition"), (std::vector<std::string>{"ok", "ok", "ok"}));
  EXPECT_NE(page({campaign("alone", {narrow})}).find("under the same limits"), std::string::npos);
}

TEST_F(LeaguePage, TheOraclesTellWhatIsInsideIfTheFileDoesNot) {
  RunRow whole = run("a", "published-e4", 90);
  whole.verdict_json = R"({"verdict": "exact", "oracles": [{"name": "angles", "checked": 7,
    "checked_what": "tetrahedra inside", "figures": {"smallest dihedral angle": 20.5,
    "1 % quantile of smallest dihedral angles": 21, "smallest face angle": 22, "mean gamma": 0.5}}]})";
  page({campaign("runs", {whole})});
  EXPECT_EQ(column("tetrahedra"), std::vector<std::string>{"7"});
  EXPECT_EQ(column("min_dihedral"), std::vector<std::string>{"20.5"});
}

TEST_F(LeaguePage, TheFirstTableHasARowPerMesherBesideOurs) {
  RunRow heavy = run("a", "netgen", 15), ours = run("a", "delmesher", 5);
  heavy.cpu_seconds = 4;
  const std::string text =
      page({campaign("runs", {ours, heavy, run("b", "netgen", 0, Disposition::wrong_result)})});
  const std::regex own(R"(\| delmesher +\|.*\| +1 \| +1 \|\n)"),
      other(R"(\| netgen +\| +2 \| +50\.0 \(.*\) +\| +1 \|.*\| +3\.00 \| +4\.00 \|\n)");
  EXPECT_TRUE(std::regex_search(text, own)) << text;
  EXPECT_TRUE(std::regex_search(text, other)) << text;
  EXPECT_EQ(text.find("<picture>"), std::string::npos);
  fs::create_directories(path("pictures"));
  std::ofstream(path("pictures/page-time-light.png")) << "x";
  EXPECT_NE(page({path("page.csv")}).find("srcset=\"pictures/page-time-dark.png\""),
            std::string::npos);
}

TEST_F(LeaguePage, WhatIsLeftOffThePageStaysBesideIt) {
  const fs::path runs = campaign("runs", {run("a", "delmesher", 5), run("a", "netgen", 9)});
  const std::string text = page({runs}, {.families = {}, .commit = "", .left_out = {"netgen"}});
  EXPECT_EQ(text.find("netgen"), std::string::npos) << text;
  EXPECT_EQ(text_of(path("page_tables.md")).find("netgen"), std::string::npos);
  EXPECT_EQ(column("tetrahedra").size(), 2U);
}

TEST_F(LeaguePage, WhatIsWrittenByHandStays) {
  const fs::path runs = campaign("runs", {run("a", "cdt")});
  EXPECT_TRUE(page({runs}).ends_with("<!-- by hand -->\n"));
  std::ofstream(path("page.md"), std::ios::app) << "## What was learnt\n\nMuch.\n";
  EXPECT_TRUE(page({runs}).ends_with("<!-- by hand -->\n## What was learnt\n\nMuch.\n"));
}

TEST_F(LeaguePage, WhatCannotBeReadIsSaidAndNothingIsWritten) {
  std::ofstream(path("other.csv")) << "model,mesher\n";
  std::ofstream(path("other_meshers.csv")) << "mesher,version,program,flags,promise,limits\n";
  EXPECT_THROW(page({path("other.csv")}), std::runtime_error);
  EXPECT_THROW(page({path("none.sqlite")}), std::runtime_error);
  const fs::path runs = campaign("runs", {run("a", "cdt")});
  EXPECT_THROW(page({runs}, {.families = {}, .commit = "", .left_out = {"cdt"}}),
               std::runtime_error);
  EXPECT_FALSE(fs::exists(path("page.md")));
  page({runs});
  std::string csv = text_of(path("page.csv"));
  std::ofstream(path("page.csv")) << csv.replace(csv.find(",10,"), 4, ",x,");
  EXPECT_THROW(read_league(path("page.csv")), std::runtime_error);
  std::ofstream(path("page_meshers.csv")) << "mesher,version,program,flags,promise,limits\n";
  EXPECT_THROW(read_league(path("page.csv")), std::runtime_error);
}

}  // namespace
}  // namespace tetproof::league_page_test
