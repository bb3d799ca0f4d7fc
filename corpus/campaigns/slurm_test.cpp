// The job array with made-up sbatch and squeue; `ci/full/campaign_check --slurm` has the real ones.
#include "corpus/campaigns/slurm.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace tetproof {
namespace {

namespace fs = std::filesystem;

// Runs the tasks at once, one after the other; squeue then knows of none.
const std::string kSbatch = R"(#!/bin/sh
echo "$@" >> "$FOLDER/submitted"
for word; do
  case $word in --array=*) array=${word#--array=} ;; esac
  script=$word
done
for shard in $(echo "$array" | tr ',' ' '); do
  for i in $(seq "${shard%-*}" "${shard#*-}"); do
    SLURM_ARRAY_TASK_ID=$i sh "$script" >> "$FOLDER/log" 2>&1
  done
done
echo "${SLURM_ANSWER:-42}"
)";

class SlurmTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("slurm_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    script("sbatch", kSbatch);
    script("squeue", "#!/bin/sh\nexit 0\n");
    path_ = getenv("PATH");
    setenv("PATH", (folder_.string() + ":" + path_).c_str(), 1);
    setenv("FOLDER", folder_.c_str(), 1);
    campaign_.folder = folder_ / "campaign";
    campaign_.shards = 4;
    task("exit 0");
  }
  void TearDown() override {
    setenv("PATH", path_.c_str(), 1);
    unsetenv("SLURM_ANSWER");
    fs::remove_all(folder_);
  }

  void script(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    fs::permissions(folder_ / name, fs::perms::owner_all);
  }
  // The script of a task; it is called with --db FILE --shard I/N.
  void task(const std::string& line) {
    script("task",
           "#!/bin/sh\necho \"$@\" >> " + (folder_ / "tasks").string() + "\n" + line + "\n");
    campaign_.task = {(folder_ / "task").string(), "it's"};
  }
  int lines(const std::string& name) const {
    std::ifstream in(folder_ / name);
    int count = 0;
    for (std::string line; std::getline(in, line);) ++count;
    return count;
  }
  SlurmEnd run() {
    return run_slurm_campaign(campaign_, [&](const std::string& line) { said_ += line + "\n"; });
  }

  fs::path folder_;
  std::string path_, said_;
  SlurmCampaign campaign_;
};

TEST_F(SlurmTest, EveryShardIsRunOnce) {
  campaign_.processors = 2;
  campaign_.memory_mebibytes = 3000;
  campaign_.task_minutes = 90;
  campaign_.sbatch = {"--partition=x"};
  EXPECT_EQ(run(), SlurmEnd::merged);
  EXPECT_EQ(lines("tasks"), 4);
  std::ifstream in(folder_ / "submitted");
  std::string line;
  std::getline(in, line);
  for (const char* option : {"--array=1-4", "--cpus-per-task=2", "--mem=3000M", "--time=90",
                             "--partition=x", "--parsable"}) {
    EXPECT_NE(line.find(option), std::string::npos) << option << " in " << line;
  }
  std::ifstream tasks(folder_ / "tasks");
  std::getline(tasks, line);
  EXPECT_EQ(line, "it's --db " + shard_database(campaign_, 1).string() + " --shard 1/4");
}

TEST_F(SlurmTest, LostTasksAreSubmittedAgain) {
  // Shards 2 and 3 die the first time.
  task("case \"$*\" in *2/4|*3/4) [ -f " + (folder_ / "second").string() +
       " ] || { case \"$*\" in *3/4) : > " + (folder_ / "second").string() +
       ";; esac; kill -9 $$; };; esac");
  EXPECT_EQ(run(), SlurmEnd::merged) << said_;
  EXPECT_EQ(lines("submitted"), 2);
  EXPECT_EQ(lines("tasks"), 6);
  EXPECT_NE(said_.find("lost: tasks 2-3"), std::string::npos) << said_;
}

TEST_F(SlurmTest, TasksThatAlwaysDieAreGivenUp) {
  campaign_.retries = 2;
  task("exit 3");
  EXPECT_EQ(run(), SlurmEnd::lost);
  EXPECT_EQ(lines("submitted"), 3);
}

TEST_F(SlurmTest, TheSameAgainSubmitsNothing) {
  EXPECT_EQ(run(), SlurmEnd::merged);
  EXPECT_EQ(run(), SlurmEnd::merged);
  EXPECT_EQ(lines("submitted"), 1);
  campaign_.models = "others";
  EXPECT_EQ(run(), SlurmEnd::merged);
  EXPECT_EQ(lines("submitted"), 2);
}

TEST_F(SlurmTest, ARefusalOfSbatchIsTold) {
  setenv("SLURM_ANSWER", "sbatch: error: no partition", 1);
  EXPECT_EQ(run(), SlurmEnd::failed);
  EXPECT_NE(said_.find("no partition"), std::string::npos);
}

TEST(SlurmArray, RangesAreJoined) {
  EXPECT_EQ(array_of({}), "");
  EXPECT_EQ(array_of({5}), "5");
  EXPECT_EQ(array_of({1, 2, 3, 7, 9, 10}), "1-3,7,9-10");
}

}  // namespace
}  // namespace tetproof
