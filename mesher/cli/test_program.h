// The program itself, run in a folder of its own, and a file to begin with.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace delmesher::cli {

namespace fs = std::filesystem;

class Program : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '_');
    folder_ = fs::path(DELMESHER_SCRATCH) / name;
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string text(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& name, const std::string& contents) const {
    std::ofstream(path(name), std::ios::binary) << contents;
  }

  // Runs it in the folder; `before` may be another program with its arguments.
  int run(const std::string& arguments, const std::string& before = "") const {
    const std::string command = "cd '" + folder_.string() + "' && " + before + " '" +
                                DELMESHER_PATH + "' " + arguments + " > out.txt 2> err.txt";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  // One line, beginning with the program's name and the file's, that contains `part`.
  void expect_error(const std::string& file, const std::string& part) const {
    const std::string said = text("err.txt");
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_TRUE(said.starts_with("delmesher: " + file + ":")) << said;
    EXPECT_NE(said.find(part), std::string::npos) << said;
  }

  // There are no files but the input, the messages, and the statistics, which tell the status of
  // any run.
  void expect_no_output() const {
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      const bool known = name == "out.txt" || name == "err.txt" || name == "stats.json";
      EXPECT_TRUE(known || name.starts_with("in.")) << name;
    }
  }

  fs::path folder_;
};

inline const std::string kCubeVertices = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";
inline const std::string kCubeTriangles =
    "3 0 2 3\n3 0 3 1\n3 4 5 7\n3 4 7 6\n3 0 1 5\n3 0 5 4\n"
    "3 2 6 7\n3 2 7 3\n3 0 4 6\n3 0 6 2\n3 1 3 7\n3 1 7 5\n";

inline std::string cube() {
  return "OFF\n8 12 0\n" + kCubeVertices + kCubeTriangles;
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

}  // namespace delmesher::cli
