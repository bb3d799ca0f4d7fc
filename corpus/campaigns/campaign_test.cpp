// Campaigns with made-up meshers, some of them nasty.
#include "corpus/campaigns/campaign.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <map>
#include <thread>

namespace tetproof {
namespace {

namespace fs = std::filesystem;

const std::string kCorner = "4 vertices\\n1 tets\\n0 0 0\\n1 0 0\\n0 1 0\\n0 0 1\\n4 0 1 2 3\\n";
// One tetrahedron against two.
const std::string kInverted =
    "5 vertices\\n3 tets\\n0 0 0\\n1 0 0\\n0 1 0\\n0 0 1\\n0 0 -1\\n4 0 1 2 3\\n4 0 2 1 4\\n"
    "4 1 0 2 3\\n";

class CampaignTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("campaign_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "models");
    for (int i = 0; i < 3; ++i) {
      const std::string name = {'m', static_cast<char>('0' + i)};
      std::ofstream(folder_ / "models" / (name + ".off")) << "OFF " << i;
    }
    options_.supervisor = TETPROOF_SUPERVISE_PATH;
    options_.self = TETPROOF_PATH;
    options_.database = folder_ / "run.sqlite";
    options_.verify = false;  // the models are not even surfaces
    options_.limits = {.wall_seconds = 10, .cpu_seconds = 10, .memory_bytes = 300u << 20};
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Makes a model the surface of the corner.
  void make_surface(int index) const {
    std::ofstream(folder_ / "models" / ("m" + std::to_string(index) + ".off"))
        << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  }

  // A `tetproof` that notes what it is asked and, asked to verify, runs a line of shell first.
  fs::path self_that(const std::string& line) const {
    fs::path script = folder_ / "self.sh";
    std::ofstream(script) << "#!/bin/sh\necho \"$@\" >> " << calls().string()
                          << "\n[ \"$1\" = verify ] && { " << line << "; }\nexec " << TETPROOF_PATH
                          << " \"$@\"\n";
    fs::permissions(script, fs::perms::owner_all);
    return script;
  }

  std::vector<Model> models() const { return collect_models({folder_ / "models"}).models; }

  // A mesher that notes each call in a file and runs a line of shell.
  Mesher shell(const std::string& name, const std::string& line) const {
    return make_mesher(name + "=cmd:echo " + name + " {in} >> " + calls().string() + "; " + line +
                           " # {in} {out.tet}",
                       {options_.supervisor, "", ""});
  }

  fs::path calls() const { return folder_ / "calls"; }

  int call_count() const {
    std::ifstream in(calls());
    int lines = 0;
    for (std::string line; std::getline(in, line);) ++lines;
    return lines;
  }

  std::map<std::string, RunRow> rows_of_model(std::size_t index) const {
    std::map<std::string, RunRow> found;
    const std::string hash = models()[index].sha256;
    for (auto& row : ResultsDatabase(options_.database, ResultsDatabase::Mode::read).rows()) {
      if (row.key.model_sha256 == hash) found[row.key.mesher] = row;
    }
    return found;
  }

  std::size_t row_count() const {
    return ResultsDatabase(options_.database, ResultsDatabase::Mode::read).rows().size();
  }

  fs::path folder_;
  CampaignOptions options_;
};

// The corner with a vertex in its middle, the only unknown.
TEST_F(CampaignTest, ASolverIsAskedIfOneWants) {
  const std::string star =
      "5 vertices\\n4 tets\\n0 0 0\\n1 0 0\\n0 1 0\\n0 0 1\\n.25 .25 .25\\n"
      "4 0 1 2 4\\n4 0 2 3 4\\n4 0 3 1 4\\n4 1 3 2 4\\n";
  const std::string line = "printf '" + star + "' > mesh.tet";
  run_campaign({models()[0]}, {shell("plain", line)}, options_);
  options_.solver = true;
  run_campaign({models()[0]}, {shell("solved", line)}, options_);
  auto rows = rows_of_model(0);
  EXPECT_FALSE(solver_columns(rows["plain"].mesh_json).has_value());
  const auto solver = solver_columns(rows["solved"].mesh_json);
  ASSERT_TRUE(solver.has_value()) << rows["solved"].mesh_json << rows["solved"].reason;
  EXPECT_EQ(solver->unknowns, 1u);
  EXPECT_EQ(solver->iterations, 1u);
  EXPECT_EQ(rows["solved"].mesh->tetrahedra, 4u);
}

TEST_F(CampaignTest, DispositionsAreToldApart) {
  make_surface(0);
  options_.verify = true;
  options_.limits.wall_seconds = options_.limits.cpu_seconds = 120;
  options_.jobs = 2;
  const std::string nasty = TETPROOF_NASTY_PATH;
  const std::vector<Mesher> meshers = {shell("good", "printf '" + kCorner + "' > mesh.tet"),
                                       shell("inverted", "printf '" + kInverted + "' > mesh.tet"),
                                       shell("garbage", "echo garbage > mesh.tet"),
                                       shell("nothing", "true"),
                                       shell("refuses", "echo 'bad facet 7' >&2; exit 3"),
                                       shell("aborts", nasty + " raise 6"),
                                       shell("eats", nasty + " allocate 3000"),
                                       shell("suicide", "kill -9 $$")};
  const auto summary = run_campaign({models()[0]}, meshers, options_);
  EXPECT_FALSE(summary.interrupted);
  // Only this one is to reach the limit, however busy the machine is.
  options_.limits.wall_seconds = 1;
  run_campaign({models()[0]}, {shell("sleeps", "sleep 300")}, options_);
  auto rows = rows_of_model(0);
  ASSERT_EQ(rows.size(), meshers.size() + 1);

  EXPECT_EQ(rows["good"].disposition, Disposition::ok) << rows["good"].reason;
  ASSERT_TRUE(rows["good"].mesh.has_value());
  EXPECT_EQ(rows["good"].mesh->tetrahedra, 1u);
  EXPECT_NEAR(rows["good"].mesh->min_face_angle, 45, 1e-9);
  EXPECT_EQ(rows["good"].exit_code, 0);
  EXPECT_EQ(rows["inverted"].disposition, Disposition::wrong_result);
  EXPECT_EQ(rows["inverted"].inverted, 1u);
  EXPECT_NE(rows["inverted"].verdict_json.find("\"picture\":\"<svg"), std::string::npos)
      << rows["inverted"].verdict_json;
  EXPECT_EQ(rows["good"].verdict_json.find("picture"), std::string::npos);
  EXPECT_EQ(rows["garbage"].disposition, Disposition::wrong_result);
  EXPECT_EQ(rows["nothing"].disposition, Disposition::wrong_result);
  EXPECT_EQ(rows["nothing"].reason, "no mesh was written");
  EXPECT_EQ(rows["refuses"].disposition, Disposition::rejected);
  EXPECT_EQ(rows["refuses"].reason, "exit 3: bad facet 7");
  EXPECT_EQ(rows["refuses"].exit_code, 3);
  EXPECT_EQ(rows["refuses"].stderr_tail, "bad facet 7\n");
  EXPECT_EQ(rows["sleeps"].disposition, Disposition::timeout);
  EXPECT_EQ(rows["eats"].disposition, Disposition::out_of_memory);
  EXPECT_GT(rows["eats"].peak_rss_bytes, 200u << 20);
  EXPECT_EQ(rows["suicide"].disposition, Disposition::killed);
  EXPECT_EQ(rows["suicide"].signal, SIGKILL);
  // The shell turns its child's signal into an exit code; see the direct test below.
  EXPECT_NE(rows["aborts"].disposition, Disposition::ok);
  EXPECT_FALSE(fs::exists(options_.database.string() + ".scratch"));
}

TEST_F(CampaignTest, ASignalOfTheMesherIsACrash) {
  Mesher mesher = shell("direct", "");
  mesher.command = [](const RunFiles&) {
    return std::vector<std::string>{TETPROOF_NASTY_PATH, "raise", "11"};
  };
  run_campaign({models()[0]}, {mesher}, options_);
  EXPECT_EQ(rows_of_model(0)["direct"].disposition, Disposition::crash);
  EXPECT_EQ(rows_of_model(0)["direct"].reason, "SIGSEGV");
}

TEST_F(CampaignTest, WhatIsThereIsNotRunAgain) {
  const std::vector<Mesher> meshers = {shell("a", "printf '" + kCorner + "' > mesh.tet"),
                                       shell("b", "exit 4")};
  EXPECT_EQ(run_campaign(models(), meshers, options_).present, 0u);
  EXPECT_EQ(call_count(), 6);
  EXPECT_EQ(run_campaign(models(), meshers, options_).present, 6u);
  EXPECT_EQ(call_count(), 6);
  std::ofstream(folder_ / "models" / "m1.off") << "OFF changed";  // one model is another now
  EXPECT_EQ(run_campaign(models(), meshers, options_).present, 4u);
  EXPECT_EQ(call_count(), 8);
  options_.limits.wall_seconds = 11;  // other limits, other runs
  EXPECT_EQ(run_campaign(models(), meshers, options_).present, 0u);
  EXPECT_EQ(row_count(), 14u);
}

TEST_F(CampaignTest, StatisticsOfTheMesherAreStored) {
  run_campaign({models()[0]},
               {shell("s", "printf '" + kCorner +
                               "' > mesh.tet; echo '{\"phases_seconds\": {\"read\": 5, \"refine\": "
                               "2, \"enrich\": 1}, \"refined\": {\"tetrahedra\": 3, "
                               "\"min_face_angle\": 14.5}}' > stats.json")},
               options_);
  const RunRow row = rows_of_model(0)["s"];
  EXPECT_EQ(row.disposition, Disposition::unverified) << row.reason;
  EXPECT_EQ(row.mesh_seconds, 3);
  EXPECT_EQ(row.refined->min_face_angle, 14.5);
}

TEST_F(CampaignTest, MeshesAreKeptOnRequest) {
  options_.keep = folder_ / "kept";
  const auto mesher = shell("k", "printf '" + kCorner + "' > mesh.tet");
  run_campaign({models()[0]}, {mesher}, options_);
  const fs::path kept = rows_of_model(0)["k"].mesh_path;
  EXPECT_EQ(kept, folder_ / "kept" / "k" / ("m0.off-" + models()[0].sha256.substr(0, 8) + ".tet"));
  EXPECT_TRUE(fs::exists(kept));
  options_.keep_tetrahedra = 1;
  run_campaign({models()[1]}, {mesher}, options_);
  EXPECT_NE(rows_of_model(1)["k"].mesh_path, "");
  run_campaign({models()[2]}, {shell("k", "printf '" + kInverted + "' > mesh.tet")}, options_);
  EXPECT_EQ(rows_of_model(2)["k"].mesh_path, "");  // three tetrahedra
}

TEST_F(CampaignTest, RowsAreRunAgainOnRequest) {
  const std::vector<Mesher> meshers = {shell("a", "printf '" + kCorner + "' > mesh.tet"),
                                       shell("b", "kill -9 $$"), shell("c", "exit 4")};
  run_campaign({models()[0]}, meshers, options_);
  EXPECT_EQ(call_count(), 3);
  options_.retry = {Disposition::killed};
  EXPECT_EQ(run_campaign({models()[0]}, meshers, options_).present, 2U);
  EXPECT_EQ(call_count(), 4);
  EXPECT_EQ(row_count(), 3U);
}

// The mesh of the corner against a real surface: a verdict is in each row.
TEST_F(CampaignTest, TheOraclesAreAskedUnlessToldNotTo) {
  EXPECT_TRUE(CampaignOptions().verify);
  make_surface(0);
  std::ofstream(folder_ / "models" / "m1.off")
      << "OFF\n4 4 0\n0 0 0\n2 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  options_.verify = true;
  run_campaign({models()[0], models()[1]}, {shell("v", "printf '" + kCorner + "' > mesh.tet")},
               options_);
  const RunRow right = rows_of_model(0)["v"], wrong = rows_of_model(1)["v"];
  EXPECT_EQ(right.disposition, Disposition::ok) << right.reason;
  EXPECT_EQ(verdict_of(right), "exact");
  EXPECT_EQ(wrong.disposition, Disposition::wrong_result);
  EXPECT_EQ(verdict_of(wrong), "broken");
  EXPECT_EQ(wrong.reason.find("scratch"), std::string::npos) << wrong.reason;
}

// If the oracles come to no verdict, for whatever reason, the mesh is neither ok nor wrong.
TEST_F(CampaignTest, AMeshThatNoOracleHasFinishedWithIsUnverified) {
  make_surface(0);
  const auto mesher = shell("v", "printf '" + kCorner + "' > mesh.tet");
  const auto reason_with = [&](const std::string& line) {
    options_.self = self_that(line);
    options_.retry = {Disposition::unverified};
    const auto summary = run_campaign({models()[0]}, {mesher}, options_);
    const auto& counts = summary.meshers.at(0).counts;
    EXPECT_EQ(counts[static_cast<std::size_t>(Disposition::unverified)], 1U) << line;
    const RunRow row = rows_of_model(0)["v"];
    EXPECT_EQ(row.disposition, Disposition::unverified) << line;
    EXPECT_EQ(row.verify_seconds.has_value(), options_.verify) << line;
    return row.reason;
  };
  const std::string unfinished = "the oracles have not finished: ";
  EXPECT_EQ(reason_with("true"), "no oracle was asked");
  options_.verify = true;
  EXPECT_EQ(reason_with("exit 0"), unfinished + "no report");
  EXPECT_EQ(reason_with("echo too many >&2; exit 3"), unfinished + "too many");
  EXPECT_EQ(reason_with("echo x: not enough memory >&2; exit 6"),
            unfinished + "internal error: x: not enough memory");
  EXPECT_EQ(reason_with("kill -9 $$"), unfinished + "SIGKILL from outside");
  EXPECT_EQ(reason_with("kill -11 $$"), unfinished + "SIGSEGV");
  options_.verify_limits = {.wall_seconds = 0.5, .cpu_seconds = 900, .memory_bytes = 0};
  EXPECT_EQ(reason_with("sleep 100"), unfinished + "wall limit of 0.5 s");
  options_.verify_limits = {.wall_seconds = 900, .cpu_seconds = 0.25, .memory_bytes = 0};
  EXPECT_EQ(reason_with("while :; do :; done"), unfinished + "processor limit of 0.25 s");
  options_.verify_limits = {.wall_seconds = 900, .cpu_seconds = 900, .memory_bytes = 200u << 20};
  EXPECT_EQ(reason_with("exec " TETPROOF_NASTY_PATH " allocate 1000"),
            unfinished + "memory limit of 200 MiB");
  // Asked again without hindrance.
  options_.self = TETPROOF_PATH;
  options_.verify_limits = CampaignOptions().verify_limits;
  run_campaign({models()[0]}, {mesher}, options_);
  EXPECT_EQ(rows_of_model(0)["v"].disposition, Disposition::ok);
}

// The oracles are asked once, with the sidecar of a second run where there is one, and that run has
// to write the same bytes. `self` is a script here that notes what it is asked.
TEST_F(CampaignTest, VerdictsAndSidecars) {
  make_surface(0);
  options_.self = self_that("true");
  options_.verify = options_.sidecars = true;
  const auto with_sidecar = [](Mesher mesher, const std::string& line) {
    mesher.promised = "mesh";  // what the oracles hold the record to
    mesher.sidecar_command = [line](const RunFiles& files) {
      return std::vector<std::string>{"/bin/sh", "-c", line, files.again.string(),
                                      files.exact.string()};
    };
    return mesher;
  };
  const std::string print = "printf '" + kCorner + "' > ";
  const std::vector<Mesher> meshers = {
      shell("plain", print + "mesh.tet"),
      with_sidecar(shell("none", print + "mesh.tet"), print + "$0"),
      with_sidecar(shell("other", print + "mesh.tet"), "echo > $0; echo nonsense > $1"),
      with_sidecar(shell("ended", print + "mesh.tet"), "kill -9 $$")};
  run_campaign({models()[0]}, meshers, options_);
  std::ifstream in(calls());
  int verified = 0, exact = 0;
  for (std::string line; std::getline(in, line);) {
    verified += line.starts_with("verify ");
    exact += line.find(" --exact ") != std::string::npos;
  }
  EXPECT_EQ(verified, 4);
  EXPECT_EQ(exact, 1);
  auto rows = rows_of_model(0);
  EXPECT_EQ(rows["plain"].disposition, Disposition::ok) << rows["plain"].reason;
  EXPECT_NE(rows["plain"].verdict_json.find("\"exact\""), std::string::npos);
  EXPECT_EQ(rows["none"].disposition, Disposition::wrong_result);
  EXPECT_TRUE(rows["none"].reason.starts_with("no sidecar")) << rows["none"].reason;
  EXPECT_EQ(rows["other"].disposition, Disposition::wrong_result);
  EXPECT_EQ(rows["other"].reason, "a second run wrote another mesh");
  // A limit met by the second run says nothing about the mesh of the first.
  EXPECT_EQ(rows["ended"].disposition, Disposition::ok) << rows["ended"].reason;
  EXPECT_NE(rows["ended"].verdict_json.find("no_sidecar"), std::string::npos);
  EXPECT_EQ(rows["plain"].verdict_json.find("no_sidecar"), std::string::npos);
}

// If the file alone does not conform, our meshers are asked for their record without --exact; no
// other mesher has one.
TEST_F(CampaignTest, ARecordIsTakenWhereTheFileAloneDoesNotTell) {
  make_surface(0);
  options_.verify = true;
  const auto foreign = shell("foreign", "printf '" + kCorner + "' > mesh.tet");
  Mesher ours = foreign;
  ours.name = "ours";
  ours.sidecar_command = [](const RunFiles& files) {
    return std::vector<std::string>{"/bin/sh",
                                    "-c",
                                    "cp \"$2\" \"$0\"; echo record > \"$1\"",
                                    files.again.string(),
                                    files.exact.string(),
                                    files.mesh.string()};
  };
  const std::string with_record =
      "case \"$*\" in *--exact*) echo '{\"verdict\": \"rounded\"}'; exit 0;; esac; ";
  const auto dispositions = [&](const std::string& alone, int code) {
    options_.self =
        self_that(with_record + "echo '" + alone + "'; echo why >&2; exit " + std::to_string(code));
    fs::remove(options_.database);
    run_campaign({models()[0]}, {foreign, ours}, options_);
    auto rows = rows_of_model(0);
    return std::pair(rows["foreign"], rows["ours"]);
  };
  const auto [wrong, right] = dispositions(
      R"({"verdict": "broken", "oracles": [{"name": "conformity", "passed": false}]})", 1);
  EXPECT_EQ(wrong.disposition, Disposition::wrong_result);
  EXPECT_EQ(right.disposition, Disposition::ok) << right.reason;
  EXPECT_EQ(verdict_of(right), "rounded");
  const auto [undecided, decided] = dispositions(R"({"verdict": "undecided"})", 5);
  EXPECT_EQ(undecided.disposition, Disposition::unverified);
  EXPECT_EQ(undecided.reason, "the oracles have not finished: own limit: why");
  EXPECT_EQ(decided.disposition, Disposition::ok);
  // A record says nothing about other failures.
  const auto [bad, worse] = dispositions(
      R"({"verdict": "broken", "oracles": [{"name": "conformity", "passed": true}]})", 1);
  EXPECT_EQ(bad.disposition, Disposition::wrong_result);
  EXPECT_EQ(worse.disposition, Disposition::wrong_result);
}

// A program that does not exist says nothing about any model: no row, and an error at the start.
TEST_F(CampaignTest, WhatCannotBeRunEndsTheCampaign) {
  const auto error_of = [&](const std::vector<std::string>& lines) -> std::string {
    std::vector<Mesher> meshers;
    for (const std::string& line : lines) {
      meshers.push_back(
          make_mesher("m" + std::to_string(meshers.size()) + "=cmd:" + line + " # {in} {out.tet}",
                      {options_.supervisor, "", ""}));
    }
    try {
      run_campaign(models(), meshers, options_);
    } catch (const CannotRun& error) {
      return error.what();
    }
    return "";
  };
  const fs::path plain = folder_ / "plain", script = folder_ / "script";
  std::ofstream(plain) << "no program";
  std::ofstream(script) << "#!" << (folder_ / "no-shell").string() << "\n";
  fs::permissions(script, fs::perms::owner_all);
  EXPECT_EQ(error_of({"exit 4", "no-such-mesher"}), "m1: no-such-mesher: not found");
  EXPECT_EQ(error_of({"/no/such/mesher"}), "m0: /no/such/mesher: not found");
  EXPECT_EQ(error_of({plain.string()}), "m0: " + plain.string() + ": is not executable");
  EXPECT_EQ(error_of({folder_.string()}), "m0: " + folder_.string() + ": is not a file");
  EXPECT_EQ(error_of({script.string()}), "m0: " + script.string() + ": its interpreter " +
                                             (folder_ / "no-shell").string() + " cannot be run");
  EXPECT_TRUE(error_of({"./plain"}).find("an absolute path is expected") != std::string::npos);
  EXPECT_EQ(row_count(), 0U);
  // A line that only the shell understands fails at the first model.
  EXPECT_EQ(error_of({"sh -c no-such-mesher"}).find("m0: exit 127: "), 0U);
  EXPECT_EQ(error_of({"cd / && " + plain.string()}).find("m0: exit 126: "), 0U);
  EXPECT_EQ(row_count(), 0U);
  // And one of ours that does not know its options.
  Mesher ours = shell("ours", "echo '--no: unknown' >&2; exit 2");
  ours.exit_codes = ExitCodes::ours;
  EXPECT_THROW(run_campaign(models(), {ours}, options_), CannotRun);
  EXPECT_EQ(row_count(), 0U);
  // If it ran on a model before, the failure is that of the next model, and so it is when resumed.
  const std::string second = "case {in} in *m1.off) exit 127;; *) exit 4;; esac";
  EXPECT_EQ(error_of({second}), "");
  EXPECT_EQ(row_count(), 3U);
  EXPECT_EQ(rows_of_model(1)["m0"].reason, "exit 127");
  EXPECT_EQ(error_of({second}), "");
  // Without a supervisor nothing runs.
  options_.supervisor = folder_ / "none";
  std::ofstream(options_.supervisor) << "no program";
  const std::string said = error_of({"exit 5"});
  EXPECT_NE(said.find((folder_ / "none").string()), std::string::npos) << said;
  EXPECT_FALSE(fs::exists(options_.database.string() + ".scratch"));
}

// A file that goes or changes says nothing about the mesher that was to read it.
TEST_F(CampaignTest, AModelThatGoesOrChangesHasNoRow) {
  const std::vector<Model> found = models();
  fs::remove(found[0].path);
  std::ofstream(found[1].path) << "OFF changed";
  EXPECT_EQ(run_campaign(found, {shell("m", "exit 3")}, options_).models_changed,
            (std::set<std::string>{"m0.off", "m1.off"}));
  EXPECT_EQ(row_count(), 1U);
  EXPECT_EQ(call_count(), 1);
  // While it runs.
  const std::vector<Model> now = models();
  ASSERT_EQ(now.size(), 2U);
  const std::string gone = "rm '" + now[0].path.string() + "'; exit 3";
  const std::string other =
      "printf '" + kCorner + "' > mesh.tet; echo more >> '" + now[1].path.string() + "'";
  EXPECT_EQ(run_campaign({now[0]}, {shell("gone", gone)}, options_).models_changed,
            (std::set<std::string>{"m1.off"}));
  EXPECT_EQ(run_campaign({now[1]}, {shell("other", other)}, options_).models_changed,
            (std::set<std::string>{"m2.off"}));
  EXPECT_EQ(row_count(), 1U);
}

// The oracles hold a mesh to the digits of what was declared.
TEST_F(CampaignTest, SmallSharesArriveAsTheyAre) {
  options_.verify = true;
  options_.self = self_that("true");
  Mesher mesher = shell("m", "printf '" + kCorner + "' > mesh.tet");
  mesher.envelope = 6.25e-8;
  run_campaign({models()[0]}, {mesher}, options_);
  mesher.envelope = 0;
  mesher.declared_deviation = 1.2345678901e-7;
  run_campaign({models()[1]}, {mesher}, options_);
  std::ifstream in(calls());
  const std::string said(std::istreambuf_iterator<char>(in), {});
  EXPECT_NE(said.find("--envelope 6.25e-08 "), std::string::npos) << said;
  EXPECT_NE(said.find("--declared-deviation 1.2345678901e-07 "), std::string::npos) << said;
}

// Whatever a mesher leaves there: a link to itself, a pipe that nobody writes to.
TEST_F(CampaignTest, WhatIsNoFileIsNoMesh) {
  run_campaign({models()[0]},
               {shell("link", "ln -s mesh.tet mesh.tet"), shell("pipe", "mkfifo mesh.tet"),
                shell("folder", "mkdir mesh.tet")},
               options_);
  auto rows = rows_of_model(0);
  for (const char* name : {"link", "pipe", "folder"}) {
    EXPECT_EQ(rows[name].disposition, Disposition::wrong_result) << name;
    EXPECT_EQ(rows[name].reason, "no mesh was written") << name;
  }
}

TEST_F(CampaignTest, NothingStaysBesideTheDatabase) {
  run_campaign({models()[0]}, {shell("a", "exit 4")}, options_);
  for (const char* suffix : {"-wal", "-shm", "-journal", ".lock", ".scratch"}) {
    EXPECT_FALSE(fs::exists(options_.database.string() + suffix)) << suffix;
  }
}

TEST_F(CampaignTest, NoFurtherModelIsBegunOnceTimeIsUp) {
  options_.stop_after_seconds = 0.2;
  const std::vector<Mesher> meshers = {shell("a", "sleep 0.3"), shell("b", "exit 4")};
  EXPECT_EQ(run_campaign(models(), meshers, options_).models_left_out, 2u);
  EXPECT_EQ(row_count(), 2u);  // the model begun has all its runs
  options_.stop_after_seconds = 0;
  EXPECT_EQ(run_campaign(models(), meshers, options_).models_left_out, 0u);
  EXPECT_EQ(row_count(), 6u);
}

class InterruptedCampaign : public CampaignTest {
 protected:
  // Starts a campaign in another process: two quick runs per model and one that never ends.
  pid_t start() {
    const pid_t runner = fork();
    if (runner == 0) {
      signal(SIGINT, [](int) { interrupt_campaign(); });
      options_.limits.wall_seconds = options_.limits.cpu_seconds = 100;
      const auto summary = run_campaign(models(), meshers("sleep 100"), options_);
      _exit(summary.interrupted ? 130 : 0);
    }
    for (int i = 0; i < 2000 && call_count() < 3; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_EQ(call_count(), 3);
    return runner;
  }

  std::vector<Mesher> meshers(const std::string& third) const {
    return {shell("a", "printf '" + kCorner + "' > mesh.tet"), shell("b", "exit 4"),
            shell("c", third)};
  }
};

TEST_F(InterruptedCampaign, StopsCleanlyAndKeepsWhatWasDone) {
  const pid_t runner = start();
  kill(runner, SIGINT);
  int status = 0;
  waitpid(runner, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_EQ(row_count(), 2u);
  for (const char* suffix : {"-wal", "-shm", "-journal", ".lock", ".scratch"}) {
    EXPECT_FALSE(fs::exists(options_.database.string() + suffix)) << suffix;
  }
}

TEST_F(InterruptedCampaign, ResumesAfterKill9) {
  const pid_t runner = start();
  kill(runner, SIGKILL);
  waitpid(runner, nullptr, 0);
  EXPECT_EQ(row_count(), 2u);
  options_.limits.wall_seconds = options_.limits.cpu_seconds = 100;
  const auto summary = run_campaign(models(), meshers("exit 5"), options_);
  EXPECT_EQ(summary.present, 2u);
  EXPECT_EQ(row_count(), 9u);
  EXPECT_EQ(call_count(), 3 + 7);  // only the run that was cut off is repeated
  EXPECT_FALSE(fs::exists(options_.database.string() + ".scratch"));
}

// Fields that should be numbers are.
TEST_F(CampaignTest, TheCommandLineTakesNoLimitThatIsNone) {
  const auto code = [&](const std::string& words) {
    const std::string line = std::string("'") + TETPROOF_PATH + "' " + words + " > '" +
                             (folder_ / "said").string() + "' 2>&1";
    return WEXITSTATUS(std::system(line.c_str()));
  };
  const std::string run = "run '" + (folder_ / "models").string() + "' --no-verify --db '" +
                          options_.database.string() + "' ";
  const std::string mesher = "-m 'a=cmd:exit 4 # {in} {out.tet}' ";
  for (const char* wrong :
       {"--timeout nan", "--timeout -5", "--timeout inf", "--timeout 0", "--cpu nan", "--cpu -3",
        "--memory -1", "--memory 0", "--memory 17592186044416", "--memory x", "--stop-after nan",
        "--shard 1/4294967297", "--shard 0/3", "--shard 4/3", "--shard 1/3x", "--shard 1", "-j -1",
        "-m 'a=cmd:exit 5 # {in} {out.tet}'"}) {
    EXPECT_EQ(code(run + mesher + wrong), 2) << wrong;
    EXPECT_FALSE(fs::exists(options_.database)) << wrong;
  }
  EXPECT_EQ(code(run + mesher + "--timeout 5.5 --cpu 2 --memory 100 --stop-after 60 --shard 1/1"),
            0);
  const std::string gate = "gate --base '" + options_.database.string() + "' --new '" +
                           options_.database.string() + "' ";
  EXPECT_EQ(code(gate), 0);
  for (const char* wrong : {"--time-factor nan", "--time-factor 0.5", "--least-seconds nan"}) {
    EXPECT_EQ(code(gate + wrong), 2) << wrong;
  }
}

TEST(MeshSeconds, WithoutReadingCheckingAndWriting) {
  EXPECT_EQ(mesh_seconds(""), std::nullopt);
  EXPECT_EQ(mesh_seconds("{}"), std::nullopt);
  EXPECT_EQ(mesh_seconds(R"({"phases_seconds": {"read": 9, "check": 9, "write": 9, "mesh": 2}})"),
            2);
}

}  // namespace
}  // namespace tetproof
