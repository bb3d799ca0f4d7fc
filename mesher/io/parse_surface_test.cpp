#include "mesher/io/parse_surface.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

#include "mesher/io/read_mesh.h"
#include "mesher/io/samples_for_test.h"

namespace delmesher::io {
namespace {

ReadResult read(const std::string& text, const std::string& name = "x.off") {
  return parse_surface(text, name);
}

void expect_error(const std::string& text, const std::string& name, const std::string& error) {
  const ReadResult result = parse_surface(text, name);
  EXPECT_EQ(result.code, ReadCode::unreadable) << text;
  EXPECT_NE(result.error.find(error), std::string::npos) << result.error << "\n  " << error;
}

// Corner coordinates, so that the order of vertices does not matter.
std::set<std::vector<std::array<double, 3>>> shape(const Surface& s) {
  std::set<std::vector<std::array<double, 3>>> out;
  for (const auto& t : s.triangles) {
    std::vector<std::array<double, 3>> corners;
    const auto least = static_cast<std::size_t>(
        std::min_element(t.begin(), t.end(),
                         [&](auto a, auto b) { return s.vertices[a] < s.vertices[b]; }) -
        t.begin());
    for (std::size_t k = 0; k < 3; ++k) corners.push_back(s.vertices[t[(least + k) % 3]]);
    out.insert(corners);
  }
  return out;
}

TEST(ReadSurface, EveryFormatGivesTheSameSolid) {
  const auto expected = shape(read(tet_off()).surface);
  ASSERT_EQ(expected.size(), 4U);
  for (const auto& [name, bytes] : tet_samples()) {
    const ReadResult result = parse_surface(bytes, name);
    ASSERT_TRUE(result.ok()) << result.error;
    EXPECT_EQ(result.surface.vertices.size(), 4U) << name;
    EXPECT_EQ(shape(result.surface), expected) << name;
  }
}

TEST(ReadSurface, FormatsWithASignatureAreKnownUnderAnyName) {
  for (const auto& [name, bytes] : tet_samples()) {
    if (name == "a.smesh" || name == "a.poly") continue;
    const ReadResult result = parse_surface(bytes, "noname");
    EXPECT_TRUE(result.ok()) << name << ": " << result.error;
  }
  EXPECT_EQ(parse_surface(tet_off(), "wrong.stl").format, "OFF");
  EXPECT_EQ(parse_surface(tet_binary_stl("solid"), "wrong.obj").format, "STL");
  EXPECT_EQ(parse_surface(tet_ply("ascii"), "wrong.off").format, "PLY");
  expect_error("hello world\n", "noname", "noname: not a known format");
  expect_error("", "noname", "noname: the file is empty");
}

TEST(ReadSurface, Labels) {
  const auto labels = [](const std::string& name, const std::string& bytes) {
    const ReadResult result = parse_surface(bytes, name);
    EXPECT_TRUE(result.ok()) << result.error;
    return result.surface.labels;
  };
  using Labels = std::vector<std::int32_t>;
  EXPECT_EQ(labels("a.off", tet_off()), Labels());
  EXPECT_EQ(labels("a.obj", tet_obj()), Labels({1, 1, 2, 2}));
  EXPECT_EQ(labels("a.stl", tet_ascii_stl(2)), Labels({1, 1, 2, 2}));
  EXPECT_EQ(labels("a.stl", tet_ascii_stl(1)), Labels());
  EXPECT_EQ(parse_surface(tet_ascii_stl(2), "a.stl").names,
            (LabelNames{{1, "part 0"}, {2, "part 1"}}));
  EXPECT_TRUE(parse_surface(tet_ascii_stl(1), "a.stl").names.empty());
  EXPECT_EQ(labels("a.stl", tet_binary_stl()), Labels());
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    EXPECT_EQ(labels("a.ply", tet_ply(format)), Labels({-1, 0, 1, 2}));
  }
  EXPECT_EQ(labels("a.smesh", tet_smesh()), Labels({-7, 5, 5, 0}));
  EXPECT_EQ(labels("a.poly", tet_poly()), Labels({-7, 5, 5, 0}));
}

TEST(ReadSurface, LineEndsAndByteOrderMarkDoNotMatter) {
  for (const auto& [name, bytes] : tet_samples()) {
    if (name.starts_with("binary") || name.starts_with("solid_b") || name.starts_with("little") ||
        name.starts_with("big")) {
      continue;
    }
    for (const char* end : {"\r\n", "\r"}) {
      std::string changed = "\xEF\xBB\xBF";
      for (char c : bytes) c == '\n' ? changed += end : changed += c == ' ' ? '\t' : c;
      changed.pop_back();
      const ReadResult result = parse_surface(changed, name);
      ASSERT_TRUE(result.ok()) << result.error;
      EXPECT_EQ(result.surface.vertices, parse_surface(bytes, name).surface.vertices) << name;
      EXPECT_EQ(result.surface.labels, parse_surface(bytes, name).surface.labels) << name;
    }
  }
}

TEST(ReadSurface, CoordinatesAreTheNearestDoubles) {
  const std::string numbers =
      "0.1 1e-310 -0.0\n1.7976931348623157e308 0.30000000000000004 1e-999\n";
  const std::string more = "9007199254740993 5e-324 -123456789.123456789\n";
  const ReadResult result = read("OFF 3 1\n" + numbers + more + "3 0 1 2");
  ASSERT_TRUE(result.ok()) << result.error;
  const auto& v = result.surface.vertices;
  EXPECT_EQ(v[0][0], 0.1);
  EXPECT_EQ(v[0][1], 1e-310);
  EXPECT_TRUE(v[0][2] == 0 && std::signbit(v[0][2]));
  EXPECT_EQ(v[1][0], std::numeric_limits<double>::max());
  EXPECT_EQ(v[1][1], 0.1 + 0.2);
  EXPECT_EQ(v[1][2], 0.0);
  EXPECT_EQ(v[2][0], 9007199254740992.0);
  EXPECT_EQ(v[2][1], std::numeric_limits<double>::denorm_min());
}

TEST(ReadOff, Variants) {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_TRUE(read("OFF\n3 1 0\n" + points + "3 0 1 2").ok());
  EXPECT_TRUE(read("OFF 3 1 0\n" + points + "3 0 1 2 255 0 0\n").ok());
  EXPECT_TRUE(read("OFF3 1 0\n" + points + "3 0 1 2\n").ok());
  EXPECT_TRUE(read("3 1 0\n" + points + "3 0 1 2\n").ok());
  EXPECT_TRUE(read("# x\n\nOFF # y\n# z\n3 1 0#\n" + points + "# faces\n3 0 1 2 # end").ok());
  const std::string coloured =
      "0 0 0 1 1 1 1\n1 0 0 .5 .5 .5 1\n0 1 0 0 0 0 1\n3 0 1 2 .5 .5 .5 1\n";
  const ReadResult coff = read("COFF\n3 1 0\n" + coloured);
  EXPECT_TRUE(coff.ok() && coff.warnings.empty()) << coff.error;
  EXPECT_TRUE(read("NOFF\n3 1 0\n0 0 0 nan 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2").ok());
  EXPECT_TRUE(read("STCNOFF\n3 1 0\n" + coloured).ok());
  EXPECT_EQ(read("OFF\n3 1 0\n" + coloured).warnings.size(), 1U);
  EXPECT_EQ(read("OFF\n3 1 0\n" + points + "3 0 1 2\nmore\n").warnings.size(), 1U);
}

TEST(ReadOff, ErrorsNameTheLine) {
  expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n", "x.off", "x.off:4: the file ends before vertex 2");
  expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "x.off", "x.off:6: the line ends");
  expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "x.off", "x.off:6: vertex index out");
  expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "x.off", "x.off:6: bad vertex index");
  expect_error("OFF\n3 1 0\n0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n", "x.off", "x.off:4: bad number 'x'");
  expect_error("OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "x.off", "x.off:4: non-finite");
  expect_error("OFF\n3 1 0\n0 0 0\n1 1e400 0\n0 1 0\n3 0 1 2\n", "x.off", "x.off:4: non-finite");
  expect_error("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "x.off", "x.off:4: vertex 1 has 2");
  expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "x.off", "x.off:6: a face needs");
  expect_error("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "x.off", "x.off: no faces");
  expect_error("OFF\n-3 1 0\n", "x.off", "x.off:2: bad number of vertices");
  expect_error("OFF BINARY\n", "x.off", "x.off:1: binary OFF");
  expect_error("4OFF\n3 1 0\n", "x.off", "not a surface in three");
  expect_error("OFF\n1000000000 1000000000 0\n0 0 0\n", "x.off", "too short for 1000000000");
  expect_error("OFF\n99999999999999999999 1 0\n0 0 0\n", "x.off", "bad number of vertices");
  expect_error("", "x.off", "x.off: the file is empty");
  std::string wide = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n20001";
  for (int n = 0; n < 20001; ++n) wide += " " + std::to_string(n % 3);
  expect_error(wide + "\n", "x.off", "x.off:6: a face with 20001 corners (the limit is 20000)");
}

TEST(ReadOff, UnusedVerticesAreKeptAndReported) {
  const ReadResult result = read("OFF\n4 1 0\n0 0 0\n9 9 9\n1 0 0\n0 1 0\n3 0 2 3\n");
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.surface.vertices.size(), 4U);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(result.warnings[0], "1 vertex used by no face (the first is number 1, counted from 0)");
}

TEST(ReadOff, PolygonsAreTriangulatedAndJudged) {
  const ReadResult flat = read("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  EXPECT_EQ(flat.surface.triangles.size(), 2U);
  EXPECT_TRUE(flat.warnings.empty());
  const ReadResult bent = read("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 .5\n0 1 0\n4 0 1 2 3\n");
  ASSERT_EQ(bent.warnings.size(), 1U);
  EXPECT_NE(bent.warnings[0].find("not exactly planar"), std::string::npos);
  EXPECT_NE(bent.warnings[0].find("line 7"), std::string::npos);
}

TEST(ReadObj, IndicesGroupsAndForwardReferences) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_TRUE(read("f 1 2 3\n" + points, "x.obj").ok());
  EXPECT_TRUE(read(points + "f 1/ 2/ 3/\n", "x.obj").ok());
  EXPECT_TRUE(
      read("v 0 0 0 1 .5 .5 .5\nv 1 0 0 1\nv 0 1 0 1\ns off\nl 1 2\nf -1 -2 -3", "x.obj").ok());
  expect_error(points + "f 1 2 4\n", "x.obj", "x.obj:4: vertex index out of range: 4");
  expect_error(points + "f 1 2 -4\n", "x.obj", "x.obj:4: vertex index out of range: -4");
  expect_error(points + "f 0 1 2\n", "x.obj", "x.obj:4: bad corner '0'");
  expect_error(points + "f 1/x 1 2\n", "x.obj", "x.obj:4: bad corner '1/x'");
  expect_error(points + "f 1 2\n", "x.obj", "x.obj:4: a face needs");
  expect_error(points + "f 1 2 3\n\x01\x02", "x.obj", "x.obj:5: unexpected");
  expect_error("v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n", "x.obj", "x.obj:1: a vertex with 2 coordinates");
  EXPECT_TRUE(
      parse_surface("v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n", "x.obj", {.planar = true, .go_on = {}}).ok());
  const std::string groups = "g a\nf 1 2 3\ng b\nf 3 2 1\n";
  const ReadResult by_group = read(points + "usemtl one\no two\n" + groups, "x.obj");
  EXPECT_EQ(by_group.surface.labels, std::vector<std::int32_t>({1, 2}));
  EXPECT_EQ(by_group.names, (LabelNames{{1, "a"}, {2, "b"}}));
  EXPECT_EQ(by_group.notes.at(0), "labels by group: 1 = 'a', 2 = 'b'");
  EXPECT_TRUE(read(points + "g a\nusemtl b\nf 1 2 3\nf 3 2 1\n", "x.obj").surface.labels.empty());
}

TEST(ReadObj, CoordinatesAreFinite) {
  expect_error("v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", "x.obj",
               "x.obj:2: non-finite coordinate 'nan'");
}

TEST(ReadStl, WeldsEqualCoordinatesOnly) {
  const std::string head = "solid\nfacet normal 0 0 1\nouter loop\n";
  const std::string tail = "endloop\nendfacet\nendsolid";
  const ReadResult result = read(head +
                                 "vertex 0 0 0\nvertex 1 0 -0\nvertex 0 1 0\nendloop\nendfacet\n"
                                 "FACET NORMAL 0 0 -1\nOUTER LOOP\nVERTEX -0 0 0\nVERTEX 0 1 0\n"
                                 "VERTEX 1.0000000000000002 0 0\n" +
                                 tail);
  ASSERT_TRUE(result.ok()) << result.error;
  EXPECT_EQ(result.surface.vertices.size(), 4U);
  for (const auto& v : result.surface.vertices) EXPECT_FALSE(std::signbit(v[2]));
  EXPECT_EQ(result.surface.triangles[1][0], 0U);
  EXPECT_EQ(result.surface.triangles[1][1], 2U);
  EXPECT_NE(result.notes.at(0).find("welded 6 corners into 4"), std::string::npos);
  expect_error(head + "vertex 0 0 0\nvertex 1 0 0\nendloop", "x.stl", "x.stl:6: 'endloop' instead");
  expect_error(head + "vertex 0 0 0\nvertex 1 0 inf\n", "x.stl", "x.stl:5: non-finite");
  expect_error("solid\nendsolid\n", "x.stl", "x.stl: no faces");
}

TEST(ReadStl, BinarySizesAreChecked) {
  const std::string good = tet_binary_stl();
  expect_error(good.substr(0, good.size() - 1), "x.stl",
               "x.stl: byte 283: the file ends in facet 3");
  EXPECT_EQ(parse_surface(good + "tail", "x.stl").warnings.size(), 1U);
  std::string infinite = good;
  infinite[84 + 12 + 3] = 0x7f, infinite[84 + 12 + 2] = static_cast<char>(0x80);
  expect_error(infinite, "x.stl", "x.stl: byte 96: non-finite");
  std::string absurd = good;
  for (int i = 80; i < 84; ++i) absurd[static_cast<std::size_t>(i)] = static_cast<char>(0xff);
  expect_error(absurd, "x.stl", "ends in facet 4 of 4294967295");
}

TEST(ReadPly, HeaderErrors) {
  const auto ply = [](const std::string& rest) { return "ply\nformat ascii 1.0\n" + rest; };
  expect_error("ply\nformat morse 1.0\n", "x.ply", "x.ply:2: unknown format");
  expect_error(ply("element vertex many\n"), "x.ply", "x.ply:3: bad count");
  expect_error(ply("property float x\n"), "x.ply", "x.ply:3: a property before");
  expect_error(ply("element vertex 1\nproperty real x\n"), "x.ply", "x.ply:4: unknown type");
  expect_error(ply("element vertex 1\nproperty float x\n"), "x.ply", "the file ends in the header");
  expect_error(ply("element vertex 1000000000\nproperty float x\nend_header\n1 "), "x.ply",
               "x.ply:3: the file is too short");
  expect_error(ply("element vertex 0\nend_header\n"), "x.ply", "no element 'face'");
  expect_error(ply("element tristrips 1\nend_header\n"), "x.ply", "triangle strips");
  // An element without properties takes no bytes: it must take no time either.
  const std::string body =
      "element nothing 18446744073709551615\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0 1 0 0 0 1 0\n3 0 1 2\n";
  EXPECT_TRUE(read(ply(body), "x.ply").ok());
}

TEST(ReadPly, LabelsAreIntegersOf32Bits) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_index\nproperty double label\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 ";
  EXPECT_EQ(read(head + "-7\n", "x.ply").surface.labels, (std::vector<std::int32_t>{-7}));
  expect_error(head + "2147483648\n", "x.ply", "x.ply:14: a label that is not a 32-bit integer");
  expect_error(head + "0.5\n", "x.ply", "x.ply:14: a label that is not a 32-bit integer");
}

// A box with a box in it, whose facets are given from either side.
std::string boxes_of_facets(const std::string& end) {
  return "16 3\n1 0 0 0\n2 4 0 0\n3 4 4 0\n4 0 4 0\n5 0 0 4\n6 4 0 4\n7 4 4 4\n8 0 4 4\n"
         "9 1 1 1\n10 3 1 1\n11 3 3 1\n12 1 3 1\n13 1 1 3\n14 3 1 3\n15 3 3 3\n16 1 3 3\n"
         "12 0\n1\n4 1 2 3 4\n1\n4 5 6 7 8\n1\n4 1 2 6 5\n1\n4 2 3 7 6\n1\n4 3 4 8 7\n"
         "1\n4 4 1 5 8\n1\n4 9 10 11 12\n1\n4 13 14 15 16\n1\n4 9 10 14 13\n"
         "1\n4 10 11 15 14\n1\n4 11 12 16 15\n1\n4 12 9 13 16\n" +
         end;
}

// Facets of TetGen's files have no orientation, and hole points say what is left out.
TEST(ReadTetgen, FacetsAreTakenFromEitherSide) {
  const auto volume = [](const Surface& s) {
    double sum = 0;
    for (const auto& [i, j, k] : s.triangles) {
      const auto &a = s.vertices[i], &b = s.vertices[j], &c = s.vertices[k];
      sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
             a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum / 6;
  };
  const ReadResult hollow = read(boxes_of_facets("1\n1 2 2 2\n0\n"), "x.poly");
  ASSERT_TRUE(hollow.ok()) << hollow.error;
  EXPECT_EQ(hollow.warnings, std::vector<std::string>());
  EXPECT_DOUBLE_EQ(volume(hollow.surface), 64 - 8);
  // TetGen would fill what has no hole point, and leave out what has one.
  const ReadResult filled = read(boxes_of_facets("0\n1\n1 2 2 2 7 -1\n"), "x.poly");
  EXPECT_EQ(filled.warnings,
            (std::vector<std::string>{
                "the closed surface at (1, 3, 1) is inside another, without a hole point: TetGen "
                "fills it, here --regions all does"}));
  EXPECT_DOUBLE_EQ(volume(filled.surface), 64 - 8);
  ASSERT_EQ(filled.region_points.size(), 1U);
  EXPECT_EQ(filled.region_points[0].point, (std::array<double, 3>{2, 2, 2}));
  EXPECT_EQ(filled.region_points[0].name, "7");
  EXPECT_EQ(filled.region_points[0].max_edge, 0);
  const ReadResult sized =
      read(boxes_of_facets("1\n1 2 2 2\n2\n1 .5 .5 .5 -1.50 4.5\n2 1 1 1\n"), "x.poly");
  ASSERT_EQ(sized.region_points.size(), 3U);
  EXPECT_TRUE(sized.region_points[0].is_hole);
  EXPECT_FALSE(sized.region_points[1].is_hole);
  EXPECT_EQ(sized.region_points[1].name, "-1.5");
  // A regular tetrahedron with this edge has the volume.
  EXPECT_NEAR(std::pow(sized.region_points[1].max_edge, 3) / (6 * std::sqrt(2.0)), 4.5, 1e-12);
  EXPECT_EQ(sized.region_points[2].name, "");
  const ReadResult wrong = read(boxes_of_facets("0\n1\n1 2 2 2 7 x\n"), "x.poly");
  EXPECT_TRUE(wrong.error.ends_with(": bad number 'x'")) << wrong.error;
  const ReadResult emptied = read(boxes_of_facets("2\n1 2 2 2\n2 0.5 0.5 0.5\n"), "x.poly");
  EXPECT_EQ(emptied.warnings,
            (std::vector<std::string>{"the hole point (0.5, 0.5, 0.5) is inside the solid: TetGen "
                                      "leaves that part out, here --regions all does"}));
}

// Vertices repeated along the seams of textures are one; those of bodies that touch are not.
TEST(ReadSurface, SeamsOfObjAndPlyAreClosed) {
  const std::string obj =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 -0\nv 1 0 0\nv 0 1 0\n"
      "f 1 3 2\nf 5 6 4\nf 6 7 4\nf 5 4 7\n";
  const ReadResult closed = read(obj, "x.obj");
  ASSERT_TRUE(closed.ok()) << closed.error;
  EXPECT_EQ(closed.surface.vertices.size(), 4U);
  EXPECT_EQ(closed.surface.triangles, (std::vector<std::array<std::uint32_t, 3>>{
                                          {0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}));
  EXPECT_EQ(
      closed.warnings,
      (std::vector<std::string>{"3 vertices along seams joined to others at the same place"}));
  const ReadResult ply = read(
      "ply\nformat ascii 1.0\nelement vertex 7\nproperty double x\nproperty double y\nproperty "
      "double z\nelement face 4\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n"
      "0 1 0\n0 0 1\n0 0 0\n1 0 0\n0 1 0\n3 0 2 1\n3 4 5 3\n3 5 6 3\n3 4 3 6\n",
      "x.ply");
  EXPECT_EQ(ply.surface.triangles, closed.surface.triangles);
  const std::string body =
      "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n";
  const ReadResult two = read(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 0\nv -1 0 0\nv 0 -1 0\nv 0 0 1\n" + body, "x.obj");
  EXPECT_EQ(two.surface.vertices.size(), 8U);
}

TEST(ReadTetgen, FacetsWithHolesAndNodeFiles) {
  const std::string points =
      "8 3\n1 0 0 0\n2 4 0 0\n3 4 4 0\n4 0 4 0\n5 1 1 0\n6 3 1 0\n7 3 3 0\n8 1 3 0\n";
  const ReadResult frame =
      read(points + "1 1\n2 1 3\n4 1 2 3 4\n4 5 6 7 8\n1 2 2 0\n0\n0\n", "x.poly");
  ASSERT_TRUE(frame.ok()) << frame.error;
  EXPECT_EQ(frame.surface.triangles.size(), 8U);
  EXPECT_EQ(frame.surface.labels, std::vector<std::int32_t>(8, 3));
  expect_error(points + "1 1\n2 1 3\n4 1 2 3 4\n4 5 6 7 8\n1 9 9 0\n", "x.poly",
               "x.poly:11: a hole point inside no polygon");
  expect_error("3 2\n1 0 0\n2 1 0\n3 0 1\n", "x.poly", "x.poly:1: points of dimension 2");
  expect_error("1 3\n5 0 0 0\n0 0\n", "x.smesh", "x.smesh:2: points have to be numbered");
  expect_error("2 3\n0 0 0 0\n2 0 0 0\n", "x.smesh", "x.smesh:3: point number 2 where 1");
  expect_error("0 3\n1 0\n3 0 1 2\n", "x.smesh", "no .node file");
  expect_error("1 3\n1 0 0 inf\n", "x.smesh", "x.smesh:2: non-finite coordinate 'inf'");
  expect_error(points + "1 0\n20001 1 2 3\n", "x.smesh",
               "x.smesh:11: a face with 20001 corners (the limit is 20000)");

  const auto folder =
      std::filesystem::temp_directory_path() / ("delmesher_read_test_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "t.node") << "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n";
  std::ofstream(folder / "t.smesh") << "0 3\n4 0\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n0\n0\n";
  const ReadResult beside = read_surface((folder / "t.smesh").string());
  EXPECT_TRUE(beside.ok()) << beside.error;
  EXPECT_EQ(beside.surface.vertices.size(), 4U);
  std::ofstream(folder / "t.node") << "4 3 0 0\n0 0 0 0\n1 1 0\n";
  EXPECT_NE(read_surface((folder / "t.smesh").string())
                .error.find("t.smesh:1: in the .node file, line 3: fewer than 3 coordinates"),
            std::string::npos)
      << read_surface((folder / "t.smesh").string()).error;
  std::filesystem::remove_all(folder);
}

TEST(ReadSurface, FilesThatCannotBeRead) {
  EXPECT_EQ(read_surface("/nonexistent/x.off").code, ReadCode::unreadable);
  const ReadResult folder = read_surface(std::filesystem::temp_directory_path().string());
  EXPECT_NE(folder.error.find("is a directory"), std::string::npos);
}

// --------------------------------------------------------------------------------------- hostile

void expect_sane(const std::string& bytes, const std::string& name) {
  const ReadResult result = parse_surface(bytes, name);
  if (result.ok()) {
    for (const auto& t : result.surface.triangles) {
      for (auto v : t) ASSERT_LT(v, result.surface.vertices.size());
    }
    ASSERT_FALSE(result.surface.triangles.empty());
  } else {
    ASSERT_TRUE(result.error.starts_with(name)) << result.error;
    ASSERT_EQ(result.error.find('\n'), std::string::npos);
  }
}

TEST(Hostile, TruncationAtEveryByte) {
  int refused = 0;
  for (const auto& [name, bytes] : tet_samples()) {
    for (std::size_t n = 0; n < bytes.size(); ++n) {
      expect_sane(bytes.substr(0, n), name);
      refused += parse_surface(bytes.substr(0, n), name).ok() ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 2000);
}

TEST(Hostile, EveryByteReplaced) {
  for (const auto& [name, bytes] : tet_samples()) {
    for (std::size_t n = 0; n < bytes.size(); ++n) {
      for (const int c :
           std::initializer_list<int>{0x00, 0xff, 0x7f, 0x80, '9', '-', ' ', '\n', '#', 'e', '/'}) {
        std::string changed = bytes;
        changed[n] = static_cast<char>(c);
        expect_sane(changed, name);
      }
    }
  }
}

TEST(Hostile, EveryFormatUnderEveryName) {
  for (const char* name : {"x.off", "x.obj", "x.stl", "x.ply", "x.smesh", "x.poly", "x"}) {
    for (const auto& sample : tet_samples()) expect_sane(sample.second, name);
    expect_sane(std::string(1000, '\0'), name);
    expect_sane(std::string(1000, '9'), name);
    expect_sane(std::string(1000, ' '), name);
  }
}

// Whatever their name says; a binary STL of the right size is one in any case.
TEST(ParseSurface, OtherFilesAreKnownByTheirFirstBytes) {
  const std::string text = tet_off();
  std::string utf16 = "\xff\xfe";
  for (const char c : text) utf16 += {c, '\0'};
  const std::string utf16_without_mark = utf16.substr(2), card(72, ' ');
  const std::pair<std::string, std::string> files[] = {{utf16_without_mark, "UTF-16"},
                                                       {'\0' + utf16_without_mark, "UTF-16"},
                                                       {card + "S      1\n", "IGES"},
                                                       {"#VRML V2.0 utf8\n", "VRML"},
                                                       {"Kaydara FBX Binary  ", "FBX"},
                                                       {"version https://git-lfs.x\n", "lfs pull"},
                                                       {"<?xml?>\n<COLLADA>", "COLLADA"},
                                                       {"<?xml?>\n<X3D>", "X3D"},
                                                       {"{\"asset\":{}}", "glTF"},
                                                       {"\x1f\x8b\x08", "compressed twice"},
                                                       {"BZh9" + text, "bunzip2"},
                                                       {"PK\x03\x04" + text, "zip archive"},
                                                       {"ISO-10303-21;\nHEADER;\n", "STEP"},
                                                       {utf16, "UTF-16"},
                                                       {"\n<!DOCTYPE HTML>\n<html>", "web page"},
                                                       {"<html lang=\"en\">", "web page"}};
  for (const auto& [bytes, said] : files) {
    for (const char* name : {"a.stl", "a.off", "a.obj", "a.xyz"}) {
      const ReadResult result = parse_surface(bytes, name);
      EXPECT_EQ(result.code, ReadCode::unreadable);
      EXPECT_NE(result.error.find(said), std::string::npos) << result.error;
    }
    EXPECT_NE(parse_mesh(bytes, "a.msh", nullptr).error.find(said), std::string::npos);
  }
  EXPECT_EQ(parse_surface(tet_binary_stl("PK\x03\x04"), "a.stl").format, "STL");
}

}  // namespace
}  // namespace delmesher::io
