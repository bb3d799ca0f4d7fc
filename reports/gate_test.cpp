// Planted regressions are found, by the measure meant for them and by no other. Noise is not.
#include "reports/gate.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "reports/export.h"

namespace tetproof::gate_test {
namespace {

using Json = nlohmann::json;
using Change = std::function<void(Json& mesh, Json& stats, Json& verdict)>;

// Applies a change to the measured mesh, the mesher's statistics and the verdict of a row.
void change(RunRow& row, const Change& what) {
  Json mesh = Json::parse(row.mesh_json), stats = Json::parse(row.stats_json),
       verdict = Json::parse(row.verdict_json);
  what(mesh, stats, verdict);
  row.mesh_json = mesh.dump();
  row.stats_json = stats.dump();
  row.verdict_json = verdict.dump();
  row.mesh = mesh_columns(row.mesh_json, "");
  row.refined = mesh_columns(row.stats_json, "refined");
}

void change_all(std::vector<RunRow>& rows, const Change& what) {
  for (RunRow& row : rows) change(row, what);
}

RunRow run(int model, double seconds = 1) {
  RunRow row;
  row.key = {"hash" + std::to_string(model), "delmesher", "1", "mesh", "l"};
  row.model_name = "m" + std::to_string(model) + ".off";
  row.disposition = Disposition::ok;
  row.cpu_seconds = row.wall_seconds = seconds;
  row.peak_rss_bytes = 100'000'000;
  row.host = "here";
  row.started = "2026-01-01T00:00:00Z";
  row.mesh_json = R"({"tetrahedra": 10000, "min_face_angle": 8, "min_dihedral": 4,
      "mean_min_face_angle": 40, "mean_max_face_angle": 90, "mean_min_dihedral": 36,
      "mean_max_dihedral": 110, "tetrahedra_below_5_degrees": 100,
      "tetrahedra_below_10_degrees": 300, "mean_gamma": 0.6, "gamma_1_percent": 0.2})";
  row.stats_json = R"({"parameters": {"tau": 0.0001, "delta": 14.47},
      "refined": {"tetrahedra": 9000, "min_face_angle": 14.5, "min_dihedral": 5}})";
  row.verdict_json = R"({"verdict": "rounded", "deviation_ulps": 0.5, "oracles": [
      {"name": "volume", "passed": true},
      {"name": "conformity", "passed": true, "figures": {"input vertices moved": 0}},
      {"name": "refined-angles", "passed": true, "figures": {"smallest face angle": 14.5}}]})";
  change(row, [](Json&, Json&, Json&) {});
  return row;
}

// Seconds from 0.5 s upwards, or all the same; noise is a relative error of the time.
std::vector<RunRow> campaign(int models, unsigned seed = 0, double noise = 0,
                             double all_seconds = 0) {
  std::mt19937 random(seed);
  std::vector<RunRow> rows;
  for (int i = 0; i < models; ++i) {
    const double u = static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
    const double seconds = all_seconds > 0 ? all_seconds : 0.5 + 0.3 * i;
    rows.push_back(run(i, seconds * (1 + noise * (2 * u - 1))));
  }
  return rows;
}

// Two sides measured by turns, `turns` times each: the k-th repetition of either side begins in the
// k-th minute.
void measure_in_turn(std::vector<RunRow>& base, std::vector<RunRow>& fresh, int turns = 2) {
  const auto repeat = [&](std::vector<RunRow>& rows, int second) {
    std::vector<RunRow> all;
    for (int turn = 0; turn < turns; ++turn) {
      for (RunRow row : rows) {
        row.started = fmt::format("2026-01-01T00:{:02}:{:02}Z", turn, second);
        all.push_back(row);
      }
    }
    rows = all;
  };
  repeat(base, 0);
  repeat(fresh, 30);
}

template <typename T>
GateOptions with(T GateOptions::*option, std::type_identity_t<T> value) {
  GateOptions options;
  options.*option = std::move(value);
  return options;
}

std::string listing(const GateReport& report) {
  std::string text;
  for (const Finding& f : report.findings) {
    text += fmt::format("{}: {} {}\n", finding_name(f.kind), f.model, f.text);
  }
  return text;
}

// Finds in models `models` of 10 findings of this kind only.
void expect_only(const GateReport& report, FindingKind kind, std::size_t findings) {
  EXPECT_EQ(report.findings.size(), findings) << listing(report);
  for (const Finding& f : report.findings) EXPECT_EQ(f.kind, kind) << listing(report);
}

TEST(Gate, ACampaignAgainstItself) {
  const GateReport report = compare_campaigns(campaign(30), campaign(30));
  EXPECT_EQ(report.pairs, 30U);
  EXPECT_EQ(report.both_ok, 30U);
  EXPECT_EQ(report.verified, 30U);
  EXPECT_TRUE(report.findings.empty());
  EXPECT_TRUE(report.notes.empty());
  EXPECT_TRUE(report.differences.empty());
  // The order of rows does not matter, and a file given twice is a repetition.
  auto twice = campaign(30);
  std::reverse(twice.begin(), twice.end());
  for (const RunRow& row : campaign(30)) twice.push_back(row);
  const GateReport again = compare_campaigns(campaign(30), twice);
  EXPECT_EQ(again.pairs, 30U);
  EXPECT_TRUE(again.findings.empty());
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

TEST(Gate, AnUnverifiedModelIsARegression) {
  auto fresh = campaign(10);
  fresh[4].disposition = Disposition::unverified;
  fresh[4].verdict_json = R"({"error": "processor limit"})";
  const auto report = compare_campaigns(campaign(10), fresh);
  expect_only(report, FindingKind::unverified, 1);
  EXPECT_NE(report.findings[0].text.find("processor limit"), std::string::npos);
  EXPECT_EQ(report.both_ok, 10U);
  EXPECT_EQ(report.verified, 9U);
  EXPECT_TRUE(compare_campaigns(fresh, campaign(10)).findings.empty());
  EXPECT_TRUE(compare_campaigns(fresh, fresh).findings.empty());
  // A row that is ok without a verdict does not vouch for itself either.
  fresh = campaign(10);
  fresh[4].verdict_json.clear();
  expect_only(compare_campaigns(campaign(10), fresh), FindingKind::unverified, 1);
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
    EXPECT_TRUE(report.findings.empty()) << seed << ": " << listing(report);
  }
}

TEST(Gate, SmallModelsAreJudgedByTheirSumWhenMeasuredInTurn) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const double slowdown : {1.0, 1.02, 1.15}) {
      auto base = campaign(60, seed, 0.1, 0.05), fresh = campaign(60, seed + 100, 0.1, 0.05);
      for (RunRow& row : fresh) row.cpu_seconds *= slowdown;
      measure_in_turn(base, fresh);
      const auto report = compare_campaigns(base, fresh);
      expect_only(report, FindingKind::time, slowdown > 1.07 ? 1 : 0);
      if (slowdown > 1.07) {
        EXPECT_EQ(report.findings.at(0).model, "");
      }
    }
  }
}

TEST(Gate, WithoutTurnsAllModelsHaveToBeMuchSlower) {
  const auto base = campaign(60, 0, 0, 0.05);
  auto fresh = base;
  for (RunRow& row : fresh) row.cpu_seconds *= 1.15;
  const auto report = compare_campaigns(base, fresh);
  EXPECT_TRUE(report.findings.empty());
  ASSERT_EQ(report.notes.size(), 1U);  // but a note reports it
  EXPECT_NE(report.notes[0].find("1.150 times"), std::string::npos) << report.notes[0];
  expect_only(compare_campaigns(base, fresh, with(&GateOptions::quiet_machine, true)),
              FindingKind::time, 1);
  auto once_base = base, once_fresh = fresh;
  measure_in_turn(once_base, once_fresh, 1);
  EXPECT_TRUE(compare_campaigns(once_base, once_fresh).findings.empty());
}

// One model that is slower does not make all of them slower.
TEST(Gate, FewModelsDoNotSpeakForAll) {
  auto base = campaign(60, 0, 0, 0.05), fresh = base;
  fresh[3].cpu_seconds += 0.6;  // a fifth of the sum
  measure_in_turn(base, fresh);
  const auto report = compare_campaigns(base, fresh);
  expect_only(report, FindingKind::time, 1);
  EXPECT_EQ(report.findings.at(0).model, "m3.off");
}

TEST(Gate, OfRepetitionsTheLeastTimeCounts) {
  auto base = campaign(60, 0, 0, 0.05), fresh = base;
  measure_in_turn(base, fresh, 3);
  for (std::size_t i = 0; i < 60; ++i) fresh[i].cpu_seconds *= 2;  // the first of three
  EXPECT_TRUE(compare_campaigns(base, fresh).findings.empty());
  // But one repetition that fails is a failure, whichever it is; one that was killed is none.
  for (std::size_t repetition = 0; repetition < 3; ++repetition) {
    auto failing = fresh;
    failing[60 * repetition + 5].disposition = Disposition::crash;
    expect_only(compare_campaigns(base, failing), FindingKind::disposition, 1);
    failing[60 * repetition + 5].disposition = Disposition::killed;
    EXPECT_TRUE(compare_campaigns(base, failing).findings.empty());
  }
}

// A tiny mesh of slivers beside a large one of few: not as if the large one were all slivers.
TEST(Gate, TheNumberOfSliversIsThatOfOneRepetition) {
  const auto slivers = [](int one, int other) {
    std::vector<RunRow> rows = {run(0), run(0)};
    change(rows[0], [one](Json& m, Json&, Json&) {
      m["tetrahedra"] = 10;
      m["tetrahedra_below_5_degrees"] = one;
    });
    change(rows[1], [other](Json& m, Json&, Json&) { m["tetrahedra_below_5_degrees"] = other; });
    return rows;
  };
  const auto found = [](const std::vector<RunRow>& base, const std::vector<RunRow>& fresh) {
    const GateReport report = compare_campaigns(base, fresh);
    return std::ranges::count_if(report.findings,
                                 [](const auto& f) { return f.kind == FindingKind::slivers; });
  };
  EXPECT_EQ(found(slivers(2, 100), slivers(4, 100)), 0);
  EXPECT_EQ(found(slivers(2, 1000), slivers(4, 1006)), 1);
}

// Wherever among the repetitions the worst of a measure is.
TEST(Gate, OfRepetitionsTheWorstOfEveryOtherMeasureCounts) {
  const std::vector<RunRow> base = campaign(1);
  const std::pair<FindingKind, Change> worse[] = {
      {FindingKind::face_angle, [](Json& m, Json&, Json&) { m["min_face_angle"] = 4; }},
      {FindingKind::gamma, [](Json& m, Json&, Json&) { m["mean_gamma"] = 0.3; }},
      {FindingKind::slivers, [](Json& m, Json&, Json&) { m["tetrahedra_below_5_degrees"] = 900; }},
      {FindingKind::size, [](Json& m, Json&, Json&) { m["tetrahedra"] = 20000; }},
      {FindingKind::size, [](Json& m, Json&, Json&) { m["tetrahedra"] = 5000; }},
      {FindingKind::face_angle,
       [](Json&, Json&, Json& v) { v["oracles"][2]["figures"]["smallest face angle"] = 7; }},
      {FindingKind::conformity, [](Json&, Json&, Json& v) { v["deviation_ulps"] = 2; }},
      {FindingKind::conformity,
       [](Json&, Json&, Json& v) { v["oracles"][1]["figures"]["input vertices moved"] = 1; }},
      {FindingKind::verdict, [](Json&, Json&, Json& v) { v["verdict"] = "deviating"; }},
      {FindingKind::oracle, [](Json&, Json&, Json& v) { v["oracles"][0]["passed"] = false; }},
      {FindingKind::oracle, [](Json&, Json&, Json& v) { v["oracles"].erase(0); }}};
  std::size_t n = 0;
  for (const auto& [kind, what] : worse) {
    for (std::size_t place = 0; place < 3; ++place) {
      std::vector<RunRow> fresh = {base[0], base[0], base[0]};
      change(fresh[place], what);
      const GateReport report = compare_campaigns(base, fresh);
      const auto found = std::ranges::count_if(
          report.findings, [kind = kind](const auto& f) { return f.kind == kind; });
      EXPECT_EQ(found, 1) << n << ", repetition " << place;
    }
    ++n;
  }
  // A smaller repetition does not hide a larger one.
  const auto sizes = [&base](int one, int other) {
    std::vector<RunRow> rows = {base[0], base[0]};
    change(rows[0], [one](Json& m, Json&, Json&) { m["tetrahedra"] = one; });
    change(rows[1], [other](Json& m, Json&, Json&) { m["tetrahedra"] = other; });
    return std::ranges::count_if(compare_campaigns(base, rows).findings,
                                 [](const auto& f) { return f.kind == FindingKind::size; });
  };
  EXPECT_EQ(sizes(9999, 20000), 1);
  EXPECT_EQ(sizes(10001, 5000), 1);
  EXPECT_EQ(sizes(9999, 10001), 0);
  std::vector<RunRow> fresh = {base[0], base[0]};
  change(fresh[1], worse[0].second);
  EXPECT_EQ(compare_campaigns(base, fresh).differences,
            (std::vector<std::string>{"delmesher: repetitions differ: 1 of 1 models of the new "
                                      "side; the worst of each measure counts"}));
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
  const auto other = compare_campaigns(campaign(30), fresh);
  EXPECT_TRUE(other.findings.empty());
  ASSERT_FALSE(other.notes.empty());
  EXPECT_NE(other.notes[0].find("different machines"), std::string::npos);
  fresh[3].cpu_seconds *= 3;
  const auto report = compare_campaigns(campaign(30), fresh);
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].model, "m3.off");
}

TEST(Gate, ShortRunsAreNotTimedOneByOne) {
  auto base = campaign(3), fresh = campaign(3);
  base[0].cpu_seconds = 0.01;
  fresh[0].cpu_seconds = 0.1;
  EXPECT_TRUE(compare_campaigns(base, fresh).findings.empty());
}

TEST(Gate, Memory) {
  auto fresh = campaign(10);
  fresh[3].peak_rss_bytes *= 2;
  auto report = compare_campaigns(campaign(10), fresh);
  expect_only(report, FindingKind::memory, 1);
  EXPECT_EQ(report.findings[0].model, "m3.off");
  for (const double factor : {1.09, 1.11}) {
    fresh = campaign(10);
    for (RunRow& row : fresh) row.peak_rss_bytes = static_cast<std::uint64_t>(1e8 * factor);
    report = compare_campaigns(campaign(10), fresh);
    expect_only(report, FindingKind::memory, factor > 1.1 ? 1 : 0);
  }
}

// A value of one model just within its limit passes, just beyond it is one finding of its kind.
struct Limit {
  const char* name;
  FindingKind kind;
  std::function<void(Json& mesh, Json& stats, Json& verdict, double value)> set;
  double within, beyond;
};

void set_figure(Json& verdict, const char* oracle, const char* figure, double value) {
  for (Json& entry : verdict["oracles"]) {
    if (entry["name"] == oracle) entry["figures"][figure] = value;
  }
}

std::vector<Limit> limits() {
  const auto mesh = [](const char* key) {
    return [key](Json& m, Json&, Json&, double value) { m[key] = value; };
  };
  return {
      {"final face angle", FindingKind::face_angle, mesh("min_face_angle"), 6.41, 6.39},
      {"refined face angle", FindingKind::face_angle,
       [](Json&, Json&, Json& verdict, double value) {
         set_figure(verdict, "refined-angles", "smallest face angle", value);
       },
       11.61, 11.59},
      {"dihedral", FindingKind::dihedral, mesh("min_dihedral"), 3.21, 3.19},
      {"refined dihedral", FindingKind::dihedral,
       [](Json&, Json& stats, Json&, double value) { stats["refined"]["min_dihedral"] = value; },
       4.01, 3.99},
      {"below 5", FindingKind::slivers, mesh("tetrahedra_below_5_degrees"), 299, 301},
      {"below 10", FindingKind::slivers, mesh("tetrahedra_below_10_degrees"), 499, 501},
      {"mean smallest face angle", FindingKind::mean_angle, mesh("mean_min_face_angle"), 38.01,
       37.99},
      {"mean largest face angle", FindingKind::mean_angle, mesh("mean_max_face_angle"), 94.49,
       94.51},
      {"mean smallest dihedral", FindingKind::mean_angle, mesh("mean_min_dihedral"), 34.21, 34.19},
      {"mean largest dihedral", FindingKind::mean_angle, mesh("mean_max_dihedral"), 113.49, 113.51},
      {"mean gamma", FindingKind::gamma, mesh("mean_gamma"), 0.571, 0.569},
      {"quantile of gamma", FindingKind::gamma, mesh("gamma_1_percent"), 0.161, 0.159},
      {"deviation", FindingKind::conformity,
       [](Json&, Json&, Json& verdict, double value) { verdict["deviation_ulps"] = value; }, 0.74,
       0.76},
      {"input vertices", FindingKind::conformity,
       [](Json&, Json&, Json& verdict, double value) {
         set_figure(verdict, "conformity", "input vertices moved", value);
       },
       0, 1}};
}

TEST(Gate, EveryMeasureOfAModelHasItsLimit) {
  for (const Limit& limit : limits()) {
    SCOPED_TRACE(limit.name);
    for (const double value : {limit.within, limit.beyond}) {
      auto fresh = campaign(10);
      change(fresh[2], [&](Json& mesh, Json& stats, Json& verdict) {
        limit.set(mesh, stats, verdict, value);
      });
      const auto report = compare_campaigns(campaign(10), fresh);
      expect_only(report, limit.kind, value == limit.beyond ? 1 : 0);
      if (!report.findings.empty()) {
        EXPECT_EQ(report.findings[0].model, "m2.off");
      }
      // The other way round it is progress.
      EXPECT_TRUE(compare_campaigns(fresh, campaign(10)).findings.empty());
    }
  }
}

// The limits for all models are narrower than those for one.
TEST(Gate, EveryMeasureOfAllModelsHasItsLimit) {
  const auto mesh = [](const char* key) {
    return [key](Json& m, Json&, Json&, double value) { m[key] = value; };
  };
  const std::vector<Limit> all = {
      {"face angle", FindingKind::face_angle, mesh("min_face_angle"), 7.21, 7.19},
      {"dihedral", FindingKind::dihedral, mesh("min_dihedral"), 3.61, 3.59},
      {"below 5", FindingKind::slivers, mesh("tetrahedra_below_5_degrees"), 149, 151},
      {"mean", FindingKind::mean_angle, mesh("mean_min_dihedral"), 35.29, 35.27},
      {"mean gamma", FindingKind::gamma, mesh("mean_gamma"), 0.589, 0.587},
      {"quantile of gamma", FindingKind::gamma, mesh("gamma_1_percent"), 0.181, 0.179},
      {"more", FindingKind::size, mesh("tetrahedra"), 10290, 10310},
      {"fewer", FindingKind::size, mesh("tetrahedra"), 9720, 9700}};
  for (const Limit& limit : all) {
    SCOPED_TRACE(limit.name);
    for (const double value : {limit.within, limit.beyond}) {
      auto fresh = campaign(10);
      change_all(fresh, [&](Json& m, Json& s, Json& v) { limit.set(m, s, v, value); });
      const auto report = compare_campaigns(campaign(10), fresh);
      expect_only(report, limit.kind, value == limit.beyond ? 1 : 0);
      // Fewer than eight pairs allow no conclusion about all.
      const std::vector<RunRow> few(fresh.begin(), fresh.begin() + 7);
      EXPECT_TRUE(compare_campaigns(campaign(7), few).findings.empty());
    }
  }
}

TEST(Gate, MoreAndFewerTetrahedra) {
  for (const int count : {10501, 10499, 9523, 9525}) {
    auto fresh = campaign(10);
    change(fresh[2], [&](Json& mesh, Json&, Json&) { mesh["tetrahedra"] = count; });
    const bool beyond = count == 10501 || count == 9523;
    expect_only(compare_campaigns(campaign(10), fresh), FindingKind::size, beyond ? 1 : 0);
    const auto allowed =
        compare_campaigns(campaign(10), fresh, with(&GateOptions::fewer_is_bad, false));
    EXPECT_EQ(allowed.findings.size(), count == 10501 ? 1U : 0U);
    EXPECT_EQ(allowed.notes.size(), count == 9523 ? 1U : 0U);
  }
  // Small meshes: 50 more or fewer count.
  auto base = campaign(1), fresh = campaign(1);
  change_all(base, [](Json& mesh, Json&, Json&) { mesh["tetrahedra"] = 100; });
  for (const int count : {149, 151, 51, 49}) {
    change_all(fresh, [&](Json& mesh, Json&, Json&) { mesh["tetrahedra"] = count; });
    expect_only(compare_campaigns(base, fresh), FindingKind::size,
                std::abs(count - 100) > 50 ? 1 : 0);
  }
}

TEST(Gate, ALostVerdictIsARegression) {
  auto fresh = campaign(5);
  change(fresh[1], [](Json&, Json&, Json& verdict) { verdict["verdict"] = "deviating"; });
  expect_only(compare_campaigns(campaign(5), fresh), FindingKind::verdict, 1);
  EXPECT_TRUE(compare_campaigns(fresh, campaign(5)).findings.empty());
}

TEST(Gate, AnOracleThatFailsOrIsSilentIsARegression) {
  auto fresh = campaign(5);
  change(fresh[1], [](Json&, Json&, Json& verdict) { verdict["oracles"][0]["passed"] = false; });
  auto report = compare_campaigns(campaign(5), fresh);
  expect_only(report, FindingKind::oracle, 1);
  EXPECT_EQ(report.findings[0].text, "oracle volume passed, does not");
  fresh = campaign(5);
  change(fresh[1], [](Json&, Json&, Json& verdict) { verdict["oracles"].erase(0); });
  report = compare_campaigns(campaign(5), fresh);
  expect_only(report, FindingKind::oracle, 1);
  EXPECT_EQ(report.findings[0].text, "oracle volume passed, was not asked");
  report = compare_campaigns(campaign(5), fresh, with(&GateOptions::may_be_silent, {"volume"}));
  EXPECT_TRUE(report.findings.empty());
  EXPECT_EQ(report.notes.size(), 1U);
}

TEST(Gate, APromiseThatIsNoLongerProvenIsARegression) {
  auto base = campaign(5), fresh = campaign(5);
  const auto say = [](RunRow& row, const char* promise) {
    change(row, [=](Json&, Json&, Json& verdict) { verdict["unproven"] = {promise}; });
  };
  say(fresh[1], "--max-edge (2 edges are longer)");
  const auto report = compare_campaigns(base, fresh);
  expect_only(report, FindingKind::oracle, 1);
  EXPECT_EQ(report.findings[0].text, "no longer proven: --max-edge");
  say(base[1], "--max-edge (7 edges are longer)");
  EXPECT_TRUE(compare_campaigns(base, fresh).findings.empty());
  EXPECT_TRUE(compare_campaigns(fresh, campaign(5)).findings.empty());
  const auto brief = rows_from_json(rows_to_json(base, {.brief = true, .stable = false}));
  EXPECT_TRUE(compare_campaigns(brief, fresh).findings.empty());
}

TEST(Gate, AnOracleThatIsThereTwiceHasToPassTwice) {
  for (const bool failed_first : {true, false}) {
    auto fresh = campaign(5);
    change(fresh[1], [=](Json&, Json&, Json& verdict) {
      verdict["oracles"].push_back({{"name", "volume"}, {"passed", failed_first}});
      verdict["oracles"][0]["passed"] = !failed_first;
    });
    expect_only(compare_campaigns(campaign(5), fresh), FindingKind::oracle, 1);
  }
}

// Which of two runs came last says nothing but the time.
TEST(Gate, RunsOfOneModelNeedATime) {
  auto fresh = campaign(5);
  RunRow again = fresh[1];
  again.key.limits = "other";
  again.disposition = Disposition::crash;
  for (const bool timed : {true, false}) {
    auto rows = fresh;
    rows.push_back(again);
    rows.back().started = "2026-01-02T00:00:00Z";
    if (!timed) {
      for (RunRow& row : rows) row.started.clear();
      EXPECT_THROW(compare_campaigns(campaign(5), rows), std::runtime_error);
    } else {
      EXPECT_FALSE(compare_campaigns(campaign(5), rows).findings.empty());
    }
  }
}

TEST(Gate, AMeshThatNeedsNoRepairIsNoRegression) {
  auto base = campaign(5), half = campaign(5);
  const auto add = [](const char* oracle) {
    return [=](Json&, Json&, Json& verdict) {
      verdict["oracles"].push_back({{"name", oracle}, {"passed", true}});
    };
  };
  for (const char* oracle : {"unrepaired-complex", "unrepaired-conformity"}) {
    change(base[0], add(oracle));
  }
  EXPECT_TRUE(compare_campaigns(base, campaign(5)).findings.empty());
  change(half[0], add("unrepaired-complex"));
  expect_only(compare_campaigns(base, half), FindingKind::oracle, 1);
}

TEST(Gate, ThreeModelsHalvedAreThreeFindings) {
  auto fresh = campaign(30);
  for (const std::size_t i : {1, 11, 21}) {
    change(fresh[i], [](Json& mesh, Json&, Json&) { mesh["min_face_angle"] = 4; });
  }
  expect_only(compare_campaigns(campaign(30), fresh), FindingKind::face_angle, 3);
}

TEST(Gate, WhatTheSidesDifferInIsSaid) {
  const auto said = [](const std::vector<RunRow>& base, const std::vector<RunRow>& fresh) {
    const auto report = compare_campaigns(base, fresh);
    EXPECT_TRUE(report.findings.empty()) << listing(report);
    return report.differences.size() == 1 ? report.differences[0] : "";
  };
  auto fresh = campaign(10);
  for (RunRow& row : fresh) row.key.flags = "mesh --slivers off";
  EXPECT_EQ(said(campaign(10), fresh),
            "delmesher: flags differ: base \"mesh\", new \"mesh --slivers off\" (10 of 10 pairs)");
  fresh = campaign(10);
  for (RunRow& row : fresh) row.key.version = "2";
  EXPECT_NE(said(campaign(10), fresh).find("versions differ"), std::string::npos);
  fresh = campaign(10);
  fresh[0].key.limits = "m";
  EXPECT_NE(said(campaign(10), fresh).find("limits differ"), std::string::npos);
  fresh = campaign(10);
  fresh[0].promise = "envelope 0.5";
  EXPECT_EQ(said(campaign(10), fresh), "");  // the base has none
  auto base = campaign(10);
  base[0].promise = "exact";
  EXPECT_NE(said(base, fresh).find("promises differ"), std::string::npos);
  // A default that changed does not show in the flags.
  fresh = campaign(10);
  change_all(fresh, [](Json&, Json& stats, Json&) { stats["parameters"]["tau"] = 0.0002; });
  EXPECT_NE(said(campaign(10), fresh).find("tau 0.0001 -> 0.0002"), std::string::npos);
}

TEST(Gate, WhatOneSideDidNotMeasureIsSaid) {
  auto old = campaign(10);
  change_all(old, [](Json& mesh, Json&, Json& verdict) {
    mesh.erase("tetrahedra_below_5_degrees");
    mesh.erase("tetrahedra_below_10_degrees");
    mesh.erase("mean_gamma");
    mesh.erase("gamma_1_percent");
    verdict.erase("deviation_ulps");
  });
  auto report = compare_campaigns(old, campaign(10));
  EXPECT_TRUE(report.findings.empty());
  EXPECT_EQ(report.differences.size(), 5U);
  for (const std::string& text : report.differences) {
    EXPECT_NE(text.find("which only the new side has measured"), std::string::npos) << text;
  }
  // What is not measured any more might be anything.
  report = compare_campaigns(campaign(10), old);
  EXPECT_TRUE(report.differences.empty());
  expect_only(report, FindingKind::unmeasured, 5);
}

TEST(Gate, ATimeThatIsGoneIsNoGoodTime) {
  auto fresh = campaign(10), base = campaign(10);
  for (RunRow& row : base) row.cpu_seconds = 50;
  for (RunRow& row : fresh) row.cpu_seconds = 0;
  expect_only(compare_campaigns(base, fresh), FindingKind::unmeasured, 1);
  auto again = fresh;  // one repetition without a time, one that took it
  for (RunRow& row : again) row.cpu_seconds = 500;
  fresh.insert(fresh.end(), again.begin(), again.end());
  EXPECT_FALSE(compare_campaigns(base, fresh).findings.empty());
  fresh.resize(again.size());
  for (RunRow& row : base) row.cpu_seconds = 0.01;  // less than what can be measured
  EXPECT_TRUE(compare_campaigns(base, fresh).findings.empty());
  for (RunRow& row : fresh) row.cpu_seconds = HUGE_VAL;
  EXPECT_FALSE(compare_campaigns(base, fresh).findings.empty());
}

TEST(Gate, AVerdictOfAnotherShapeIsNamed) {
  for (const char* verdict : {R"({"oracles": [7]})", R"({"oracles": [{"name": 5}]})",
                              R"({"error": 5})", R"({"oracles": [{"passed": "yes"}]})"}) {
    auto fresh = campaign(3);
    fresh[1].verdict_json = verdict;
    try {
      compare_campaigns(campaign(3), fresh);
      ADD_FAILURE() << verdict;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(),
                fresh[1].key.mesher + " " + fresh[1].model_name + ": a verdict of another shape");
    }
  }
}

// A baseline in the repository holds all that is compared.
TEST(Gate, ABriefExportIsAsGoodAsTheDatabase) {
  const auto brief = rows_from_json(rows_to_json(campaign(10), {.brief = true, .stable = false}));
  const auto itself = compare_campaigns(brief, campaign(10));
  EXPECT_TRUE(itself.findings.empty()) << listing(itself);
  EXPECT_TRUE(itself.differences.empty());
  EXPECT_EQ(itself.verified, 10U);
  for (const Limit& limit : limits()) {
    auto fresh = campaign(10);
    change(fresh[2], [&](Json& mesh, Json& stats, Json& verdict) {
      limit.set(mesh, stats, verdict, limit.beyond);
    });
    const auto report = compare_campaigns(brief, fresh);
    EXPECT_EQ(report.findings.size(), 1U) << limit.name << "\n" << listing(report);
  }
}

TEST(Gate, WhatIsMissingIsFoundUnlessAllowed) {
  auto fresh = campaign(5);
  fresh.pop_back();
  EXPECT_EQ(compare_campaigns(campaign(5), fresh).findings.at(0).kind, FindingKind::missing);
  const auto allowed =
      compare_campaigns(campaign(5), fresh, with(&GateOptions::missing_is_bad, false));
  EXPECT_TRUE(allowed.findings.empty());
  EXPECT_EQ(allowed.notes.size(), 1U);
  EXPECT_EQ(compare_campaigns(fresh, campaign(5)).findings.size(), 0U);
}

}  // namespace
}  // namespace tetproof::gate_test
