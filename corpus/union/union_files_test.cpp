// `tetproof union`: files, words and exit codes.
#include "corpus/union/union_files.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "corpus/generators/certify.h"
#include "oracles/files/surface_file.h"

namespace tetproof::unite {
namespace {

namespace fs = std::filesystem;

class UnionFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("unite_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ / name; }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  // The program itself; what it says goes to said().
  int run(const std::string& arguments) const {
    const std::string line = std::string(TETPROOF_PATH) + " union " + arguments + " >" +
                             path("stdout") + " 2>" + path("said");
    return WEXITSTATUS(std::system(line.c_str()));
  }
  std::string said() const {
    std::stringstream text;
    text << std::ifstream(path("said")).rdbuf();
    return text.str();
  }

  fs::path folder_;
};

// A tetrahedron with its right angles at (x, x, x).
std::string solid(const std::string& name, int x) {
  const int points[4][3] = {{x, x, x}, {x + 4, x, x}, {x, x + 4, x}, {x, x, x + 4}};
  const int triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  std::stringstream text;
  text << "solid " << name << "\n";
  for (const auto& triangle : triangles) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const int v : triangle) {
      text << "vertex " << points[v][0] << " " << points[v][1] << " " << points[v][2] << "\n";
    }
    text << "endloop\nendfacet\n";
  }
  text << "endsolid " << name << "\n";
  return text.str();
}

TEST_F(UnionFiles, WritesWallsOrSaysWhichSnapDoes) {
  const std::string input = write("two.stl", solid("lower", 0) + solid("upper", 1));
  EXPECT_EQ(run("--walls " + input + " -o " + path("walls.stl")), 0) << said();
  EXPECT_NE(said().find("walls.stl: triangles for `delmesher mesh --regions all`"),
            std::string::npos)
      << said();
  EXPECT_EQ(run("--walls --snap 1e-6d " + input + " -o " + path("walls.stl")), 0) << said();
  EXPECT_EQ(run("--walls --snap 10 " + input + " -o " + path("none.stl")), 5);
  EXPECT_NE(said().find("two.stl: all is within 10 of each other; `--snap 0.625` does it, and"),
            std::string::npos)
      << said();
  EXPECT_FALSE(fs::exists(path("none.stl")));
  EXPECT_EQ(run("--walls --snap 100 " + input + " -o " + path("none.stl")), 5);
  EXPECT_NE(said().find("none of five other lengths does it"), std::string::npos) << said();
  for (const char* wrong : {"--snap 1", "--walls --snap 0", "--walls --snap 1d", "--walls --snap x",
                            "--walls --snap ''", "--walls --snap 1e999", "--walls --nonzero"}) {
    EXPECT_EQ(run(wrong + (" " + input) + " -o " + path("none.stl")), 2) << wrong;
  }
}

TEST_F(UnionFiles, WritesTheUnionWithItsNames) {
  const std::string input = write("two.stl", solid("lower", 0) + solid("upper", 1));
  EXPECT_EQ(run(input + " -o " + path("one.stl")), 0) << said();
  EXPECT_NE(said().find("2 bodies of volume 21.3333 became 1 of "), std::string::npos) << said();
  EXPECT_NE(said().find("one.stl: a valid surface"), std::string::npos) << said();
  const oracles::Polyhedron one = oracles::read_surface(path("one.stl"));
  EXPECT_TRUE(certified_valid({one.vertices, one.triangles, {}}));
  std::stringstream text;
  text << std::ifstream(path("one.stl")).rdbuf();
  EXPECT_NE(text.str().find("solid lower\n"), std::string::npos);
  EXPECT_NE(text.str().find("solid upper\n"), std::string::npos);
  EXPECT_EQ(run(input + " -o " + path("one.ply")), 0);
  EXPECT_EQ(run(input + " -o " + path("one.off")), 0);
}

TEST_F(UnionFiles, EndsWithTheCodeOfWhatHappened) {
  const std::string good = write("good.stl", solid("a", 0)), out = path("out.off");
  EXPECT_EQ(run(good), 2);
  EXPECT_EQ(run(good + " -o " + path("out.vtu")), 2);
  EXPECT_EQ(run(path("missing.off") + " -o " + out), 3);
  EXPECT_EQ(run(good + " -o " + path("missing/out.off")), 3);
  EXPECT_EQ(run(write("cut.off", "OFF\n4 4 0\n0 0 0\n") + " -o " + out), 3);
  const std::string sheet = write("sheet.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(run(sheet + " -o " + out), 4);
  EXPECT_NE(said().find("sheet.off: the surface is open"), std::string::npos) << said();
  EXPECT_FALSE(fs::exists(out));
  // A tip on a tip.
  const std::string touching =
      write("tips.off",
            "OFF\n7 8 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n-1 0 0\n0 -1 0\n0 0 -1\n3 0 2 1\n3 0 1 3\n3 1 "
            "2 3\n3 2 0 3\n3 0 4 5\n3 0 6 4\n3 4 6 5\n3 5 6 0\n");
  EXPECT_EQ(run(touching + " -o " + out), 1) << said();
  EXPECT_NE(said().find("touch at 0 edges and 1 more vertex"), std::string::npos) << said();
  EXPECT_TRUE(fs::exists(out));
  fs::remove(out);
  // Where doubles do not tell them apart.
  const std::string farther =
      write("farther.off",
            "OFF\n7 8 0\n1 1 1\n2 1 1\n1 2 1\n1 1 2\n0 1 1\n1 0 1\n1 1 0\n3 0 2 1\n3 0 1 3\n3 1 "
            "2 3\n3 2 0 3\n3 0 4 5\n3 0 6 4\n3 4 6 5\n3 5 6 0\n");
  EXPECT_EQ(run(farther + " --separate 1e-30 -o " + out), 5);
  EXPECT_NE(said().find("could not be moved apart by at most 3.4641e-30"), std::string::npos)
      << said();
  EXPECT_FALSE(fs::exists(out));
  EXPECT_EQ(run(touching + " --separate 1 -o " + out), 2);
  EXPECT_EQ(run(touching + " --separate 1e-3 -o " + out), 0) << said();
  EXPECT_NE(said().find("moved apart there: 2 copies of vertices"), std::string::npos) << said();
  const oracles::Polyhedron apart = oracles::read_surface(out);
  EXPECT_TRUE(certified_valid({apart.vertices, apart.triangles, {}}));
}

TEST_F(UnionFiles, IsInterruptedWithoutAFile) {
  const std::string good = write("good.stl", solid("a", 0));
  UnionOptions options;
  options.go_on = [] { return false; };
  EXPECT_EQ(unite_files(good, path("out.off"), options, [](const std::string&) {}), 130);
  EXPECT_FALSE(fs::exists(path("out.off")));
}

}  // namespace
}  // namespace tetproof::unite
