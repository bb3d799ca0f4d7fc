#include "reports/results.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <memory>

namespace tetproof::results_test {
namespace {

namespace fs = std::filesystem;
using Mode = ResultsDatabase::Mode;

class Results : public testing::Test {
 protected:
  void SetUp() override {
    path_ = fs::path(testing::TempDir()) / ("results_test_" + std::to_string(getpid()) + ".sqlite");
    remove();
  }
  void TearDown() override { remove(); }
  void remove() const {
    for (const char* suffix : {"", "-wal", "-shm", ".lock"}) fs::remove(path_.string() + suffix);
  }
  fs::path path_;
};

RunRow sample(const std::string& model = "aa", const std::string& mesher = "tetgen") {
  RunRow row;
  row.key = {model, mesher, "1.0", "zpcq", "wall 60 s"};
  row.model_name = "a.off";
  row.disposition = Disposition::wrong_result;
  row.reason = "3 inverted";
  row.verify_seconds = 0.75;
  row.exit_code = 0;
  row.wall_seconds = 0.1;
  row.peak_rss_bytes = 1234567890123;
  row.inverted = 3;
  row.region = "hull";
  row.promise = "within 1e-08";
  row.mesh_json = R"({"tetrahedra": 10, "vertices": 7, "min_face_angle": 0.25,
                      "inside": {"tetrahedra": 4}})";
  row.stats_json = R"({"refined": {"tetrahedra": 9, "min_face_angle": 14.5}})";
  row.stderr_tail = "it's \"quoted\"\n";
  row.started = "2026-01-01T00:00:00Z";
  return row;
}

TEST_F(Results, RoundTrip) {
  ResultsDatabase database(path_, Mode::write);
  EXPECT_FALSE(database.has(sample().key));
  database.store(sample());
  EXPECT_TRUE(database.has(sample().key));
  const auto rows = database.rows();
  ASSERT_EQ(rows.size(), 1u);
  const RunRow& r = rows[0];
  EXPECT_EQ(r.key, sample().key);
  EXPECT_EQ(r.disposition, Disposition::wrong_result);
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_EQ(r.signal, std::nullopt);
  EXPECT_EQ(r.mesh_seconds, std::nullopt);
  EXPECT_EQ(r.wall_seconds, 0.1);
  EXPECT_EQ(r.verify_seconds, 0.75);
  EXPECT_EQ(r.peak_rss_bytes, 1234567890123u);
  EXPECT_EQ(r.inverted, 3u);
  EXPECT_EQ(r.flat, std::nullopt);
  ASSERT_TRUE(r.mesh.has_value());
  EXPECT_EQ(r.mesh->tetrahedra, 10u);
  EXPECT_EQ(r.mesh->min_face_angle, 0.25);
  EXPECT_EQ(r.inside->tetrahedra, 4u);
  EXPECT_EQ(r.refined->min_face_angle, 14.5);
  EXPECT_EQ(r.stderr_tail, sample().stderr_tail);
  EXPECT_EQ(r.started, sample().started);
}

// Programs speak in the encoding of the place; a database is read by others.
TEST_F(Results, TextsAreUtf8) {
  RunRow row = sample();
  row.key.flags = "-n Geh\xe4use";
  row.reason = "ung\xfcltig";
  row.stderr_tail = "g\xc3\xbcltig";
  ResultsDatabase database(path_, Mode::write);
  database.store(row);
  database.store(row);
  const auto rows = database.rows();
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].reason, "ung\xef\xbf\xbdltig");
  EXPECT_EQ(rows[0].stderr_tail, row.stderr_tail);
  EXPECT_TRUE(database.find(row.key).has_value());
}

TEST_F(Results, ErrorsNameTheFile) {
  { ResultsDatabase(path_, Mode::write).store(sample()); }
  SQLite::Database(path_.string(), SQLite::OPEN_READWRITE)
      .exec("UPDATE runs SET disposition = 'great'");
  try {
    ResultsDatabase(path_, Mode::read).rows();
    ADD_FAILURE() << "a disposition that does not exist is read";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), path_.string() + ": unknown disposition: great");
  }
}

TEST_F(Results, EveryPartOfTheKeyCounts) {
  ResultsDatabase database(path_, Mode::write);
  database.store(sample());
  for (int part = 0; part < 5; ++part) {
    RunKey key = sample().key;
    std::string* const parts[] = {&key.model_sha256, &key.mesher, &key.version, &key.flags,
                                  &key.limits};
    *parts[part] += "x";
    EXPECT_FALSE(database.has(key)) << part;
    RunRow row = sample();
    row.key = key;
    database.store(row);
  }
  EXPECT_EQ(database.rows().size(), 6u);
  RunRow again = sample();
  again.disposition = Disposition::ok;
  database.store(again);
  EXPECT_EQ(database.rows().size(), 6u);
}

TEST_F(Results, OneWriterAndAnyReaders) {
  ResultsDatabase writer(path_, Mode::write);
  writer.store(sample());
  EXPECT_EQ(ResultsDatabase(path_, Mode::read).rows().size(), 1u);
  try {
    ResultsDatabase second(path_, Mode::write);
    FAIL() << "a second writer got in";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("another run"), std::string::npos) << error.what();
  }
}

// In whatever order users open and close the file.
TEST_F(Results, NothingStaysBesideTheFile) {
  const auto expect_alone = [&](const char* when) {
    for (const char* suffix : {"-wal", "-shm", "-journal", ".lock"}) {
      EXPECT_FALSE(fs::exists(path_.string() + suffix)) << suffix << " " << when;
    }
  };
  ResultsDatabase(path_, Mode::write).store(sample());
  expect_alone("after writing");
  EXPECT_EQ(ResultsDatabase(path_, Mode::read).rows().size(), 1U);
  expect_alone("after reading");
  {
    auto writer = std::make_unique<ResultsDatabase>(path_, Mode::write);
    ResultsDatabase reader(path_, Mode::read);
    EXPECT_EQ(reader.rows().size(), 1U);
    EXPECT_THROW(ResultsDatabase(path_, Mode::write), std::runtime_error);
    writer.reset();
    EXPECT_EQ(reader.rows().size(), 1U);
    EXPECT_FALSE(fs::exists(path_.string() + ".lock"));
  }
  expect_alone("after a reader that outlived the writer");
  EXPECT_EQ(ResultsDatabase(path_, Mode::read).rows().size(), 1U);
  expect_alone("after reading again");
  const pid_t child = fork();
  if (child == 0) {
    ResultsDatabase database(path_, Mode::write);
    database.store(sample("bb"));
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  EXPECT_EQ(ResultsDatabase(path_, Mode::write).rows().size(), 2U);
  expect_alone("after a writer that was killed, and another");
}

// Files that nobody may write, in a folder where nobody may.
TEST_F(Results, ReadOnlyFilesAreRead) {
  const fs::path folder = path_.string() + ".folder", file = folder / "a.sqlite";
  fs::create_directories(folder);
  ResultsDatabase(file, Mode::write).store(sample());
  fs::permissions(file, fs::perms::owner_read);
  fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(ResultsDatabase(file, Mode::read).rows().size(), 1U);
  fs::permissions(folder, fs::perms::owner_all);
  fs::remove_all(folder);
}

// Many processes take turns at the lock, and each removes it. Two never hold it at once, or the sum
// of their steps, made one after the other, would be wrong.
TEST_F(Results, TheLockStaysOneThoughItIsRemoved) {
  ResultsDatabase(path_, Mode::write).store(sample());
  const fs::path counter = path_.string() + ".counter";
  std::ofstream(counter) << 0;
  constexpr int kProcesses = 6, kTurns = 40;
  std::vector<pid_t> children;
  for (int i = 0; i < kProcesses; ++i) {
    const pid_t child = fork();
    if (child != 0) {
      children.push_back(child);
      continue;
    }
    for (int turn = 0; turn < kTurns;) {
      try {
        ResultsDatabase database(path_, Mode::write);
        int count = 0;
        std::ifstream(counter) >> count;
        usleep(100);
        std::ofstream(counter) << count + 1;
        ++turn;
      } catch (const std::runtime_error&) {
        usleep(50);
      }
    }
    _exit(0);
  }
  for (const pid_t child : children) waitpid(child, nullptr, 0);
  int count = 0;
  std::ifstream(counter) >> count;
  EXPECT_EQ(count, kProcesses * kTurns);
  fs::remove(counter);
  EXPECT_FALSE(fs::exists(path_.string() + ".lock"));
}

TEST_F(Results, RowsSurviveTheDeathOfTheWriter) {
  const pid_t child = fork();
  if (child == 0) {
    ResultsDatabase database(path_, Mode::write);
    for (int i = 0; i < 20; ++i) database.store(sample(std::to_string(i)));
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  ResultsDatabase database(path_, Mode::write);  // the lock died with its owner
  EXPECT_EQ(database.rows().size(), 20u);
}

TEST_F(Results, MergingIsIdempotentAndWithoutOrder) {
  RunRow early = sample(), late = sample(), killed = sample();
  early.started = "2026-01-01T00:00:00Z";
  late.started = "2026-01-02T00:00:00Z";
  killed.started = "2026-01-03T00:00:00Z";
  killed.disposition = Disposition::killed;
  RunRow unverified = sample();
  unverified.started = "2026-01-04T00:00:00Z";
  unverified.disposition = Disposition::unverified;
  std::vector<RunRow> rows = {early, late, killed, unverified};
  std::sort(rows.begin(), rows.end(),
            [](const auto& a, const auto& b) { return a.started < b.started; });
  do {
    remove();
    ResultsDatabase database(path_, Mode::write);
    for (const RunRow& row : rows) database.merge(row);
    for (const RunRow& row : rows) EXPECT_FALSE(database.merge(row));
    ASSERT_EQ(database.rows().size(), 1U);
    EXPECT_EQ(database.rows()[0].started, late.started);
    EXPECT_TRUE(database.merge(sample("bb")));
    EXPECT_EQ(database.rows().size(), 2U);
  } while (std::next_permutation(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return a.started < b.started;
  }));
}

TEST_F(Results, VerdictsAreNamed) {
  RunRow row;
  EXPECT_EQ(verdict_of(row), "");
  row.verdict_json = R"({"verdict": "rounded"})";
  EXPECT_EQ(verdict_of(row), "rounded");
  row.verdict_json = R"({"error": "too large"})";
  EXPECT_EQ(verdict_of(row), "unknown");
}

// Nothing is ok without a verdict of the oracles, whatever the row says.
TEST(Verdict, NoRowIsOkWithoutOne) {
  RunRow row;
  row.disposition = Disposition::ok;
  row.verdict_json = R"({"verdict": "deviating"})";
  demand_verdict(row);
  EXPECT_EQ(row.disposition, Disposition::ok);
  row.verdict_json = "";
  demand_verdict(row);
  EXPECT_EQ(row.disposition, Disposition::unverified);
  EXPECT_EQ(row.reason, "no oracle was asked");
  row = {};
  row.disposition = Disposition::ok;
  row.verdict_json = R"({"error": "wall limit of 60 s"})";
  demand_verdict(row);
  demand_verdict(row);
  EXPECT_EQ(row.disposition, Disposition::unverified);
  EXPECT_EQ(row.reason, "the oracles have not finished: wall limit of 60 s");
  for (std::size_t i = 1; i < kDispositionCount; ++i) {
    row = {};
    row.disposition = static_cast<Disposition>(i);
    demand_verdict(row);
    EXPECT_EQ(row.disposition, static_cast<Disposition>(i));
  }
}

// The columns that came with the fourth version and the fifth.
void drop_quality(SQLite::Database& raw) {
  raw.exec("ALTER TABLE runs DROP COLUMN promise");
  for (const char* column :
       {"share_below_5_degrees", "share_below_10_degrees", "dihedral_1_percent", "min_gamma",
        "mean_gamma", "gamma_1_percent", "min_sicn", "mean_sicn"}) {
    raw.exec(std::string("ALTER TABLE runs DROP COLUMN ") + column);
  }
}

TEST_F(Results, FilesOfTheThirdVersionGetColumnsOfQuality) {
  RunRow row = sample();
  row.mesh_json = R"({"tetrahedra": 200, "tetrahedra_below_5_degrees": 3,
      "tetrahedra_below_10_degrees": 8, "dihedral_1_percent": 7.5, "min_gamma": 0.01,
      "mean_gamma": 0.6, "gamma_1_percent": 0.2, "min_sicn": -0.5, "mean_sicn": 0.7})";
  row.mesh = mesh_columns(row.mesh_json, "");
  ResultsDatabase(path_, Mode::write).store(sample());
  {
    SQLite::Database raw(path_.string(), SQLite::OPEN_READWRITE);
    drop_quality(raw);
    raw.exec("PRAGMA user_version = 3");
  }
  const MeshColumns old = *ResultsDatabase(path_, Mode::read).rows().at(0).mesh;
  EXPECT_EQ(old.mean_gamma, std::nullopt);
  EXPECT_EQ(old.share_below_5, std::nullopt);
  EXPECT_EQ(ResultsDatabase(path_, Mode::read).rows().at(0).promise, "");
  row.key.model_sha256 = "bb";
  ResultsDatabase(path_, Mode::write).store(row);
  const auto rows = ResultsDatabase(path_, Mode::read).rows();
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].promise, "");
  EXPECT_EQ(rows[1].promise, "within 1e-08");
  EXPECT_EQ(rows[1].mesh->share_below_5, 0.015);
  EXPECT_EQ(rows[1].mesh->share_below_10, 0.04);
  EXPECT_EQ(rows[1].mesh->dihedral_percent, 7.5);
  EXPECT_EQ(rows[1].mesh->gamma_percent, 0.2);
  EXPECT_EQ(rows[1].mesh->min_sicn, -0.5);
  SQLite::Database raw(path_.string(), SQLite::OPEN_READONLY);
  const auto in_column = [&](const std::string& name) {
    return raw.execAndGet("SELECT " + name + " FROM runs WHERE model_sha256 = 'bb'").getDouble();
  };
  EXPECT_EQ(in_column("share_below_5_degrees"), 0.015);
  EXPECT_EQ(in_column("share_below_10_degrees"), 0.04);
  EXPECT_EQ(in_column("dihedral_1_percent"), 7.5);
  EXPECT_EQ(in_column("min_gamma"), 0.01);
  EXPECT_EQ(in_column("mean_gamma"), 0.6);
  EXPECT_EQ(in_column("gamma_1_percent"), 0.2);
  EXPECT_EQ(in_column("min_sicn"), -0.5);
  EXPECT_EQ(in_column("mean_sicn"), 0.7);
  EXPECT_TRUE(raw.execAndGet("SELECT mean_gamma FROM runs WHERE id = 1").isNull());
}

// Files of earlier versions called meshes ok that no oracle had looked at. Reading them changes
// nothing in the file, writing does.
TEST_F(Results, EarlierVersionsAreReadWithVerdictsDemanded) {
  {
    ResultsDatabase database(path_, Mode::write);
    for (const char* verdict : {"", R"({"error": "memory limit"})", R"({"verdict": "exact"})"}) {
      RunRow row = sample(std::string("model") + verdict);
      row.reason = "";
      row.disposition = Disposition::ok;
      row.verdict_json = verdict;
      database.store(row);
    }
  }
  {
    SQLite::Database raw(path_.string(), SQLite::OPEN_READWRITE);
    EXPECT_EQ(raw.execAndGet("SELECT count(*) FROM runs WHERE disposition = 'ok'").getInt(), 1);
    raw.exec("UPDATE runs SET disposition = 'ok', reason = ''");
    raw.exec("ALTER TABLE runs DROP COLUMN verify_seconds");
    drop_quality(raw);
    raw.exec("PRAGMA user_version = 2");
  }
  const auto expect_rows = [](const std::vector<RunRow>& rows) {
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0].disposition, Disposition::unverified);
    EXPECT_EQ(rows[0].reason, "no oracle was asked");
    EXPECT_EQ(rows[1].disposition, Disposition::unverified);
    EXPECT_EQ(rows[1].reason, "the oracles have not finished: memory limit");
    EXPECT_EQ(rows[2].disposition, Disposition::ok);
    EXPECT_EQ(rows[0].verify_seconds, std::nullopt);
  };
  expect_rows(ResultsDatabase(path_, Mode::read).rows());
  const auto count_ok = [&] {
    SQLite::Database raw(path_.string(), SQLite::OPEN_READONLY);
    return raw.execAndGet("SELECT count(*) FROM runs WHERE disposition = 'ok'").getInt();
  };
  EXPECT_EQ(count_ok(), 3);
  expect_rows(ResultsDatabase(path_, Mode::write).rows());
  EXPECT_EQ(count_ok(), 1);
  expect_rows(ResultsDatabase(path_, Mode::read).rows());
}

// As a file of the first version, which had three columns less.
TEST_F(Results, FilesOfTheFirstVersionAreReadAndUpgraded) {
  ResultsDatabase(path_, Mode::write).store(sample());
  {
    SQLite::Database raw(path_.string(), SQLite::OPEN_READWRITE);
    raw.exec("ALTER TABLE runs DROP COLUMN verdict");
    raw.exec("ALTER TABLE runs DROP COLUMN mesh_path");
    raw.exec("ALTER TABLE runs DROP COLUMN verify_seconds");
    drop_quality(raw);
    raw.exec("PRAGMA user_version = 1");
  }
  EXPECT_EQ(ResultsDatabase(path_, Mode::read).rows().at(0).stderr_tail, sample().stderr_tail);
  RunRow second = sample("bb");
  second.mesh_path = "kept.mesh";
  ResultsDatabase(path_, Mode::write).store(second);
  const auto rows = ResultsDatabase(path_, Mode::read).rows();
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].mesh_path, "");
  EXPECT_EQ(rows[1].mesh_path, "kept.mesh");
}

TEST_F(Results, OtherFilesAreRefused) {
  EXPECT_THROW(ResultsDatabase(path_, Mode::read), std::runtime_error);
  std::ofstream(path_) << std::string(5000, 'x');
  EXPECT_THROW(ResultsDatabase(path_, Mode::read), std::runtime_error);
  EXPECT_THROW(ResultsDatabase(path_, Mode::write), std::runtime_error);
}

TEST(Disposition, NamesRoundTrip) {
  for (int i = 0; i < static_cast<int>(kDispositionCount); ++i) {
    const auto d = static_cast<Disposition>(i);
    EXPECT_EQ(disposition_from_name(disposition_name(d)), d);
  }
  EXPECT_THROW(disposition_from_name("fine"), std::runtime_error);
}

TEST(MeshColumns, AbsentOrBrokenJson) {
  EXPECT_FALSE(mesh_columns("", "").has_value());
  EXPECT_FALSE(mesh_columns("{", "").has_value());
  EXPECT_FALSE(mesh_columns("[1]", "x").has_value());
  EXPECT_FALSE(mesh_columns(R"({"refined": null})", "refined").has_value());
  EXPECT_FALSE(mesh_columns(R"({"refined": {"tetrahedra": 0}})", "refined").has_value());
  EXPECT_TRUE(mesh_columns(R"({"tetrahedra": 0})", "").has_value());
  EXPECT_TRUE(mesh_columns(R"({"tetrahedra": 1, "min_face_angle": null})", "").has_value());
}

}  // namespace
}  // namespace tetproof::results_test
