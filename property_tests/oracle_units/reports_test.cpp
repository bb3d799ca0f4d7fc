// Reports as text and as JSON.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "oracles/verdict/report.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT

// All that an oracle says stands in both forms of the report.
TEST(Reports, LeaveNothingOut) {
  VerifyReport report;
  report.verdict = Verdict::deviating;
  report.deviation = 0.21875;
  report.deviation_ulps = 4711;
  report.deviation_share = 0.0078125;
  report.inverted = 1201;
  report.flat = 1202;
  OracleReport good("good-one", "things"), bad("bad-one", "other things");
  good.checked = 1203;
  good.notes = {"a note"};
  good.figures = {{"height", 0.4375}};
  good.histograms = {
      {"slopes", {2001, 2002, 2003, 2004, 2005, 2006, 2007, 2008, 2009, 2010, 2011, 2012}}};
  bad.checked = 1204;
  for (int i = 0; i < 7; ++i) bad.fail("finding " + std::to_string(i));
  report.oracles = {good, bad};
  EXPECT_EQ(bad.violations, 7U);
  EXPECT_EQ(bad.findings.size(), 5U);
  EXPECT_EQ(report.find("bad-one"), &report.oracles[1]);
  EXPECT_EQ(report.find("no-one"), nullptr);
  EXPECT_FALSE(report.all_passed());
  for (const std::string& text : {to_json(report), to_text(report)}) {
    for (const char* part : {"deviating", "0.21875", "4711", "0.0078125", "1201", "1202",
                             "good-one", "things", "1203", "a note", "height", "0.4375", "slopes",
                             "bad-one", "1204", "7", "finding 0", "finding 4"}) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
    }
    for (int count = 2001; count <= 2012; ++count) {
      EXPECT_NE(text.find(std::to_string(count)), std::string::npos) << count;
    }
    EXPECT_EQ(text.find("finding 5"), std::string::npos);
  }
  EXPECT_NE(to_text(report).find("7 violations"), std::string::npos);
  EXPECT_EQ(to_text(report).find("0 violations"), std::string::npos);
  report.oracles = {good};
  EXPECT_TRUE(report.all_passed());
  report.oracles[0].checked = 0;
  EXPECT_FALSE(report.all_passed());
  report.oracles.clear();
  EXPECT_FALSE(report.all_passed());
}

// A place for each finding, in its order; null where that is nowhere.
TEST(Reports, PutPlacesBesideFindings) {
  VerifyReport report;
  OracleReport oracle("an-oracle", "things");
  oracle.fail("nowhere");
  oracle.fail("an edge", Site{Site::Kind::input_edge, {3, 7, 0}});
  oracle.fail_at({0.5, -1, 2}, "a point");
  oracle.fail("a tetrahedron", Site{Site::Kind::tetrahedron, {4, 0, 0}});
  oracle.fail("one for many", Spot{Site{Site::Kind::input_triangle, {1, 0, 0}}});
  oracle.fail("too many to name", Site{Site::Kind::vertex, {9, 0, 0}});
  EXPECT_EQ(oracle.sites.size(), 3U);
  report.oracles = {oracle};
  const auto places = [&] {
    return nlohmann::json::parse(to_json(report))["oracles"][0]["places"].dump();
  };
  EXPECT_EQ(places(),
            R"([null,{"kind":"input edges","numbers":[3,7]},{"at":[0.5,-1.0,2.0]},)"
            R"({"kind":"tetrahedra","numbers":[4]},{"kind":"input triangles","numbers":[1]}])");
  report.oracles[0].forget_sites(Site::Kind::vertex, Site::Kind::listed_triangle);
  EXPECT_EQ(places(), R"([null,{"kind":"input edges","numbers":[3,7]},{"at":[0.5,-1.0,2.0]},null,)"
                      R"({"kind":"input triangles","numbers":[1]}])");
  EXPECT_EQ(report.oracles[0].sites.size(), 1U);
  report.oracles = {oracle};
  report.oracles[0].forget_sites(Site::Kind::input_vertex);
  EXPECT_EQ(places(),
            R"([null,null,{"at":[0.5,-1.0,2.0]},{"kind":"tetrahedra","numbers":[4]},null])");
  EXPECT_EQ(report.oracles[0].sites.size(), 2U);
}

TEST(Reports, NameVerdicts) {
  EXPECT_STREQ(verdict_name(Verdict::exact), "exact");
  EXPECT_STREQ(verdict_name(Verdict::rounded), "rounded");
  EXPECT_STREQ(verdict_name(Verdict::deviating), "deviating");
  EXPECT_STREQ(verdict_name(Verdict::broken), "broken");
}

// For all lengths of texts, wherever a line must be broken.
TEST(Reports, NoLineOfTextIsLongerThan120Characters) {
  for (std::size_t length = 1; length <= 100; ++length) {
    VerifyReport report;
    OracleReport oracle("an-oracle", "things");
    oracle.checked = 1;
    oracle.figures = {{std::string(length, 'x'), 1}, {"y", 2}, {std::string(100, 'z'), 3}};
    oracle.notes = {std::string(length, 'n') + " goes on " + std::string(100, 'm')};
    report.oracles = {oracle};
    const std::string text = to_text(report);
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
      ASSERT_LE(text.find('\n', at) - at, 120U) << text.substr(at, 200);
    }
  }
}

}  // namespace
}  // namespace tetproof
