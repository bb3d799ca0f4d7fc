// The program itself, as users run it: an error in a file is one line with the documented
// exit code, nothing is left half-written, and signals and limits end a run.
#include <cmath>
#include <ostream>
#include <sstream>
#include <utility>

#include "mesher/cli/test_program.h"

namespace delmesher::cli {
namespace {

struct BadFile {
  const char* law;
  const char* name;
  std::string contents;
  int code;
  const char* said;
};

void PrintTo(const BadFile& file, std::ostream* stream) {
  *stream << file.law;
}

class BadFiles : public Program, public testing::WithParamInterface<BadFile> {};

TEST_P(BadFiles, EndWithTheirCodeAndOneLine) {
  const BadFile& bad = GetParam();
  write(bad.name, bad.contents);
  EXPECT_EQ(run(std::string("mesh ") + bad.name + " -o mesh.vtu --stats stats.json"), bad.code);
  expect_error(bad.name, bad.said);
  EXPECT_EQ(text("out.txt"), "");
  EXPECT_EQ(run(std::string("check ") + bad.name), bad.code);
  expect_error(bad.name, bad.said);
  EXPECT_EQ(run(std::string("cdt ") + bad.name + " -o mesh.tet"), bad.code);
  expect_no_output();
}

const BadFile kBadFiles[] = {
    {"Empty", "in.off", "", 3, ""},
    {"NoSurface", "in.off", "OFF\n0 0 0\n", 3, "no faces"},
    {"Garbage", "in.off",
     std::string("\x7f"
                 "ELF\0\1\2\3garbage",
                 15),
     3, ""},
    {"Truncated", "in.off", cube().substr(0, cube().size() - 30), 3, "in.off:"},
    {"NoNumber", "in.off", replaced(cube(), "1 1 0\n", "1 one 0\n"), 3, "in.off:6:"},
    {"NaN", "in.off", replaced(cube(), "1 1 0\n", "1 nan 0\n"), 3, "in.off:6:"},
    {"Infinite", "in.off", replaced(cube(), "1 1 0\n", "1 1e999 0\n"), 3, "in.off:6:"},
    {"IndexOutOfRange", "in.off", replaced(cube(), "3 1 7 5\n", "3 1 7 8\n"), 3, "in.off:22:"},
    {"NegativeIndex", "in.off", replaced(cube(), "3 1 7 5\n", "3 1 7 -5\n"), 3, "in.off:22:"},
    {"HugeCounts", "in.off", "OFF\n999999999999 999999999999 0\n0 0 0\n", 3, "in.off:"},
    {"HugePolygon", "in.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n", 3,
     "in.off:6:"},
    {"BinaryStlCutShort", "in.stl", std::string(80, 'x') + std::string("\xff\xff\xff\x7f", 4), 3,
     ""},
    {"ObjWithoutCoordinates", "in.obj", "v 0 0\nf 1 1 1\n", 3, "in.obj:1:"},
    {"PlyWithoutEnd", "in.ply", "ply\nformat ascii 1.0\nelement vertex 8\n", 3, "in.ply:"},
    {"Open", "in.off", replaced(replaced(cube(), "8 12", "8 11"), "3 1 7 5\n", ""), 4, "edge"},
    {"RepeatedCorner", "in.off", replaced(cube(), "3 1 7 5\n", "3 1 7 7\n"), 4, "triangle 11"},
    {"TwiceTheSameTriangle", "in.off",
     replaced(replaced(cube(), "8 12", "8 13"), "3 1 7 5\n", "3 1 7 5\n3 1 7 5\n"), 4, "11"},
    {"OneTriangleTurned", "in.off", replaced(cube(), "3 1 7 5\n", "3 1 5 7\n"), 4, "11"},
    {"VertexThroughAFace", "in.off", replaced(cube(), "1 1 1\n", "0.5 0.5 -1\n"), 4, "intersect"},
    {"Flat", "in.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n", 4, "triangle"},
    {"CollinearCorners", "in.off",
     "OFF\n5 6 0\n0 0 0\n1 0 0\n2 0 0\n0 1 0\n0 0 1\n3 0 3 2\n3 0 1 4\n3 1 2 4\n3 0 4 3\n3 2 3 "
     "4\n3 0 2 1\n",
     4, "triangle 5"},
    {"TwoSolidsSharingAVertex", "in.off",
     "OFF\n7 8 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n-1 0 0\n0 -1 0\n0 0 -1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 "
     "1 2 3\n"
     "3 0 4 5\n3 0 6 4\n3 0 5 6\n3 4 6 5\n",
     4, "vertex 0"},
};

INSTANTIATE_TEST_SUITE_P(Program, BadFiles, testing::ValuesIn(kBadFiles),
                         [](const auto& bad) { return std::string(bad.param.law); });

// Kuhn's six tetrahedra along a diagonal of the cube: r = 1/2 / (1 + sqrt 2), R = sqrt 3 / 2.
TEST_F(Program, AGoodFileIsMeshedInOneLineOrSilence) {
  write("in.off", cube());
  EXPECT_EQ(run("in.off -o mesh.mesh --size none"), 0);
  EXPECT_EQ(text("out.txt"), "");
  EXPECT_TRUE(text("err.txt").starts_with("mesh.mesh: 8 vertices, 6 tetrahedra in "));
  EXPECT_TRUE(text("err.txt").ends_with(
      " s; dihedral angles 45.00 to 90.00 degrees, 0 tetrahedra below 5, the smallest at (0, 0, "
      "0.5); smallest face angle 35.26; mean shape 0.72 (1 is regular)\n"))
      << text("err.txt");
  EXPECT_GT(text("mesh.mesh").size(), 100U);
  EXPECT_EQ(run("in.off -o mesh.mesh -q"), 0);
  EXPECT_EQ(text("out.txt") + text("err.txt"), "");
  EXPECT_EQ(run("in.off -o mesh.mesh"), 0);
  EXPECT_TRUE(
      text("err.txt").ends_with("; edges of 0.17 by default, because there are only 6 "
                                "tetrahedra with --size none\n"))
      << text("err.txt");
  EXPECT_EQ(run("in.off -o mesh.mesh --size 0.17"), 0);
  EXPECT_EQ(text("err.txt").find("default"), std::string::npos) << text("err.txt");
}

// Those six again. A size halves the longest edge first, which all of them share.
TEST_F(Program, ABudgetIsFilledOrRefusedWithTheNumberThatItTakes) {
  write("in.off", cube());
  EXPECT_EQ(run("in.off -o mesh.mesh --budget 2000"), 0);
  EXPECT_NE(text("err.txt").find(" to fill the budget, because there are 6 tetrahedra with"),
            std::string::npos)
      << text("err.txt");
  EXPECT_EQ(text("err.txt").find("nine tenths"), std::string::npos) << text("err.txt");
  EXPECT_EQ(run("in.off -o mesh.mesh --budget 7"), 0);
  EXPECT_TRUE(
      text("err.txt").ends_with("; no length of edges tried makes nine tenths of the budget\n"))
      << text("err.txt");
  fs::remove(path("mesh.mesh"));
  EXPECT_EQ(run("in.off -o mesh.mesh --budget 5"), 5);
  EXPECT_NE(text("err.txt").find("the mesh has 6 tetrahedra, more than the budget of 5 tetrahedra"),
            std::string::npos)
      << text("err.txt");
  EXPECT_FALSE(fs::exists(path("mesh.mesh")));
}

TEST_F(Program, WallsAreSplitInEveryFormat) {
  const auto box = [](const char* name, int x) {
    std::string text = std::string("solid ") + name + "\n";
    constexpr int kCorners[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                     {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                     {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    for (const auto& triangle : kCorners) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const int v : triangle) {
        text += "vertex " + std::to_string(x + v % 2) + " " + std::to_string(v / 2 % 2) + " " +
                std::to_string(v / 4) + "\n";
      }
      text += "endloop\nendfacet\n";
    }
    return text + "endsolid\n";
  };
  write("in.stl", box("copper", 0) + box("air", 1));
  EXPECT_EQ(
      run("in.stl -o a.inp -o a.msh -o a.vtu --ascii --regions all --split-walls 'air|copper'"), 0);
  for (const char* set : {"NAME=copper_air\n", "NAME=air_copper\n"}) {
    EXPECT_NE(text("a.inp").find(set), std::string::npos) << text("a.inp");
  }
  EXPECT_NE(text("a.msh").find("\"air|copper\""), std::string::npos);
  EXPECT_NE(text("a.vtu").find("\"copper|air\""), std::string::npos);
  EXPECT_EQ(run("in.stl -o a.inp --regions all --split-walls iron"), 2);
  EXPECT_NE(text("err.txt").find("no wall is called \"iron\": there are copper|air"),
            std::string::npos);
}

TEST_F(Program, PointsBecomeVertices) {
  write("in.poly",
        "5 3\n0 0 0 0\n1 4 0 0\n2 0 4 0\n3 0 0 4\n4 0.5 0.625 0.75\n4\n1\n3 0 2 1\n1\n3 0 1 3\n1\n"
        "3 0 3 2\n1\n3 1 2 3\n0\n");
  write("points.txt", "x y z\n1,1,1\n9 9 9\n");
  EXPECT_EQ(run("in.poly -o mesh.mesh --points points.txt --stats stats.json"), 0);
  for (const char* line : {"\n1 1 1 0\n", "\n0.5 0.625 0.75 0\n"}) {
    EXPECT_NE(text("mesh.mesh").find(line), std::string::npos) << text("mesh.mesh");
  }
  EXPECT_NE(text("err.txt").find("1 point left out: outside of the mesh"), std::string::npos);
  EXPECT_NE(text("stats.json").find("\"points\": \"points.txt\""), std::string::npos);
  EXPECT_EQ(run("in.poly -o mesh.mesh --points none.txt"), 3);
}

// Corners that chamfering took off come back unrefined, the apex of a steep pyramid: their edges
// are halved, but not on a surface that is kept.
TEST_F(Program, EdgesThatAreTooLongAreHalvedOrSaid) {
  write("in.off",
        "OFF\n5 6 0\n-2 -2 0\n2 -2 0\n2 2 0\n-2 2 0\n0 0 12\n3 0 2 1\n3 0 3 2\n3 0 1 4\n3 1 2 4\n"
        "3 2 3 4\n3 3 0 4\n");
  for (const char* bound : {"0.5", "20"}) {
    EXPECT_EQ(run(std::string("in.off -o mesh.mesh --max-edge ") + bound), 0);
    EXPECT_EQ(text("err.txt").find("--max-edge"), std::string::npos) << text("err.txt");
  }
  write("sizes.txt", "0 0 12 0.3\n");
  EXPECT_EQ(run("in.off -o mesh.mesh --surface keep --size-field sizes.txt"), 0);
  EXPECT_NE(text("err.txt").find(" of the surface as given are longer than --size-field allows"),
            std::string::npos)
      << text("err.txt");
}

// A prism over a triangle with an angle of a degree: its facets meet at that, two of them have such
// a corner, and faces across the edge have no larger angles there.
TEST_F(Program, AnglesThatTheInputForcesAreSaid) {
  write("in.off",
        "OFF\n6 8 0\n0 0 0\n1 0 0\n1 0.0174550649 0\n0 0 1\n1 0 1\n1 0.0174550649 1\n"
        "3 0 2 1\n3 3 4 5\n3 0 1 4\n3 0 4 3\n3 1 2 5\n3 1 5 4\n3 2 0 3\n3 2 3 5\n");
  EXPECT_EQ(run("in.off -o mesh.mesh -v --size none"), 0);
  EXPECT_NE(text("err.txt").find("in.off: the surface is kept; bounded angles"), std::string::npos);
  EXPECT_EQ(run("in.off -o mesh.mesh --surface split"), 0);
  const std::string said = text("err.txt");
  EXPECT_NE(said.find("delmesher: in.off: warning: the smallest face angle is "),
            std::string::npos);
  EXPECT_EQ(said.find("asked for"), std::string::npos) << said;
  EXPECT_NE(said.find("where facets of the input meet at 1.00\n"), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 3) << said;
  EXPECT_EQ(run("cdt in.off -o mesh.mesh"), 0);
  const std::string cdt = text("err.txt");
  EXPECT_TRUE(cdt.starts_with("mesh.mesh: ")) << cdt;
  EXPECT_EQ(std::count(cdt.begin(), cdt.end(), '\n'), 1) << cdt;
}

TEST_F(Program, AnyMeshIsImproved) {
  write("in.off", cube());
  EXPECT_EQ(run("in.off -o given.msh --improve off --max-edge 0.3 -q"), 0);
  EXPECT_EQ(run("improve given.msh -o better.mesh -o better.node"), 0);
  const std::string said = text("err.txt");
  EXPECT_TRUE(said.starts_with("better.mesh, better.node: ")) << said;
  EXPECT_NE(said.find("; before: "), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  // What is read, and written unchanged elsewhere, ends with the same bytes.
  EXPECT_EQ(run("improve better.ele -o again.mesh -q"), 0);
  EXPECT_EQ(run("improve better.mesh -o twice.mesh -q"), 0);
  EXPECT_EQ(text("again.mesh"), text("twice.mesh"));
  EXPECT_EQ(text("out.txt") + text("err.txt"), "");
}

TEST_F(Program, ALossOfRegionsIsSaid) {
  const std::string mesh =
      "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
      "1 1 1 0\nTetrahedra\n2\n1 2 3 4 1\n2 3 4 5 ";
  const std::string lost = "warning: mesh.tet has no place for the regions, which are lost there";
  write("in.mesh", mesh + "7\nEnd\n");
  EXPECT_EQ(run("improve in.mesh -o mesh.tet -o mesh.vtu"), 0);
  EXPECT_NE(text("err.txt").find(lost), std::string::npos) << text("err.txt");
  EXPECT_EQ(run("improve in.mesh -o mesh.vtu"), 0);
  EXPECT_EQ(text("err.txt").find("regions"), std::string::npos) << text("err.txt");
  write("in.mesh", mesh + "1\nEnd\n");
  EXPECT_EQ(run("improve in.mesh -o mesh.tet"), 0);
  EXPECT_EQ(text("err.txt").find("regions"), std::string::npos) << text("err.txt");
}

TEST_F(Program, MeshesThatCannotBeImprovedEndWithTheirCodeAndOneLine) {
  const std::string tet = "5 vertices\n2 tets\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n4 0 1 2 3\n";
  write("in.tet", tet + "4 1 2 3 4\n");
  EXPECT_EQ(run("improve in.tet -o mesh.vtu"), 0);
  fs::remove(path("mesh.vtu"));
  write("in.tet", tet + "4 2 1 3 4\n");
  EXPECT_EQ(run("improve in.tet -o mesh.vtu --stats stats.json"), 4);
  expect_error("in.tet", "tetrahedra 0 and 1 are of opposite orientation");
  write("in.tet", tet + "4 1 2 3 9\n");
  EXPECT_EQ(run("improve in.tet -o mesh.vtu"), 3);
  expect_error("in.tet", "in.tet:9: vertex index out of range");
  EXPECT_EQ(run("improve no.tet -o mesh.vtu"), 3);
  write("in.off", cube());
  EXPECT_EQ(run("in.off -o given.tet -q --max-edge 0.1 --improve off"), 0);
  EXPECT_EQ(run("improve given.tet -o mesh.vtu --max-vertices 10"), 5);
  EXPECT_EQ(text("mesh.vtu"), "");
}

TEST_F(Program, InThePlaneTheLineTellsOfTriangles) {
  write("in.txt", "0 0\n1 0\n1 1\n0 1\n");
  EXPECT_EQ(run("plane in.txt -o mesh.off"), 0);
  const std::string said = text("err.txt");
  EXPECT_TRUE(said.starts_with("mesh.off: 4 vertices, 2 triangles in ")) << said;
  EXPECT_TRUE(
      said.ends_with(" s; angles 45.00 to 90.00 degrees, the smallest at (1, 0); mean of "
                     "the smallest 45.00\n"))
      << said;
  EXPECT_EQ(run("plane in.txt -o mesh.off -q"), 0);
  EXPECT_EQ(text("err.txt"), "");
}

TEST_F(Program, MissingAndUnwritableFilesAreSaid) {
  write("in.off", cube());
  EXPECT_EQ(run("mesh in.none.off -o mesh.mesh"), 3);
  expect_error("in.none.off", "");
  EXPECT_EQ(run("mesh . -o mesh.mesh"), 3);
  expect_error(".", "");
  EXPECT_EQ(run("mesh in.off -o in.off/mesh.mesh"), 3);
  expect_error("in.off/mesh.mesh", "Not a directory");
  expect_no_output();
}

// A cube with edges this short would take hours.
constexpr const char* kEndless = "mesh in.off -o mesh.mesh --stats stats.json --max-edge 0.002";

TEST_F(Program, LimitsAreFive) {
  write("in.off", cube());
  EXPECT_EQ(run(std::string(kEndless) + " --time-limit 0.3"), 5);
  expect_error("in.off", "time");
  EXPECT_EQ(run(std::string(kEndless) + " --max-vertices 5000"), 5);
  expect_error("in.off", "vertices");
  expect_no_output();
}

// Faces of so many corners that reading takes seconds.
std::string combs() {
  constexpr int kFaces = 200, kCorners = 19998;
  std::string off = "OFF\n" + std::to_string(kCorners) + " " + std::to_string(kFaces) + " 0\n";
  std::string face = std::to_string(kCorners);
  for (int i = 0; i < kCorners; ++i) {
    off += std::to_string(i % 2 == 0 ? 0 : i) + " " + std::to_string(i) + " 0\n";
    face += " " + std::to_string(i);
  }
  for (int i = 0; i < kFaces; ++i) off += face + "\n";
  return off;
}

TEST_F(Program, TimeLimitHoldsWhileReading) {
  write("in.off", combs());
  EXPECT_EQ(run("mesh in.off -o mesh.mesh --time-limit 0.1"), 5);
  expect_error("in.off", "time limit reached while reading");
  EXPECT_EQ(run("plane in.off -o mesh.off --time-limit 0.1"), 5);
  expect_error("in.off", "time limit reached while reading");
  expect_no_output();
}

// A ball with spikes, as a graph over the sphere: acute corners, and many facets that are close.
std::string spiky_ball() {
  constexpr int kRings = 14, kSlices = 24;
  std::ostringstream off;
  off.precision(17);
  off << "OFF\n" << kRings * kSlices + 2 << " " << 2 * kRings * kSlices << " 0\n0 0 1\n0 0 -1\n";
  for (int r = 0; r < kRings; ++r) {
    for (int s = 0; s < kSlices; ++s) {
      const double polar = 3.14159 * (r + 1) / (kRings + 1), around = 6.28318 * s / kSlices;
      const double radius = 1 + 0.1 * ((7 * r + 13 * s) % 8);
      off << radius * std::sin(polar) * std::cos(around) << " "
          << radius * std::sin(polar) * std::sin(around) << " " << radius * std::cos(polar) << "\n";
    }
  }
  const auto at = [](int r, int s) { return 2 + r * kSlices + s % kSlices; };
  for (int s = 0; s < kSlices; ++s) {
    off << "3 0 " << at(0, s) << " " << at(0, s + 1) << "\n";
    off << "3 1 " << at(kRings - 1, s + 1) << " " << at(kRings - 1, s) << "\n";
    for (int r = 0; r + 1 < kRings; ++r) {
      off << "3 " << at(r, s) << " " << at(r + 1, s) << " " << at(r + 1, s + 1) << "\n";
      off << "3 " << at(r, s) << " " << at(r + 1, s + 1) << " " << at(r, s + 1) << "\n";
    }
  }
  return off.str();
}

TEST_F(Program, LackOfMemoryIsFive) {
  write("in.off", spiky_ball());
  const auto limit_to = [](int kibibytes) {
    return "ulimit -v " + std::to_string(kibibytes) + " && ";
  };
  // With less it does not even start; sanitizers take more than any of these.
  int least = 6 << 10;
  while (least < 40 << 10 && run("--version", limit_to(least)) != 0) least += 256;
  if (least >= 40 << 10) GTEST_SKIP() << "does not start with 40 MiB of addresses";
  int ended = 0;
  for (const int more : {0, 256, 1 << 10, 2 << 10, 4 << 10, 8 << 10}) {
    const int kibibytes = least + more;
    const std::string limit = limit_to(kibibytes);
    for (const char* job : {"mesh in.off -o mesh.vtu --exact exact -q",
                            "cdt in.off -o mesh.vtu -o mesh.tet -q", "check in.off"}) {
      const int code = run(job, limit);
      if (code == 0) {
        EXPECT_EQ(text("err.txt"), "");
        for (const char* name : {"mesh.vtu", "mesh.tet", "exact"}) fs::remove(path(name));
        continue;
      }
      EXPECT_EQ(code, 5) << job << " with " << kibibytes << " KiB";
      const std::string said = text("err.txt");
      EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
      EXPECT_NE(said.find("out of memory"), std::string::npos) << said;
      expect_no_output();
      ++ended;
    }
  }
  EXPECT_GT(ended, 0);
}

// The lines of statistics that are the same for every run.
std::string lasting(const std::string& statistics) {
  std::istringstream in(statistics);
  std::string line, all;
  for (bool in_phases = false; std::getline(in, line);) {
    const auto has = [&](const char* key) { return line.find(key) != std::string::npos; };
    in_phases = has("\"phases_seconds\"") || (in_phases && !has("}"));
    if (in_phases || has("_seconds\"") || has("\"peak_rss_bytes\"") || has("\"threads\"")) continue;
    all += line + "\n";
  }
  return all;
}

// Numbers of a key of the statistics that occurs once.
double number_of(const std::string& statistics, const std::string& key) {
  const std::size_t at = statistics.find("\"" + key + "\": ");
  EXPECT_NE(at, std::string::npos) << key;
  return at == std::string::npos ? 0 : std::strtod(&statistics[at + key.size() + 4], nullptr);
}

TEST_F(Program, AnyNumberOfThreadsWritesTheSameBytes) {
  write("in.off", spiky_ball());
  for (const char* options :
       {"--tau 0.03 --acute 80 --max-edge 0.3", "--preset paper --tau 0.004"}) {
    std::string mesh, exact, statistics;
    for (const int threads : {1, 2, 3, 8}) {
      ASSERT_EQ(run("mesh in.off -o mesh.mesh --exact exact.txt --stats stats.json --threads " +
                    std::to_string(threads) + " " + options),
                0)
          << text("err.txt");
      EXPECT_EQ(number_of(text("stats.json"), "threads"), threads);
      if (threads == 1) {
        mesh = text("mesh.mesh");
        exact = text("exact.txt");
        statistics = lasting(text("stats.json"));
        // Enough for several threads to have something to do in every shared loop.
        EXPECT_GT(number_of(statistics, "dropped_triangles"), 0);
        EXPECT_GT(number_of(statistics, "acute_vertices"), 10);
        EXPECT_GT(std::count(mesh.begin(), mesh.end(), '\n'), 10000);
        EXPECT_NE(statistics.find("\"mean_min_face_angle\""), std::string::npos);
      }
      EXPECT_TRUE(text("mesh.mesh") == mesh) << threads << " threads, " << options;
      EXPECT_TRUE(text("exact.txt") == exact) << threads << " threads, " << options;
      EXPECT_EQ(lasting(text("stats.json")), statistics) << threads << " threads, " << options;
    }
  }
}

TEST_F(Program, SizesStandInAFile) {
  write("in.off", cube());
  write("in.sizes", "0 0 0 0.05\n");
  ASSERT_EQ(run("mesh in.off -q -o coarse.tet --size none"), 0);
  ASSERT_EQ(run("mesh in.off -q -o fine.tet --size-field in.sizes"), 0) << text("err.txt");
  EXPECT_GT(text("fine.tet").size(), 10 * text("coarse.tet").size());
  write("in.sizes", "0 0 0 0.05\n0 0 1 -1\n");
  EXPECT_EQ(run("mesh in.off -o no.tet --size-field in.sizes"), 3);
  EXPECT_EQ(text("err.txt"), "delmesher: in.sizes:2: sizes have to be above 0\n");
  EXPECT_FALSE(fs::exists(path("no.tet")));
}

// A needle of 6 degrees: its sharp vertex is cut off, all else is on the faces that were given.
TEST_F(Program, SavesTheChamferedSurface) {
  write("in.off",
        "OFF\n4 4 0\n0 0 0\n10 0 0\n10 1 0\n10 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  EXPECT_EQ(run("mesh in.off -o mesh.vtu --save-chamfered chamfered.off"), 0);
  std::istringstream chamfered(text("chamfered.off"));
  std::string head;
  std::size_t vertices = 0, triangles = 0, edges = 0;
  chamfered >> head >> vertices >> triangles >> edges;
  EXPECT_EQ(head, "OFF");
  ASSERT_GT(vertices, 4U);
  ASSERT_GT(triangles, 4U);
  for (std::size_t n = 0; n < vertices; ++n) {
    double x = 0, y = 0, z = 0;
    ASSERT_TRUE(chamfered >> x >> y >> z);
    EXPECT_GT(x, 0.1);
    EXPECT_LT(std::min({std::fabs(y), std::fabs(z), std::fabs(x - 10), std::fabs(x / 10 - y - z)}),
              1e-14)
        << x << ' ' << y << ' ' << z;
  }
}

TEST_F(Program, AGraphHasNoCornersOfASurface) {
  write("in.poly", "3 2 0 0\n1 0 0\n2 10 0\n3 10 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n");
  for (const std::string option : {"--acute 3", "--corner 3", "--planar 0"}) {
    EXPECT_EQ(run("check in.poly " + option), 2);
    EXPECT_NE(text("err.txt").find(option.substr(0, option.find(' ')) +
                                   ": of no effect on a planar graph"),
              std::string::npos)
        << text("err.txt");
  }
  EXPECT_EQ(run("check in.poly --acute 60"), 0);
}

TEST_F(Program, SavesTheChamferedGraph) {
  write("in.poly", "3 2 0 0\n1 0 0\n2 10 0\n3 10 1\n3 1\n1 1 2 5\n2 2 3 6\n3 3 1 7\n1\n1 9 0.5\n");
  EXPECT_EQ(run("plane in.poly -o mesh.off --save-chamfered chamfered.poly"), 4);  // all is a hole
  EXPECT_FALSE(fs::exists(path("chamfered.poly")));
  write("in.poly", replaced(text("in.poly"), "1\n1 9 0.5\n", "0\n"));
  EXPECT_EQ(run("plane in.poly -o mesh.off --save-chamfered chamfered.poly"), 0);
  std::istringstream chamfered(text("chamfered.poly"));
  std::size_t vertices = 0, segments = 0, number = 0, a = 0, b = 0;
  int zero = 0, marker = 0;
  double x = 0, y = 0;
  chamfered >> vertices >> number >> zero >> zero;
  ASSERT_EQ(vertices, 4U);
  for (std::size_t n = 0; n < vertices; ++n) {
    ASSERT_TRUE(chamfered >> number >> x >> y);
    EXPECT_GT(x, 1);
    EXPECT_LT(std::min({std::fabs(y), std::fabs(x - 10), std::fabs(x / 10 - y)}), 1e-14);
  }
  chamfered >> segments >> marker;
  ASSERT_EQ(segments, 3U);
  std::string markers;
  for (std::size_t n = 0; n < segments; ++n) {
    ASSERT_TRUE(chamfered >> number >> a >> b >> marker);
    markers += std::to_string(marker);
  }
  std::sort(markers.begin(), markers.end());
  EXPECT_EQ(markers, "567");
}

TEST_F(Program, NamesOfLabelsThatAreNotThereAreSaid) {
  write("in.off", cube());
  write("in.names", "0 all\n4 inlet\n9 outlet\n");
  EXPECT_EQ(run("in.off -o mesh.tet --names in.names"), 0);
  EXPECT_NE(text("err.txt").find("warning: in.names: no triangle has label 4, 9\n"),
            std::string::npos)
      << text("err.txt");
  write("in.names", "0 all\n");
  EXPECT_EQ(run("in.off -o mesh.tet --names in.names"), 0);
  EXPECT_EQ(text("err.txt").find("warning: in.names"), std::string::npos);
}

// A file from a pipe to a pipe is the same as from a file to a file.
TEST_F(Program, StandardInputAndOutput) {
  write("in.off", cube());
  ASSERT_EQ(run("in.off -o mesh.vtu -q"), 0) << text("err.txt");
  ASSERT_EQ(run("- -o -.vtu -q < in.off"), 0) << text("err.txt");
  EXPECT_EQ(text("out.txt"), text("mesh.vtu"));
  EXPECT_EQ(run("- -o -.vtu -q", "cat in.off |"), 0) << text("err.txt");
  EXPECT_EQ(text("out.txt"), text("mesh.vtu"));
  EXPECT_EQ(run("check - --json < in.off"), 0) << text("err.txt");
  EXPECT_EQ(run("check -", "echo nothing |"), 3);
  expect_error("-", "not a known format");
  EXPECT_FALSE(fs::exists(path("-.vtu")));
  EXPECT_EQ(run("check - < /dev/null"), 3);
  expect_error("-", "the file is empty");
  EXPECT_EQ(run("check mesh.vtu"), 3);
  expect_error("mesh.vtu", "a mesh, not a surface");
}

#ifdef DELMESHER_ZLIB
// Known by its first bytes, whatever it is called; of two files one after the other.
TEST_F(Program, GzipIsUnpacked) {
  write("in.off", cube());
  ASSERT_EQ(run("in.off -o mesh.tet -q"), 0);
  const std::string plain = text("mesh.tet");
  const auto sh = [&](const std::string& command) {
    return std::system(("cd " + path("") + " && " + command).c_str());
  };
  ASSERT_EQ(sh("gzip -c in.off > in.off.gz && cp in.off.gz named.off && head -c 40 in.off | gzip > "
               "two.off.gz && "
               "tail -c +41 in.off | gzip >> two.off.gz && head -c 60 in.off.gz > cut.off.gz && "
               "(cat in.off.gz; echo x) > more.off.gz"),
            0);
  for (const char* name : {"in.off.gz", "named.off", "two.off.gz"}) {
    fs::remove(path("mesh.tet"));
    EXPECT_EQ(run(std::string(name) + " -o mesh.tet -q"), 0) << text("err.txt");
    EXPECT_EQ(text("mesh.tet"), plain);
  }
  EXPECT_EQ(run("- -o mesh.tet -q", "cat in.off.gz |"), 0) << text("err.txt");
  EXPECT_EQ(run("repair in.off.gz -o mended.off -q"), 0);
  EXPECT_EQ(run("cut.off.gz -o mesh.tet -q"), 3);
  expect_error("cut.off.gz", "byte 60: the compressed data end early");
  EXPECT_EQ(run("more.off.gz -o mesh.tet -q"), 3);
  expect_error("more.off.gz", "the compressed data are followed by something else");
}

// Of TetGen's files each may be compressed or not.
TEST_F(Program, GzipIsUnpackedForImproveAndInThePlane) {
  write("in.off", cube());
  write("in.txt", "0 0\n4 0\n1 1\n0 4\n");
  ASSERT_EQ(run("in.off -q --improve off --max-edge 0.5 -o in.msh -o in.node"), 0);
  ASSERT_EQ(run("improve in.msh -q -o better.tet"), 0) << text("err.txt");
  ASSERT_EQ(run("plane in.txt -q -o plane.node"), 0) << text("err.txt");
  ASSERT_EQ(std::system(("cd " + path("") + " && gzip in.msh in.node in.face in.txt").c_str()), 0);
  for (const char* input : {"in.msh.gz", "in.node.gz", "in.ele"}) {
    EXPECT_EQ(run(std::string("improve ") + input + " -q -o again.tet"), 0) << text("err.txt");
    EXPECT_EQ(text("again.tet"), text("better.tet")) << input;
  }
  EXPECT_EQ(run("improve - -q -o again.tet < in.msh.gz"), 0) << text("err.txt");
  EXPECT_EQ(text("again.tet"), text("better.tet"));
  EXPECT_EQ(run("improve in.ele -q -o in.node"), 2) << "would overwrite in.ele";
  EXPECT_EQ(run("plane in.txt.gz -q -o again.node"), 0) << text("err.txt");
  EXPECT_EQ(text("again.node"), text("plane.node"));
}
#else
TEST_F(Program, GzipIsRefusedWithoutZlib) {
  write("in.off", cube());
  ASSERT_EQ(std::system(("gzip " + path("in.off")).c_str()), 0);
  for (const char* command : {"", "check ", "repair ", "improve ", "plane "}) {
    const bool writes = std::string(command) != "check ";
    EXPECT_EQ(run(std::string(command) + "in.off.gz -q" + (writes ? " -o out.off" : "")), 3);
    expect_error("in.off.gz", "compressed by gzip: this build of delmesher has no zlib");
  }
}
#endif

// Its first bytes show what it is.
TEST_F(Program, ImproveReadsStandardInput) {
  write("in.off", cube());
  ASSERT_EQ(run("in.off -q --improve off --max-edge 0.5 -o in.mesh -o in.msh -o in.vtu -o in.tet"),
            0);
  ASSERT_EQ(run("improve in.mesh -q -o from_file.tet"), 0) << text("err.txt");
  for (const char* extension : {"mesh", "msh", "vtu", "tet"}) {
    const std::string file = std::string("in.") + extension;
    EXPECT_EQ(run("improve - -q -o better.tet < " + file), 0) << text("err.txt");
    EXPECT_EQ(run("improve - -q -o piped.tet", "cat " + file + " |"), 0) << text("err.txt");
    EXPECT_EQ(text("piped.tet"), text("better.tet"));
    ASSERT_EQ(run("improve " + file + " -q -o from_file.tet"), 0) << text("err.txt");
    EXPECT_EQ(text("better.tet"), text("from_file.tet")) << extension;
  }
  EXPECT_EQ(run("improve - -q -o better.tet < in.off"), 3);
  expect_error("-", "not a known mesh format");
}

TEST_F(Program, AWholeFolder) {
  write("in.a.off", cube());
  write("in.b.off", replaced(replaced(cube(), "8 12", "8 11"), "3 1 7 5\n", ""));
  write("in.c.off", cube());
  write("in.d.off", "OFF\nnothing\n");
  EXPECT_EQ(run("mesh in.a.off in.b.off -o in.a.off/{name}.tet --jobs 2"), 3);
  EXPECT_EQ(text("err.txt"), "delmesher: in.a.off/in.a.tet: cannot write: Not a directory\n")
      << "once, not for every input";
  EXPECT_EQ(run("mesh in.b.off in.d.off -o out/{name}.tet --jobs 2 -q"), 1);
  EXPECT_FALSE(fs::exists(path("out"))) << "nothing was written";
  EXPECT_EQ(run("mesh in.a.off in.b.off in.c.off -o out/{name}.tet --jobs 2 -q"), 1);
  EXPECT_EQ(text("out/in.a.tet"), text("out/in.c.tet"));
  EXPECT_FALSE(text("out/in.a.tet").empty());
  EXPECT_EQ(run("mesh in.a.off in.b.off in.c.off in.d.off -o {name}.tet --jobs 2"), 1);
  const std::string said = text("err.txt");
  for (const char* line :
       {"in.a.off: done, ", "in.b.off: not valid (exit 4), ", "in.c.off: done, ",
        "in.d.off: not readable or writable (exit 3), ",
        "2 of 4 files done, 1 not readable or writable (exit 3), 1 not valid (exit 4)\n"}) {
    EXPECT_NE(said.find(line), std::string::npos) << said;
  }
  EXPECT_TRUE(fs::exists(path("in.a.tet")));
  EXPECT_FALSE(fs::exists(path("in.b.tet")));
  EXPECT_EQ(text("in.a.tet"), text("in.c.tet"));
  EXPECT_EQ(run("mesh in.a.off in.c.off -o {name}.tet -q"), 0);
  EXPECT_EQ(text("err.txt"), "");
  EXPECT_EQ(run("mesh in.a.off in.c.off -o {name}.vtu --max-vertices 6"), 1);
  EXPECT_TRUE(text("err.txt").ends_with("0 of 2 files done, 2 limit reached (exit 5)\n"))
      << text("err.txt");
  EXPECT_EQ(run("check in.a.off in.c.off -q"), 0);
  const std::string reports = text("out.txt");
  EXPECT_NE(reports.find("in.a.off: a valid surface"), std::string::npos);
  EXPECT_NE(reports.find("in.c.off: a valid surface"), std::string::npos);
}

// Late enough for the handlers to be there on a busy machine; --foreground, because a signal to the
// process group too may arrive as a second one, which ends the program at once.
TEST_F(Program, SignalsEndIt) {
  write("in.off", cube());
  for (const auto& [signal, threads] : {std::pair("INT", "1"), std::pair("TERM", "3")}) {
    EXPECT_EQ(run(std::string(kEndless) + " --threads " + threads,
                  std::string("timeout --foreground --preserve-status -s ") + signal + " 2"),
              130);
    expect_error("in.off", "interrupted");
  }
  expect_no_output();
}

// A file that may not be so large, and a pipe that nobody reads, are files that cannot be written.
TEST_F(Program, SignalsOfWritingAreErrors) {
  write("in.off", cube());
  EXPECT_EQ(run("in.off -o mesh.mesh --max-edge 0.3", "prlimit --fsize=2000"), 3);
  EXPECT_NE(text("err.txt").find("cannot write"), std::string::npos) << text("err.txt");
  expect_no_output();
}

// Those that run end, too, and say so; no other begins.
TEST_F(Program, ASignalEndsAWholeFolder) {
  write("in.off", cube());
  write("in.2.off", cube());
  write("in.3.off", cube());
  EXPECT_EQ(run("mesh in.off in.2.off in.3.off -o out/{name}.mesh --max-edge 0.002 --jobs 2",
                "timeout --foreground --preserve-status -s TERM 2"),
            130);
  const std::string said = text("err.txt");
  EXPECT_NE(said.find("delmesher: in.off: interrupted\n"), std::string::npos) << said;
  EXPECT_NE(said.find("delmesher: in.2.off: interrupted\n"), std::string::npos) << said;
  EXPECT_NE(said.find("0 of 3 files done, 2 interrupted (exit 130), 1 not begun\n"),
            std::string::npos)
      << said;
  expect_no_output();
}

// A run of a second or more, which the signal reaches in its middle.
TEST_F(Program, AnIgnoredSignalDoesNotEndIt) {
  write("in.off", cube());
  EXPECT_EQ(run("mesh in.off -o mesh.tet --max-edge 0.05 -q",
                "timeout --foreground --preserve-status -s INT 0.3 env --ignore-signal=INT"),
            0)
      << text("err.txt");
  EXPECT_TRUE(fs::exists(path("mesh.tet")));
}

}  // namespace
}  // namespace delmesher::cli
