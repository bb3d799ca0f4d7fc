// Readers and writers of the plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "mesher/io/read_plane.h"
#include "mesher/io/write_plane.h"

namespace delmesher::io {
namespace {

PlaneReadResult parse(const std::string& text, const std::string& path) {
  return parse_plane(text, path);
}

std::string error_of(const std::string& text, const std::string& path = "f.poly") {
  const PlaneReadResult result = parse(text, path);
  EXPECT_FALSE(result.ok());
  return result.error;
}

constexpr const char* kPoly =
    "# a square with a hole\n8 2 1 0\n1 0 0 7\n2 4 0 7\n3 4 4 7\n4 0 4 7\n"
    "5 1 1 7\n6 3,1 7\n7 3 3 7\n8 1 3 7\n"
    "8 1\n1 1 2 5\n2 2 3 5\n3 3 4 5\n4 4 1 5\n5 5 6 9\n6 6 7 9\n7 7 8 9\n8 8 5 9\n"
    "1\n1 2 2\n1\n1 0.5 0.5 3 0.1\n";

TEST(ReadPlane, TrianglePoly) {
  const PlaneReadResult result = parse(kPoly, "f.poly");
  ASSERT_TRUE(result.ok()) << result.error;
  EXPECT_EQ(result.graph.insideness, Insideness::enclosed);
  EXPECT_EQ(result.graph.vertices.size(), 8U);
  EXPECT_EQ(result.graph.vertices[5], (std::array<double, 2>{3, 1}));
  EXPECT_EQ(result.graph.segments[7], (std::array<std::uint32_t, 2>{7, 4}));
  EXPECT_EQ(result.graph.markers[4], 9);
  ASSERT_EQ(result.graph.holes.size(), 1U);
  ASSERT_EQ(result.graph.regions.size(), 1U);
  EXPECT_EQ(result.graph.regions[0].attribute, 3);
  EXPECT_EQ(result.warnings.size(), 1U);  // the area
}

TEST(ReadPlane, NodeFileBesidePoly) {
  const auto node = [] { return std::optional<std::string>("3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n"); };
  const PlaneReadResult result =
      parse_plane("0 2 0 0\n3 0\n0 0 1\n1 1 2\n2 2 0\n0\n", "f.poly", node);
  ASSERT_TRUE(result.ok()) << result.error;
  EXPECT_EQ(result.graph.vertices.size(), 3U);
  EXPECT_NE(error_of("0 2 0 0\n0\n").find("no .node"), std::string::npos);
  const auto bad = [] { return std::optional<std::string>("2 2 0 0\n0 0 0\n1 1 x\n"); };
  EXPECT_EQ(parse_plane("0 2 0 0\n1 0\n0 0 1\n0\n", "f.poly", bad).error,
            "f.poly:1: in the .node file, line 3: bad number 'x'");
}

TEST(ReadPlane, ErrorsNameTheLine) {
  EXPECT_EQ(error_of("2 2\n1 0 0\n2 x 0\n"), "f.poly:3: bad number 'x'");
  EXPECT_EQ(error_of("1 3\n1 0 0 0\n"), "f.poly:1: vertices of dimension 3, the plane has 2");
  EXPECT_EQ(error_of("1 2\n1 0 inf\n0\n"), "f.poly:2: non-finite number 'inf'");
  EXPECT_NE(error_of("1 2\n1 0 0\n1\n1 1 2\n").find("f.poly:4: vertex index out of range: 2 of 1"),
            std::string::npos);
  EXPECT_NE(error_of("99999999999 2\n").find("too short"), std::string::npos);
  EXPECT_NE(error_of("2 2\n1 0 0\n").find("file ends"), std::string::npos);
  EXPECT_NE(error_of("", "f.txt").find("no points"), std::string::npos);
  EXPECT_EQ(error_of("0 0\n1\n", "f.txt"), "f.txt:2: y is missing");
  EXPECT_EQ(error_of("0 0\n1 two\n", "f.txt"), "f.txt:2: bad number 'two'");
  EXPECT_NE(error_of("solid\nendsolid\n", "f.STL").find("f.STL:1: a surface: a planar graph is"),
            std::string::npos);
}

TEST(ReadPlane, PolygonsShareBorders) {
  const PlaneReadResult result = parse(
      "0 0\n1 0\n1 1\n0 1\n0 0\n\n> second\n1,0\n2,0\n2,1\n1,1\n\n0.2 0.2\n0.8 0.2\n", "f.txt");
  ASSERT_TRUE(result.ok()) << result.error;
  const PlanarGraph& graph = result.graph;
  EXPECT_EQ(graph.insideness, Insideness::nested);
  EXPECT_EQ(graph.vertices.size(), 8U);
  ASSERT_EQ(graph.segments.size(), 8U);  // seven edges of two squares, and one loose segment
  EXPECT_EQ(graph.segments[1], (std::array<std::uint32_t, 2>{1, 2}));
  EXPECT_EQ(graph.partitions[1], 1);
  EXPECT_EQ(std::count(graph.partitions.begin(), graph.partitions.end(), 1), 1);
}

TEST(ReadPlane, FlatSurfaces) {
  const PlaneReadResult off =
      parse("OFF\n4 1 0\n0 0 0\n1 0 -0\n1 1 0\n0 1 0\n4 0 1 2 3\n", "f.off");
  ASSERT_TRUE(off.ok()) << off.error;
  EXPECT_EQ(off.graph.segments.size(), 4U);  // the diagonal is not a segment
  const PlaneReadResult obj =
      parse("v 0 0\nv 1 0\nv 1 1\nv 0 1\ng a\nf 1 2 3\ng b\nf 1 3 4\n", "f.obj");
  ASSERT_TRUE(obj.ok()) << obj.error;
  EXPECT_EQ(obj.graph.segments.size(), 5U);  // but it is where labels change
  EXPECT_NE(error_of("OFF\n3 1 0\n0 0 0\n1 0 1\n1 1 0\n3 0 1 2\n", "f.off").find("vertex 1"),
            std::string::npos);
  const char* overlapping = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n.2 .2 0\n3 0 1 2\n3 0 1 3\n";
  EXPECT_EQ(error_of(overlapping, "f.off"), "f.off: triangles 0 and 1 overlap");
  EXPECT_EQ(error_of("OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n1 1 0\n3 0 1 2\n3 1 0 3\n3 0 1 4\n",
                     "f.off"),
            "f.off: edge 0-1 has 3 triangles");
}

TEST(ReadPlane, PolylinesOfObj) {
  // A ring and one in it, as a drawing program exports them; vertices may come later.
  const PlaneReadResult rings = parse(
      "o drawing\nv 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nl 1 2 3 4 1\nl 5 6 7\nl 7/1 -5\n"
      "v 3 3 0\nv 6 3 0\nv 3 6 0\n",
      "f.obj");
  EXPECT_EQ(rings.error, "f.obj:8: vertex index out of range: -5");  // of the four before it
  const PlaneReadResult good = parse(
      "v 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nl 1 2 3 4 1\nl 5 6 \\\n7\nl 2 1\n"
      "v 3 3 0\nv 6 3 0\nv 3 6 0\nl 7/1 -3/2\n",
      "f.obj");
  ASSERT_TRUE(good.ok()) << good.error;
  EXPECT_EQ(good.graph.insideness, Insideness::nested);
  EXPECT_EQ(good.graph.vertices.size(), 7U);
  EXPECT_EQ(good.graph.segments.size(), 7U);  // 2-1 is there already
  EXPECT_EQ(std::count(good.graph.partitions.begin(), good.graph.partitions.end(), 1), 0);
  EXPECT_TRUE(good.warnings.empty());
  // Beside faces they only divide.
  const PlaneReadResult divided =
      parse("v 0 0\nv 1 0\nv 1 1\nv 0 1\nf 1 2 3 4\nl 1 3\nl 1 2\n", "f.obj");
  ASSERT_TRUE(divided.ok()) << divided.error;
  EXPECT_EQ(divided.graph.segments.size(), 5U);
  EXPECT_EQ(divided.graph.partitions, (std::vector<std::uint8_t>{0, 0, 0, 0, 1}));
  EXPECT_EQ(error_of("v 0 0\nv 1 0\nl 1\n", "f.obj"),
            "f.obj:3: a line needs at least 2 vertices, this one has 1");
  EXPECT_EQ(error_of("v 0 0\nv 1 0\nl\n", "f.obj"),
            "f.obj:3: a line needs at least 2 vertices, this one has 0");
  EXPECT_EQ(error_of("v 0 0\nv 1 0\nl 1 2 2\n", "f.obj"),
            "f.obj:3: a line from vertex 2 to itself");
  EXPECT_EQ(error_of("v 0 0\nv 1 0\nl 1 3\n", "f.obj"),
            "f.obj:3: vertex index out of range: 3 of 2");
  EXPECT_EQ(error_of("v 0 0\nl 1 x\n", "f.obj"), "f.obj:2: bad corner 'x'");
  EXPECT_EQ(error_of("v 0 0 1\nv 1 0\nl 1 2\n", "f.obj"),
            "f.obj: vertex 0 is not in the plane z = 0");
  EXPECT_EQ(error_of("v 0 0\nv 1 0\n", "f.obj"), "f.obj: no faces");
}

TEST(ReadPlane, SaysWhatItIgnores) {
  const PlaneReadResult columns = parse("0 0 7\n1 0 7\n1 1 7\n", "f.txt");
  ASSERT_EQ(columns.warnings.size(), 1U);
  EXPECT_EQ(columns.warnings[0], "columns after x and y ignored");
  EXPECT_TRUE(parse("0 0 # a comment\n1 0\n1 1 \n", "f.txt").warnings.empty());
}

PlaneMesh two_triangles() {
  PlaneMesh mesh;
  mesh.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 0.1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.inside = {1, 1};
  mesh.edges = {{0, 1}, {1, 2}};
  mesh.edge_markers = {3, 4};
  mesh.edge_segments = {0, 1};
  return mesh;
}

std::string read_text(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class WritePlane : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("write_plane_") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string written(const PlaneMesh& mesh, const std::string& name, bool ascii = true) {
    OutputSet outputs;
    const WriteStatus status =
        write_plane(outputs, (folder_ / name).string(), mesh, nullptr, {.ascii = ascii});
    EXPECT_TRUE(status.ok()) << status.error;
    EXPECT_FALSE(std::filesystem::exists(folder_ / name));  // not before
    EXPECT_TRUE(outputs.commit().ok());
    return read_text(folder_ / name);
  }
  std::filesystem::path folder_;
};

TEST_F(WritePlane, TriangleFilesComeBack) {
  const std::string node = written(two_triangles(), "m.node");
  EXPECT_EQ(node, "4 2 0 0\n0 0 0\n1 1 0\n2 1 1\n3 0 0.1\n");
  EXPECT_EQ(read_text(folder_ / "m.ele"), "2 3 0\n0 0 1 2 \n1 0 2 3 \n");
  const PlaneReadResult back = read_plane((folder_ / "m.poly").string());
  ASSERT_TRUE(back.ok()) << back.error;
  EXPECT_EQ(back.graph.vertices, two_triangles().vertices);
  EXPECT_EQ(back.graph.markers, two_triangles().edge_markers);
  PlaneMesh regions = two_triangles();
  regions.attributes = {7, 2.5};
  written(regions, "r.node");
  EXPECT_EQ(read_text(folder_ / "r.ele"), "2 3 1\n0 0 1 2 7\n1 0 2 3 2.5\n");
  PlaneMesh sides = two_triangles();
  sides.inside = {1, 0};
  written(sides, "s.node");
  EXPECT_EQ(read_text(folder_ / "s.ele"), "2 3 1\n0 0 1 2 1\n1 0 2 3 2\n");
}

TEST_F(WritePlane, PolyKeepsHolesAndRegions) {
  PlanarGraph graph;
  graph.holes = {{0.5, 0.25}};
  graph.regions = {{{0.25, 0.5}, 7}};
  OutputSet outputs;
  ASSERT_TRUE(write_plane(outputs, (folder_ / "h.node").string(), two_triangles(), &graph).ok());
  ASSERT_TRUE(outputs.commit().ok());
  const PlaneReadResult back = read_plane((folder_ / "h.poly").string());
  ASSERT_TRUE(back.ok()) << back.error;
  EXPECT_EQ(back.graph.holes, graph.holes);
  ASSERT_EQ(back.graph.regions.size(), 1U);
  EXPECT_EQ(back.graph.regions[0].attribute, 7);
}

TEST_F(WritePlane, OtherFormats) {
  EXPECT_EQ(written(two_triangles(), "m.off"),
            "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 0.1 0\n3 0 1 2\n3 0 2 3\n");
  const std::string svg = written(two_triangles(), "m.svg");
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_NE(svg.find("hsl("), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  const std::string vtu = written(two_triangles(), "m.vtu");
  EXPECT_NE(vtu.find("NumberOfCells=\"4\""), std::string::npos);
  const std::string gmsh = written(two_triangles(), "m.msh");
  EXPECT_NE(gmsh.find("$Elements\n3 4 1 4\n"), std::string::npos);
  EXPECT_NE(gmsh.find("1 3 \"marker 3\""), std::string::npos);
  // As bytes: the version says so, and a node is its number of 8 bytes.
  const std::string bytes = written(two_triangles(), "b.msh", false);
  EXPECT_NE(bytes.find(std::string("\n4.1 1 8\n\1\0\0\0\n", 14)), std::string::npos);
  EXPECT_NE(bytes.find(std::string("\4\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0", 16)), std::string::npos);
  EXPECT_NE(written(two_triangles(), "b.vtu", false).find("format=\"binary\""), std::string::npos);
  EXPECT_EQ(vtu.find("format=\"binary\""), std::string::npos);
  OutputSet outputs;
  PlaneMesh bad = two_triangles();
  bad.triangles[0][0] = 9;
  EXPECT_FALSE(write_plane(outputs, (folder_ / "b.off").string(), bad).ok());
  EXPECT_FALSE(write_plane(outputs, (folder_ / "b.xyz").string(), two_triangles()).ok());
}

TEST_F(WritePlane, GraphsComeBack) {
  const PlanarGraph graph = parse(kPoly, "f.poly").graph;
  OutputSet outputs;
  ASSERT_TRUE(write_poly(outputs, (folder_ / "g.poly").string(), graph).ok());
  ASSERT_TRUE(outputs.commit().ok());
  const PlaneReadResult back = read_plane((folder_ / "g.poly").string());
  ASSERT_TRUE(back.ok()) << back.error;
  EXPECT_EQ(back.graph.vertices, graph.vertices);
  EXPECT_EQ(back.graph.segments, graph.segments);
  EXPECT_EQ(back.graph.markers, graph.markers);
  EXPECT_EQ(back.graph.holes, graph.holes);
  EXPECT_EQ(back.graph.regions[0].attribute, graph.regions[0].attribute);
}

TEST_F(WritePlane, AFullDiskIsSaid) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
  PlaneMesh mesh = two_triangles();
  mesh.vertices.resize(200000);  // more than is buffered
  OutputSet outputs;
  std::filesystem::create_symlink("/dev/full", folder_ / "full.off");
  const std::string path = (folder_ / "full.off").string();
  ASSERT_TRUE(write_plane(outputs, path, mesh).ok());
  EXPECT_EQ(outputs.commit().error, path + ": cannot write: No space left on device");
}

}  // namespace
}  // namespace delmesher::io
