// Manifests of small collections, by the mesher's own check.
#include "corpus/models/classify.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "reports/csv.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

const std::string kTetrahedron =
    "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
const std::string kOpen = "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n";
// The second tetrahedron's corner is inside the first.
const std::string kCrossing =
    "OFF\n8 8 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n.5 .5 .5\n9 9 9\n9 8 9\n8 9 9\n3 0 2 1\n3 0 1 3\n"
    "3 1 2 3\n3 2 0 3\n3 4 6 5\n3 4 5 7\n3 5 6 7\n3 6 4 7\n";

class ClassifyTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("classify_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "models");
    options_.supervisor = TETPROOF_SUPERVISE_PATH;
    options_.delmesher = fs::path(TETPROOF_PATH).parent_path() / "delmesher";
    options_.scratch = folder_ / "scratch";
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / "models" / name) << text;
  }

  std::map<std::string, Classification> all(unsigned jobs = 1) {
    options_.jobs = jobs;
    std::map<std::string, Classification> found;
    for (const auto& c :
         classify(collect_models({folder_ / "models"}).models, options_, [](const auto&) {})) {
      found[c.file] = c;
    }
    return found;
  }

  fs::path folder_;
  ClassifyOptions options_;
};

TEST_F(ClassifyTest, VerdictsWithReasons) {
  write("good.off", kTetrahedron);
  write("open.off", kOpen);
  write("crossing.off", kCrossing);
  write("garbage.off", "OFF\nnonsense");
  write("nan.off", "OFF\n4 1 0\n0 0 0\n1 nan 0\n0 1 0\n0 0 1\n3 0 2 1\n");
  auto found = all();
  ASSERT_EQ(found.size(), 5U);
  EXPECT_EQ(found["good.off"].validity, Validity::valid);
  EXPECT_EQ(found["good.off"].vertices, 4U);
  EXPECT_EQ(found["good.off"].triangles, 4U);
  EXPECT_EQ(found["good.off"].closed(), true);
  EXPECT_EQ(found["good.off"].self_intersecting(), false);
  EXPECT_EQ(found["open.off"].validity, Validity::invalid);
  EXPECT_EQ(found["open.off"].closed(), false);
  EXPECT_EQ(found["open.off"].manifold(), true);
  EXPECT_EQ(found["open.off"].defects["open edge"], 3U);
  EXPECT_FALSE(found["open.off"].reason.empty());
  EXPECT_EQ(found["crossing.off"].validity, Validity::invalid);
  EXPECT_EQ(found["crossing.off"].self_intersecting(), true);
  EXPECT_EQ(found["crossing.off"].closed(), true);
  EXPECT_EQ(found["garbage.off"].validity, Validity::unreadable);
  EXPECT_EQ(found["garbage.off"].closed(), std::nullopt);
  EXPECT_EQ(found["garbage.off"].reason.find(folder_.string()), std::string::npos);
  EXPECT_NE(found["nan.off"].validity, Validity::valid);
  EXPECT_EQ(found["nan.off"].closed(), std::nullopt);
}

TEST_F(ClassifyTest, TheManifestDoesNotDependOnTheNumberOfJobs) {
  write("good.off", kTetrahedron);
  write("open.off", kOpen);
  write("garbage.off", "OFF\nnonsense");
  std::string texts[2];
  for (unsigned jobs : {1U, 3U}) {
    std::vector<Classification> list;
    for (auto& [name, c] : all(jobs)) list.insert(list.begin(), c);
    texts[jobs / 2] = manifest_csv(list) + manifest_json(list);
  }
  EXPECT_EQ(texts[0], texts[1]);
}

TEST_F(ClassifyTest, AManifestIsReadBack) {
  write("good.off", kTetrahedron);
  write("open.off", kOpen);
  write("garbage.off", "OFF\nnonsense");
  std::vector<Classification> list;
  for (auto& [name, c] : all()) list.push_back(c);
  list[1].licence = "CC BY, \"4.0\"";
  std::ofstream(folder_ / "manifest.csv") << manifest_csv(list);
  EXPECT_EQ(manifest_csv(read_manifest(folder_ / "manifest.csv")), manifest_csv(list));
  EXPECT_THROW(read_manifest(folder_ / "missing.csv"), std::runtime_error);
}

TEST_F(ClassifyTest, ACheckThatHangsOrDiesIsUndecided) {
  write("good.off", kTetrahedron);
  const auto check = folder_ / "delmesher";
  options_.delmesher = check;
  options_.limits.wall_seconds = 0.3;
  for (const char* line : {"sleep 20", "kill -11 $$", "exit 6"}) {
    std::ofstream(check) << "#!/bin/sh\n" << line << "\n";
    fs::permissions(check, fs::perms::owner_all);
    const auto found = all();
    EXPECT_EQ(found.at("good.off").validity, Validity::undecided) << line;
    EXPECT_FALSE(found.at("good.off").reason.empty());
  }
}

TEST(Csv, QuotesAndLineEnds) {
  const auto rows = parse_csv("a,b\r\n\"x,\"\"y\"\"\nz\",2\r\n\n3,");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1], (std::vector<std::string>{"x,\"y\"\nz", "2"}));
  EXPECT_EQ(rows[2], (std::vector<std::string>{"3", ""}));
}

}  // namespace
}  // namespace tetproof
