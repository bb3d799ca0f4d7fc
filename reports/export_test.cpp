#include "reports/export.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace tetproof::export_test {
namespace {

RunRow sample(const std::string& model, const std::string& mesher, Disposition disposition) {
  RunRow row;
  row.key = {"hash-" + model, mesher, "1.0", "zpcq", "wall 60 s"};
  row.model_name = model;
  row.disposition = disposition;
  row.reason = disposition == Disposition::ok ? "" : "a <bad> \"facet\" & more\x01";
  row.exit_code = disposition == Disposition::ok ? 0 : 3;
  row.wall_seconds = 0.125;
  row.peak_rss_bytes = 1234567;
  row.started = "2026-01-01T00:00:00Z";
  row.host = "here";
  if (disposition == Disposition::ok) {
    row.mesh_json =
        R"({"tetrahedra":10,"vertices":7,"face_angle_histogram":[3],"min_face_angle":0.1,
            "dihedral_histogram":[1,2],"inside":{"tetrahedra":4,"dihedral_histogram":[1]},"flat":0})";
    row.mesh = mesh_columns(row.mesh_json, "");
    row.verdict_json =
        R"({"verdict":"exact","oracles":[{"name":"volume","passed":true,"findings":["long"]}]})";
  }
  return row;
}

std::vector<RunRow> campaign() {
  return {sample("b", "cdt", Disposition::rejected), sample("a", "tetgen", Disposition::ok),
          sample("a", "cdt", Disposition::ok)};
}

TEST(Export, TheOrderOfStoringDoesNotShow) {
  auto rows = campaign();
  const auto csv = rows_to_csv(rows), json = rows_to_json(rows), xml = rows_to_junit(rows);
  std::reverse(rows.begin(), rows.end());
  EXPECT_EQ(rows_to_csv(rows), csv);
  EXPECT_EQ(rows_to_json(rows), json);
  EXPECT_EQ(rows_to_junit(rows), xml);
}

TEST(Export, StableLeavesOutWhatDiffersBetweenEqualCampaigns) {
  auto rows = campaign();
  const ExportOptions stable = {.brief = false, .stable = true};
  const auto csv = rows_to_csv(rows, stable), json = rows_to_json(rows, stable);
  for (RunRow& row : rows) {
    row.wall_seconds += 1;
    row.cpu_seconds = 7;
    row.peak_rss_bytes *= 2;
    row.host = "there";
    row.started = "2027-01-01T00:00:00Z";
    row.model_path = "elsewhere";
    row.stderr_tail = "text";
    row.command = "other/folder";
  }
  EXPECT_EQ(rows_to_csv(rows, stable), csv);
  EXPECT_EQ(rows_to_json(rows, stable), json);
  rows[1].verdict_json = R"({"verdict":"broken"})";
  EXPECT_NE(rows_to_csv(rows, stable), csv);
  EXPECT_NE(rows_to_json(rows, stable), json);
}

TEST(Export, JsonIsReadBack) {
  const auto rows = rows_from_json(rows_to_json(campaign()));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].key, sample("a", "cdt", Disposition::ok).key);
  EXPECT_EQ(rows[0].wall_seconds, 0.125);
  EXPECT_EQ(rows[0].mesh->min_face_angle, 0.1);  // the exact double
  EXPECT_EQ(verdict_of(rows[0]), "exact");
  EXPECT_EQ(rows[2].disposition, Disposition::rejected);
  EXPECT_EQ(rows[2].exit_code, 3);
  EXPECT_EQ(rows_to_json(rows), rows_to_json(campaign()));
  const auto brief = rows_from_json(rows_to_json(campaign(), {.brief = true, .stable = false}));
  EXPECT_EQ(verdict_of(brief[0]), "exact");
  EXPECT_EQ(brief[0].mesh->tetrahedra, 10U);
  EXPECT_EQ(brief[0].inside->tetrahedra, 4U);
  EXPECT_EQ(brief[0].mesh_json.find("histogram"), std::string::npos);
}

TEST(Export, OtherTextIsRefused) {
  for (const char* text : {"", "{", "[]", "{\"format\": \"x\"}",
                           "{\"format\": \"tetproof-runs\", \"version\": 99, \"rows\": []}",
                           "{\"format\": \"tetproof-runs\", \"version\": 1, \"rows\": [{}]}"}) {
    EXPECT_THROW(rows_from_json(text), std::runtime_error) << text;
  }
}

TEST(Export, JunitCountsRefusalsAsFailures) {
  const std::string xml = rows_to_junit(campaign());
  EXPECT_NE(xml.find("<testsuite name=\"cdt\" tests=\"2\" failures=\"1\""), std::string::npos);
  EXPECT_NE(xml.find("<failure type=\"rejected\" message=\"a &lt;bad&gt; &quot;facet&quot; &amp; "
                     "more?\">"),
            std::string::npos)
      << xml;
}

// An error is a test that could not be completed.
TEST(Export, UnverifiedMeshesAreErrorsInJunit) {
  RunRow row = sample("a", "cdt", Disposition::ok);
  row.verdict_json = R"({"error":"processor limit of 900 s"})";
  demand_verdict(row);
  const std::string xml = rows_to_junit({row, sample("b", "cdt", Disposition::ok)});
  EXPECT_NE(xml.find("tests=\"2\" failures=\"0\" errors=\"1\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("<error type=\"unverified\" message=\"the oracles have not finished: "
                     "processor limit of 900 s\">"),
            std::string::npos)
      << xml;
}

// Exports of versions before the disposition `unverified`.
TEST(Export, RowsReadAreNotOkWithoutAVerdict) {
  RunRow row = sample("a", "cdt", Disposition::ok);
  row.verdict_json.clear();
  row.verify_seconds = 2.5;
  const auto rows = rows_from_json(rows_to_json({row}));
  EXPECT_EQ(rows.at(0).disposition, Disposition::unverified);
  EXPECT_EQ(rows.at(0).verify_seconds, 2.5);
}

TEST(Export, FilesAreToldApartByTheirContent) {
  const auto base =
      std::filesystem::path(testing::TempDir()) / ("export_test_" + std::to_string(getpid()));
  const auto json = base.string() + ".json", database = base.string() + ".sqlite";
  std::ofstream(json) << rows_to_json(campaign());
  for (const RunRow& row : campaign()) {
    ResultsDatabase(database, ResultsDatabase::Mode::write).store(row);
  }
  EXPECT_EQ(rows_to_json(read_rows(json)), rows_to_json(read_rows(database)));
  EXPECT_THROW(read_rows(base), std::runtime_error);
  for (const char* end : {".json", ".sqlite", ".sqlite-wal", ".sqlite-shm", ".sqlite.lock"}) {
    std::filesystem::remove(base.string() + end);
  }
}

}  // namespace
}  // namespace tetproof::export_test
