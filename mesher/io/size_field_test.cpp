// Sizes from place to place, as lines and as views of Gmsh.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "mesher/delmesher_files.h"

namespace delmesher::io {
namespace {

class SizeFieldFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = testing::TempDir() + "delmesher_size_field_" + test->name() + ".txt";
  }
  void TearDown() override { std::filesystem::remove(path_); }

  SizeFieldResult read(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return read_size_field(path_);
  }
  std::string error_of(const std::string& text) const {
    const std::string error = read(text).error;
    EXPECT_TRUE(error.starts_with(path_ + ":")) << error;
    return error.substr(std::min(error.size(), path_.size() + 1));
  }
  // Each source as four numbers with spaces between them.
  std::string sources(const std::string& text) const {
    const SizeFieldResult result = read(text);
    EXPECT_EQ(result.error, "");
    std::string all;
    for (const SizeSource& s : result.sources) {
      for (const double x : {s.point[0], s.point[1], s.point[2], s.size}) {
        all += std::to_string(static_cast<int>(std::lround(100 * x))) + " ";
      }
    }
    return all;
  }

  std::string path_;
};

TEST_F(SizeFieldFiles, AreLinesOfFourNumbers) {
  EXPECT_EQ(sources("1 2 3 0.5\n-1 0 1e1 .25"), "100 200 300 50 -100 0 1000 25 ");
  EXPECT_EQ(sources("x,y,z,size\r\n# here\r\n\r\n1,2,3,0.5\r\n"), "100 200 300 50 ");
  EXPECT_EQ(sources("1, 2, 3, 0.5 # small"), "100 200 300 50 ");
}

TEST_F(SizeFieldFiles, AreViewsOfScalars) {
  EXPECT_EQ(sources("View \"a size\" {\n  SP(1,2,3){0.5};\n"
                    "SL(0,0,0, 1,0,0){1, 2}; // a line\nSP( -1.5 , 0 , 2e0 ) { .25 } ;\n};\n"),
            "100 200 300 50 0 0 0 100 100 0 0 200 -150 0 200 25 ");
  // The first of several steps of time; two views.
  EXPECT_EQ(sources("View \"\" {SP(1,1,1){3,4};};View \"b\" {SP(2,2,2){1};};"),
            "100 100 100 300 200 200 200 100 ");
}

TEST_F(SizeFieldFiles, ThatAreWrongAreRefusedByLine) {
  EXPECT_EQ(error_of("1 2 3 4\n1 2 3\n"), "2: fewer numbers than expected: X Y Z SIZE");
  EXPECT_EQ(error_of("1 2 3 4 5\n"), "1: more numbers than expected: X Y Z SIZE");
  EXPECT_EQ(error_of("x y z h\nx y z h\n"), "2: not a number: 'x'");
  EXPECT_EQ(error_of("1 2 3 0\n"), "1: sizes have to be above 0");
  EXPECT_EQ(error_of("1 2 3 inf\n"), "1: not a number: 'inf'");
  EXPECT_EQ(error_of("# nothing\n"), " no sizes in it");
  EXPECT_EQ(error_of("View \"v\" {\nVP(0,0,0){1,2,3};};"),
            "2: only views of scalars have sizes, no 'VP'");
  EXPECT_EQ(error_of("View \"v\" {\nSP(0,0){1};};"), "2: 2 coordinates, but 1 values");
  EXPECT_EQ(error_of("View \"v\" {\n\nSP(0,0,0){-1};};"), "3: sizes have to be above 0");
  EXPECT_EQ(error_of("View \"v\" {\nSP(0,0,0){1};"), "2: only views of scalars have sizes, no ''");
  EXPECT_FALSE(read_size_field(path_ + ".none").ok());
}

TEST_F(SizeFieldFiles, OfPointsAreLinesOfThreeNumbers) {
  const auto points = [this](const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return read_points(path_);
  };
  using Points = std::vector<std::array<double, 3>>;
  EXPECT_EQ(points("x y z\n1 2 3 # here\n4,5,.5\n").points, (Points{{1, 2, 3}, {4, 5, 0.5}}));
  EXPECT_EQ(points("1 2 3\n1 2\n").error, path_ + ":2: fewer numbers than expected: X Y Z");
  EXPECT_EQ(points("1 2 3x\n4 5 6\n").error, path_ + ":1: not a number: '3x'");
  EXPECT_EQ(points("0.5;0.5;0.5\n4 5 6\n").error, path_ + ":1: not a number: '0.5;0.5;0.5'");
  EXPECT_EQ(points("1 2 3 4\n").error, path_ + ":1: more numbers than expected: X Y Z");
  EXPECT_EQ(points("# none\n").error, path_ + ": no points in it");
  EXPECT_FALSE(read_points(path_ + ".none").ok());
}

}  // namespace
}  // namespace delmesher::io
