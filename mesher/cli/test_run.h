// The fixture of the tests of whole runs.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "mesher/cli/arguments.h"
#include "mesher/cli/run.h"

namespace delmesher::cli {

namespace fs = std::filesystem;

// A folder with an input, and a library with the answers that the test wants.
class RunTest : public testing::Test {
 protected:
  RunTest() {
    folder_ = fs::temp_directory_path() /
              ("delmesher_cli_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(path("in.off"))
        << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    answer_.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    answer_.mesh.tetrahedra = {{0, 1, 2, 3}};
    answer_.mesh.inside = {1};
    library_.tetrahedralize = [this](const Surface&, const Options& options) {
      ++calls_;
      if (options.progress) options.progress({Phase::refine, 0.5, 10});
      return answer_;
    };
    library_.constrained_delaunay = [this](const Surface& surface, const CdtOptions&) {
      return library_.tetrahedralize(surface, {});
    };
    library_.check_surface = [this](const Surface&, const CheckOptions&) { return report_; };
    streams_.out = [this](const std::string& text) { out_ += text; };
    streams_.error = [this](const std::string& text) { error_ += text; };
  }
  ~RunTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  int go(std::vector<std::string> arguments) {
    out_.clear();
    error_.clear();
    const Parsed parsed = parse_arguments(std::move(arguments));
    EXPECT_TRUE(parsed.run) << parsed.error;
    return run(parsed.command, library_, streams_);
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  bool one_error_line() const {
    return error_.starts_with("delmesher: ") && std::count(error_.begin(), error_.end(), '\n') == 1;
  }

  fs::path folder_;
  Result answer_;
  SurfaceReport report_;
  Library library_;
  Streams streams_;
  std::string out_, error_;
  int calls_ = 0;
};

}  // namespace delmesher::cli
