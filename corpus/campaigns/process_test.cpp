// The supervisor against commands that misbehave.
#include "corpus/campaigns/process.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

namespace tetproof {
namespace {

const std::filesystem::path kSupervisor = TETPROOF_SUPERVISE_PATH;
const std::filesystem::path kNasty = TETPROOF_NASTY_PATH;

std::filesystem::path fresh_file(const std::string& name) {
  const auto path = std::filesystem::path(testing::TempDir()) /
                    ("process_test_" + std::to_string(getpid()) + "_" + name);
  std::filesystem::remove(path);
  return path;
}

Outcome run(std::vector<std::string> argv, Limits limits = {.wall_seconds = 20}) {
  return run_supervised(kSupervisor, {.argv = std::move(argv), .directory = "/", .limits = limits});
}

Outcome nasty(std::vector<std::string> arguments, Limits limits = {.wall_seconds = 20}) {
  arguments.insert(arguments.begin(), kNasty.string());
  return run(std::move(arguments), limits);
}

// The processes that a nasty command started note themselves in a file.
std::vector<pid_t> noted(const std::filesystem::path& file) {
  std::vector<pid_t> pids;
  std::ifstream in(file);
  for (pid_t pid; in >> pid;) pids.push_back(pid);
  return pids;
}

bool alive(pid_t pid) {
  return kill(pid, 0) == 0;
}

TEST(Process, ExitCodeAndStreams) {
  const Outcome o = run({"sh", "-c", "echo out; echo err >&2; pwd; exit 7"});
  EXPECT_EQ(o.ending, Ending::exited);
  EXPECT_EQ(o.exit_code, 7);
  EXPECT_EQ(o.stdout_tail, "out\n/\n");
  EXPECT_EQ(o.stderr_tail, "err\n");
  EXPECT_LT(o.wall_seconds, 5);
  EXPECT_GT(o.wall_seconds, 0);
  EXPECT_GT(o.peak_rss_bytes, 100000u);
  EXPECT_LT(o.peak_rss_bytes, 30000000u);
}

TEST(Process, StandardInputIsEmpty) {
  EXPECT_EQ(run({"cat"}).ending, Ending::exited);
}

TEST(Process, OnlyTheTailOfALongOutputIsKept) {
  const Outcome o = run({"sh", "-c", "seq 1 200000 >&2"});
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_LE(o.stderr_tail.size(), 4096u);
  EXPECT_TRUE(o.stderr_tail.ends_with("\n199999\n200000\n"));
}

TEST(Process, MissingProgram) {
  const Outcome o = run({"/nonexistent/program"});
  EXPECT_EQ(o.ending, Ending::not_started);
  EXPECT_NE(o.error.find("No such file"), std::string::npos) << o.error;
}

TEST(Process, Signals) {
  for (const int s : {SIGSEGV, SIGABRT, SIGFPE, SIGKILL, SIGTERM}) {
    const Outcome o = nasty({"raise", std::to_string(s)});
    EXPECT_EQ(o.ending, Ending::signalled);
    EXPECT_EQ(o.signal, s);
  }
}

TEST(Process, WallLimitOfASleeper) {
  const Outcome o = run({"sleep", "30"}, {.wall_seconds = 0.3});
  EXPECT_EQ(o.ending, Ending::wall_limit);
  EXPECT_GE(o.wall_seconds, 0.3);
  EXPECT_LT(o.wall_seconds, 3);
}

TEST(Process, WallLimitOfOneThatIgnoresSignals) {
  const auto pids = fresh_file("ignore");
  const Outcome o = nasty({"ignore-signals", pids}, {.wall_seconds = 0.3});
  EXPECT_EQ(o.ending, Ending::wall_limit);
  ASSERT_EQ(noted(pids).size(), 1u);
  EXPECT_FALSE(alive(noted(pids)[0]));
}

TEST(Process, CpuLimit) {
  const Outcome o = nasty({"spin"}, {.wall_seconds = 20, .cpu_seconds = 0.3});
  EXPECT_EQ(o.ending, Ending::cpu_limit);
  EXPECT_GE(o.cpu_seconds, 0.25);
  EXPECT_LT(o.cpu_seconds, 2);
}

TEST(Process, CpuLimitCountsGrandchildren) {
  const auto pids = fresh_file("spinners");
  const Outcome o =
      nasty({"grandchildren", "3", "spin", pids}, {.wall_seconds = 20, .cpu_seconds = 0.5});
  EXPECT_EQ(o.ending, Ending::cpu_limit);
  ASSERT_EQ(noted(pids).size(), 3u);
  for (const pid_t pid : noted(pids)) EXPECT_FALSE(alive(pid));
}

// Each child is short, and the mesher waits for each: 2 s in all, though none lives long.
TEST(Process, CpuLimitCountsChildrenThatWereWaitedFor) {
  const Outcome o =
      nasty({"burn-in-turn", "1", "40", "0.05"}, {.wall_seconds = 60, .cpu_seconds = 0.5});
  EXPECT_EQ(o.ending, Ending::cpu_limit);
  EXPECT_GE(o.cpu_seconds, 0.45);
  EXPECT_LT(o.cpu_seconds, 1);
}

TEST(Process, CpuLimitCountsGrandchildrenThatWereWaitedFor) {
  const Outcome o =
      nasty({"burn-in-turn", "10", "4", "0.05"}, {.wall_seconds = 60, .cpu_seconds = 0.5});
  EXPECT_EQ(o.ending, Ending::cpu_limit);
  EXPECT_GE(o.cpu_seconds, 0.45);
  EXPECT_LT(o.cpu_seconds, 1);
}

// 0.6 s of children, each of which is in another process's account by turns. A limit of 0.9 s is
// not reached, as it would be if any were counted twice.
TEST(Process, CpuOfNobodyIsCountedTwice) {
  const Outcome o =
      nasty({"burn-in-turn", "3", "4", "0.05"}, {.wall_seconds = 60, .cpu_seconds = 0.9});
  EXPECT_EQ(o.ending, Ending::exited);
  EXPECT_GE(o.cpu_seconds, 0.55);
  EXPECT_LT(o.cpu_seconds, 0.9);
}

// The parent ignores SIGCHLD, so the kernel adds the time of such children to no account.
TEST(Process, CpuLimitCountsChildrenThatNobodyWaitsFor) {
  const Outcome o = nasty({"burn-forgotten", "20", "0.2"}, {.wall_seconds = 60, .cpu_seconds = 1});
  EXPECT_EQ(o.ending, Ending::cpu_limit);
  EXPECT_GE(o.cpu_seconds, 0.6);
  EXPECT_LT(o.cpu_seconds, 2);
}

// Four processes with the same 120 MB: the sum of the resident sets is beyond the limit.
TEST(Process, SharedPagesAreCountedOnce) {
  if (!std::filesystem::exists("/proc/self/smaps_rollup")) GTEST_SKIP() << "the kernel has no PSS";
  const Outcome o =
      nasty({"share", "120", "3", "0.5"}, {.wall_seconds = 60, .memory_bytes = 250u << 20});
  EXPECT_EQ(o.ending, Ending::exited);
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_GT(o.peak_rss_bytes, 115u << 20);
  EXPECT_LT(o.peak_rss_bytes, 180u << 20);
}

// Pages are shared until the children write; then each has its own.
TEST(Process, PagesWrittenAfterAForkAreNotShared) {
  const Outcome o =
      nasty({"share", "120", "3", "30", "write"}, {.wall_seconds = 60, .memory_bytes = 250u << 20});
  EXPECT_EQ(o.ending, Ending::memory_limit);
  EXPECT_GT(o.peak_rss_bytes, 240u << 20);
}

TEST(Process, MemoryLimitByTouching) {
  const Outcome o = nasty({"allocate", "2000"}, {.wall_seconds = 20, .memory_bytes = 200u << 20});
  EXPECT_EQ(o.ending, Ending::memory_limit);
  EXPECT_GT(o.peak_rss_bytes, 150u << 20);
  EXPECT_LT(o.peak_rss_bytes, 320u << 20);
}

TEST(Process, OneHugeAllocationFailsInTheChild) {
  if (!kMemoryBackstop) GTEST_SKIP() << "a build with a sanitizer sets no RLIMIT_DATA";
  const Outcome o =
      nasty({"allocate-at-once", "50000"}, {.wall_seconds = 20, .memory_bytes = 200u << 20});
  EXPECT_EQ(o.ending, Ending::signalled);
  EXPECT_EQ(o.signal, SIGABRT);
  EXPECT_NE(o.stderr_tail.find("bad_alloc"), std::string::npos) << o.stderr_tail;
}

TEST(Process, MemoryLimitIsForAllProcessesTogether) {
  const auto pids = fresh_file("eaters");
  const Outcome o = nasty({"grandchildren", "4", "hold-80", pids},
                          {.wall_seconds = 20, .memory_bytes = 200u << 20});
  EXPECT_EQ(o.ending, Ending::memory_limit);
  for (const pid_t pid : noted(pids)) EXPECT_FALSE(alive(pid));
}

TEST(Process, PeakMemoryIsOfTheChildNotOfTheRunner) {
  std::vector<char> ballast(300u << 20, 1);  // resident in this process
  const Outcome o = nasty({"allocate", "50"});
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_GT(o.peak_rss_bytes, 50u << 20);
  EXPECT_LT(o.peak_rss_bytes, 70u << 20);
  EXPECT_EQ(ballast[12345], 1);
}

TEST(Process, NothingSurvivesACommandThatExits) {
  const auto pids = fresh_file("survivors");
  const Outcome o = nasty({"leave-daemons", "3", pids});
  EXPECT_EQ(o.ending, Ending::exited);
  EXPECT_EQ(o.leftover_processes, 3);
  EXPECT_EQ(o.unkillable_processes, 0);
  ASSERT_EQ(noted(pids).size(), 3u);
  for (const pid_t pid : noted(pids)) EXPECT_FALSE(alive(pid));
}

TEST(Process, FileSizeLimit) {
  const auto file = fresh_file("large");
  const Outcome o = run({"sh", "-c", "exec head -c 30000000 /dev/zero > " + file.string()},
                        {.wall_seconds = 20, .file_bytes = 1u << 20});
  EXPECT_EQ(o.ending, Ending::signalled);
  EXPECT_EQ(o.signal, SIGXFSZ);
  EXPECT_EQ(std::filesystem::file_size(file), 1u << 20);
}

TEST(Process, StoppedOnRequest) {
  const auto pids = fresh_file("stopped");
  SupervisedProcess process(kSupervisor, {.argv = {kNasty, "ignore-signals", pids}, .limits = {}});
  while (noted(pids).empty()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_FALSE(process.advance());
  process.stop();
  while (!process.advance()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(process.outcome().ending, Ending::stopped);
  EXPECT_FALSE(alive(noted(pids)[0]));
}

// If the runner is killed with signal 9, its meshers do not go on running.
TEST(Process, DeathOfTheRunnerEndsTheJob) {
  const auto pids = fresh_file("orphans");
  const pid_t runner = fork();
  if (runner == 0) {
    run_supervised(kSupervisor, {.argv = {kNasty, "ignore-signals", pids}, .limits = {}});
    _exit(0);
  }
  while (noted(pids).empty()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const pid_t orphan = noted(pids)[0];
  EXPECT_TRUE(alive(orphan));
  kill(runner, SIGKILL);
  waitpid(runner, nullptr, 0);
  for (int i = 0; i < 1000 && alive(orphan); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_FALSE(alive(orphan));
}

TEST(Process, ReportRoundTrip) {
  Outcome o;
  o.ending = Ending::memory_limit;
  o.wall_seconds = 0.1;
  o.peak_rss_bytes = 123456789012;
  o.stderr_tail = "a\nb 12\n\n";
  o.stdout_tail = std::string("\0x\n", 3);
  Outcome back;
  ASSERT_TRUE(deserialize(serialize(o), back));
  EXPECT_EQ(serialize(back), serialize(o));
  EXPECT_EQ(back.stdout_tail, o.stdout_tail);
  std::string cut = serialize(o);
  cut.resize(cut.size() - 2);
  EXPECT_FALSE(deserialize(cut, back));
  EXPECT_FALSE(deserialize("", back));
}

TEST(Process, SignalNames) {
  EXPECT_EQ(signal_name(SIGSEGV), "SIGSEGV");
  EXPECT_EQ(signal_name(SIGABRT), "SIGABRT");
  EXPECT_EQ(signal_name(250), "signal 250");
}

}  // namespace
}  // namespace tetproof
