// Runs of the command line: the files that are written, the exit codes, signals.
#include "mesher/cli/run.h"

#include <csignal>
#include <new>
#include <stdexcept>

#include "mesher/cli/signals.h"
#include "mesher/cli/test_run.h"

namespace delmesher::cli {
namespace {

class Run : public RunTest {};

TEST_F(Run, WritesEveryOutputAndIsSilent) {
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh"), "-o", path("a.node"), "--stats",
                path("s.json"), "--exact", path("e.txt"), "--save-chamfered", path("c.off")}),
            kDone);
  EXPECT_EQ(out_ + error_, "");
  EXPECT_EQ(files(), 8U);
  EXPECT_EQ(go({path("in.off"), "-v", "-o", path("b.tet")}), kDone);
  EXPECT_NE(error_.find("refine "), std::string::npos);
  EXPECT_NE(error_.find("b.tet: 4 vertices, 1 tetrahedron"), std::string::npos);
}

TEST_F(Run, StatusesBecomeExitCodesAndLeaveNoOutput) {
  const std::vector<std::pair<StatusCode, int>> cases = {{StatusCode::invalid_options, 2},
                                                         {StatusCode::invalid_surface, 4},
                                                         {StatusCode::limit_reached, 5},
                                                         {StatusCode::internal_error, 6},
                                                         {StatusCode::interrupted, 130}};
  for (const auto& [status, code] : cases) {
    answer_.status = {status, "because\nof this"};
    EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), code);
    EXPECT_TRUE(one_error_line()) << error_;
    EXPECT_NE(error_.find("in.off: because?of this"), std::string::npos) << error_;
    EXPECT_EQ(files(), 1U);
  }
}

TEST_F(Run, InvertedIsOneAndFlatIsSaid) {
  answer_.statistics.rounding_flat = 2;
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_NE(error_.find("2 flat"), std::string::npos);
  answer_.statistics.rounding_inverted = 3;
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh"), "-q"}), kFailed);
  EXPECT_NE(error_.find("3 inverted and 2 flat"), std::string::npos);
  EXPECT_TRUE(one_error_line());
  EXPECT_TRUE(fs::exists(path("a.mesh")));
}

TEST_F(Run, UnwritableOutputsAreFoundBeforeTheRun) {
  for (const char* option : {"-o", "--stats", "--exact", "--save-chamfered"}) {
    const std::string file = path("in.off/x.mesh");
    std::vector<std::string> arguments = {path("in.off"), option, file};
    if (std::string(option) != "-o") arguments.insert(arguments.end(), {"-o", path("a.mesh")});
    EXPECT_EQ(go(arguments), kUnreadable);
    EXPECT_TRUE(one_error_line()) << error_;
  }
  EXPECT_EQ(calls_, 0);
  EXPECT_EQ(files(), 1U);
}

TEST_F(Run, UnreadableInputIsThree) {
  std::ofstream(path("bad.off")) << "OFF\n1 1 0\n0 0 nan\n3 0 0 0\n";
  EXPECT_EQ(go({path("bad.off"), "-o", path("a.mesh")}), kUnreadable);
  EXPECT_NE(error_.find("bad.off:3: non-finite coordinate 'nan'"), std::string::npos) << error_;
  EXPECT_EQ(go({"check", path("none.off")}), kUnreadable);
  EXPECT_TRUE(one_error_line());
  EXPECT_EQ(calls_, 0);
}

TEST_F(Run, ExceptionsDoNotEscape) {
  library_.tetrahedralize = [](const Surface&, const Options&) -> Result {
    throw std::bad_alloc();
  };
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kLimit);
  library_.tetrahedralize = [](const Surface&, const Options&) -> Result {
    throw std::runtime_error("oops");
  };
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kInternal);
  EXPECT_TRUE(one_error_line());
}

TEST_F(Run, ASignalStopsTheLibraryAndLeavesNothing) {
  library_.tetrahedralize = [](const Surface&, const Options& options) {
    std::raise(SIGINT);
    Result result;
    if (!options.progress({Phase::refine, -1, 0})) {
      result.status = {StatusCode::interrupted, "interrupted"};
    }
    return result;
  };
  // In a child process: the flag stays set for the rest of its life.
  const auto child = [this] {
    std::signal(SIGINT, SIG_DFL);  // ignored, where a shell runs the tests in the background
    install_signal_handlers();
    std::_Exit(go({path("in.off"), "-o", path("a.mesh")}));
  };
  EXPECT_EXIT(child(), testing::ExitedWithCode(kInterrupted), "");
  EXPECT_EQ(files(), 1U);
}

TEST_F(Run, TheSecondSignalDoesNotWait) {
  library_.tetrahedralize = [this](const Surface&, const Options&) -> Result {
    fs::create_directory(path("left"));
    std::ofstream(path("left/left.part0")) << "x";
    set_temporaries({path("left/left.part0"), path("left")});
    std::raise(SIGTERM);
    std::raise(SIGHUP);
    std::_Exit(0);
  };
  const auto child = [this] {
    std::signal(SIGHUP, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    install_signal_handlers();
    go({path("in.off"), "-o", path("a.mesh")});
  };
  EXPECT_EXIT(child(), testing::ExitedWithCode(kInterrupted), "");
  EXPECT_EQ(files(), 1U);
}

// Exit code and files agree: what comes when files have their names comes too late.
TEST_F(Run, NoSignalEndsARunThatIsDone) {
  const auto child = [this](bool done) {
    std::signal(SIGQUIT, SIG_DFL);
    install_signal_handlers();
    EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
    if (!done) note_files_in_place(false);
    std::raise(SIGQUIT);
    std::raise(SIGQUIT);
    std::_Exit(77);
  };
  EXPECT_EXIT(child(true), testing::ExitedWithCode(77), "");
  EXPECT_EXIT(child(false), testing::ExitedWithCode(kInterrupted), "");
}

// As `nohup` and a shell in the background want it.
TEST_F(Run, AnIgnoredSignalStaysIgnored) {
  const auto child = [this] {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
    install_signal_handlers();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::raise(signal);
    std::_Exit(go({path("in.off"), "-o", path("a.mesh")}));
  };
  EXPECT_EXIT(child(), testing::ExitedWithCode(kDone), "");
  EXPECT_TRUE(fs::exists(path("a.mesh")));
}

TEST_F(Run, FoldersAreMadeWhereSomethingIsWritten) {
  EXPECT_EQ(
      go({path("in.off"), "-o", path("new/er/a.mesh"), "--stats", path("stats/s.json"), "-q"}),
      kDone);
  EXPECT_TRUE(fs::exists(path("new/er/a.mesh")));
  EXPECT_TRUE(fs::exists(path("stats/s.json")));
  EXPECT_EQ(go({path("none.off"), "-o", path("other/a.mesh")}), kUnreadable);
  EXPECT_FALSE(fs::exists(path("other")));
  answer_.status = {StatusCode::invalid_surface, "not closed"};
  EXPECT_EQ(go({path("in.off"), "-o", path("other/a.mesh")}), kInvalid);
  EXPECT_FALSE(fs::exists(path("other")));
}

}  // namespace
}  // namespace delmesher::cli
