#include "corpus/campaigns/disposition.h"

#include <gtest/gtest.h>
#include <signal.h>

namespace tetproof {
namespace {

Outcome exited(int code, const std::string& words = "") {
  Outcome o;
  o.ending = Ending::exited;
  o.exit_code = code;
  o.stderr_tail = words;
  return o;
}

Outcome signalled(int signal, const std::string& words = "") {
  Outcome o;
  o.ending = Ending::signalled;
  o.signal = signal;
  o.stderr_tail = words;
  return o;
}

Disposition kind(const Outcome& outcome, ExitCodes codes = ExitCodes::ours) {
  return judge(outcome, codes).disposition;
}

TEST(Disposition, OwnExitCodes) {
  EXPECT_EQ(kind(exited(0)), Disposition::ok);
  EXPECT_TRUE(judge(exited(0), ExitCodes::ours).mesh_expected);
  EXPECT_EQ(kind(exited(1)), Disposition::wrong_result);
  EXPECT_TRUE(judge(exited(1), ExitCodes::ours).mesh_expected);
  EXPECT_EQ(kind(exited(2)), Disposition::rejected);
  EXPECT_EQ(kind(exited(3)), Disposition::rejected);
  EXPECT_EQ(kind(exited(4)), Disposition::rejected);
  EXPECT_EQ(kind(exited(5)), Disposition::timeout);
  EXPECT_EQ(kind(exited(6)), Disposition::crash);
  EXPECT_FALSE(judge(exited(4), ExitCodes::ours).mesh_expected);
}

TEST(Disposition, OtherProgramsRefuseByAnyCode) {
  EXPECT_EQ(kind(exited(0), ExitCodes::unknown), Disposition::ok);
  for (const int code : {1, 2, 5, 6, 127}) {
    EXPECT_EQ(kind(exited(code), ExitCodes::unknown), Disposition::rejected);
  }
  EXPECT_EQ(judge(exited(3, "a\nbad facet\n\n"), ExitCodes::unknown).reason, "exit 3: bad facet");
}

// Scripts pass on the signal that ended a program as an exit code.
TEST(Disposition, ScriptsTellOfCrashes) {
  EXPECT_EQ(kind(exited(128 + SIGSEGV), ExitCodes::unknown), Disposition::crash);
  EXPECT_EQ(judge(exited(128 + SIGABRT, "assertion"), ExitCodes::unknown).reason,
            "SIGABRT: assertion");
  EXPECT_EQ(kind(exited(128 + SIGTERM), ExitCodes::unknown), Disposition::rejected);
  EXPECT_EQ(kind(exited(128 + SIGXCPU), ExitCodes::unknown), Disposition::timeout);
  EXPECT_EQ(kind(exited(128 + SIGXCPU)), Disposition::rejected);
  EXPECT_EQ(kind(exited(200), ExitCodes::unknown), Disposition::rejected);
}

// An abort is a crash, not a refusal, unless it was memory that ran out.
TEST(Disposition, Signals) {
  EXPECT_EQ(kind(signalled(SIGSEGV)), Disposition::crash);
  EXPECT_EQ(kind(signalled(SIGABRT, "x.cxx:12: Assertion `0' failed.\n")), Disposition::crash);
  EXPECT_EQ(judge(signalled(SIGABRT, "x.cxx:12: Assertion `0' failed.\n"), ExitCodes::ours).reason,
            "SIGABRT: x.cxx:12: Assertion `0' failed.");
  EXPECT_EQ(kind(signalled(SIGABRT, "terminate ... std::bad_alloc\n")), Disposition::out_of_memory);
  EXPECT_EQ(kind(signalled(SIGKILL)), Disposition::killed);
  EXPECT_EQ(kind(signalled(SIGTERM)), Disposition::killed);
}

TEST(Disposition, Limits) {
  Outcome o;
  o.ending = Ending::wall_limit;
  EXPECT_EQ(kind(o), Disposition::timeout);
  o.ending = Ending::cpu_limit;
  EXPECT_EQ(kind(o), Disposition::timeout);
  o.ending = Ending::memory_limit;
  EXPECT_EQ(kind(o), Disposition::out_of_memory);
  o.ending = Ending::lost;
  EXPECT_EQ(kind(o), Disposition::killed);
  EXPECT_EQ(kind(exited(5, "delmesher: a.off: Out of memory\n")), Disposition::out_of_memory);
}

TEST(Disposition, LastLine) {
  EXPECT_EQ(last_line(""), "");
  EXPECT_EQ(last_line("\n \n"), "");
  EXPECT_EQ(last_line("one"), "one");
  EXPECT_EQ(last_line("one\ntwo \r\n\n"), "two");
}

}  // namespace
}  // namespace tetproof
