#include "corpus/models/models.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>

namespace tetproof {
namespace {

namespace fs = std::filesystem;

class Models : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("models_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "sub");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  fs::path folder_;
};

TEST_F(Models, FoldersAreSearchedAndSortedAndDuplicatesLeftOut) {
  write("b.off", "b");
  write("a.STL", "a");
  write("sub/c.ply", "c");
  write("same-as-b.obj", "b");
  write("notes.txt", "x");
  const ModelList list = collect_models({folder_});
  ASSERT_EQ(list.models.size(), 3u);
  EXPECT_EQ(list.models[0].name, "a.STL");
  EXPECT_EQ(list.models[1].name, "b.off");
  EXPECT_EQ(list.models[2].name, "sub/c.ply");
  EXPECT_EQ(list.models[2].bytes, 1u);
  EXPECT_EQ(list.models[1].sha256,
            "3e23e8160039594a33894f6564e1b1348bbd7a0088d42c4acb73eeaed59c009d");
  ASSERT_EQ(list.duplicates.size(), 1u);
  EXPECT_EQ(list.duplicates[0].filename(), "same-as-b.obj");
}

TEST_F(Models, FilesOfAnyNameAreTaken) {
  write("model.weird", "1");
  const ModelList list = collect_models({folder_ / "model.weird"});
  ASSERT_EQ(list.models.size(), 1u);
  EXPECT_EQ(list.models[0].name, "model.weird");
  EXPECT_TRUE(list.models[0].path.is_absolute());
  EXPECT_THROW(collect_models({folder_ / "missing.off"}), std::runtime_error);
}

// A campaign of no models would end as if all were well.
TEST_F(Models, AFolderWithoutSurfacesIsRefused) {
  write("notes.txt", "x");
  EXPECT_THROW(collect_models({folder_}), std::runtime_error);
  write("sub/c.ply", "c");
  EXPECT_EQ(collect_models({folder_}).models.size(), 1u);
}

// Also in a cycle, and two links to one folder.
TEST_F(Models, LinksToFoldersAreFollowedAndEveryFolderEnteredOnce) {
  const fs::path other = folder_.string() + ".other";
  fs::create_directories(other / "deep");
  std::ofstream(other / "deep" / "d.off") << "d";
  write("sub/c.off", "c");
  fs::create_directory_symlink("..", folder_ / "sub" / "up");
  fs::create_directory_symlink(other, folder_ / "a-link");
  fs::create_directory_symlink(other / "deep", folder_ / "b-link");
  fs::create_directory_symlink("sub", folder_ / "alias-of-sub");
  fs::create_directory_symlink(folder_, other / "back");
  fs::create_symlink("nowhere.off", folder_ / "dangling.off");
  const ModelList list = collect_models({folder_});
  ASSERT_EQ(list.models.size(), 2U);
  EXPECT_TRUE(list.duplicates.empty());
  EXPECT_EQ(list.models[0].name, "a-link/deep/d.off");
  EXPECT_EQ(list.models[1].name, "sub/c.off");  // not alias-of-sub, though that comes first
  fs::remove_all(other);
}

TEST_F(Models, LinksThatLeadNowhereArePassedOver) {
  write("a.off", "a");
  fs::create_symlink("me.off", folder_ / "me.off");
  fs::create_symlink("me", folder_ / "me");
  fs::create_symlink("none.off", folder_ / "dangling.off");
  EXPECT_EQ(collect_models({folder_}).models.size(), 1U);
  EXPECT_THROW(collect_models({folder_ / "me.off"}), std::runtime_error);
}

TEST_F(Models, CompressedFilesAreTaken) {
  write("a.off.gz", "a");
  write("sub/b.STL.gz", "b");
  write("c.txt.gz", "c");
  write(".gz", "d");
  const ModelList list = collect_models({folder_});
  ASSERT_EQ(list.models.size(), 2U);
  EXPECT_EQ(list.models[0].name, "a.off.gz");
}

TEST_F(Models, ShardsPartition) {
  for (int i = 0; i < 40; ++i) write(std::to_string(i) + ".off", std::to_string(i));
  const auto models = collect_models({folder_}).models;
  std::set<std::string> seen;
  for (unsigned i = 1; i <= 3; ++i) {
    const auto part = shard_of(models, i, 3);
    EXPECT_GT(part.size(), 4u);
    for (const Model& model : part) EXPECT_TRUE(seen.insert(model.sha256).second);
  }
  EXPECT_EQ(seen.size(), models.size());
}

TEST_F(Models, TiersAreNestedAndDoNotDependOnTheOrder) {
  for (int i = 0; i < 400; ++i) write(std::to_string(i) + ".off", std::to_string(i));
  write("large.off", std::string(300'000, 'x'));
  write("huge.off", std::string(6'000'000, 'x'));
  auto models = collect_models({folder_}).models;
  const auto hashes = [](const std::vector<Model>& part) {
    std::set<std::string> set;
    for (const Model& model : part) set.insert(model.sha256);
    return set;
  };
  const auto smoke = hashes(tier_of(models, Tier::smoke));
  const auto nightly = hashes(tier_of(models, Tier::nightly));
  EXPECT_EQ(smoke.size(), 30U);
  EXPECT_GE(nightly.size(), 300U);
  EXPECT_EQ(tier_of(models, Tier::weekly).size(), models.size());
  EXPECT_TRUE(std::includes(nightly.begin(), nightly.end(), smoke.begin(), smoke.end()));
  for (const Model& model : models) {
    EXPECT_FALSE(model.name == "huge.off" && nightly.contains(model.sha256));
    EXPECT_FALSE(model.name == "large.off" && smoke.contains(model.sha256));
  }
  std::reverse(models.begin(), models.end());
  EXPECT_EQ(hashes(tier_of(models, Tier::smoke)), smoke);
  EXPECT_THROW(tier_from_name("daily"), std::runtime_error);
}

}  // namespace
}  // namespace tetproof
