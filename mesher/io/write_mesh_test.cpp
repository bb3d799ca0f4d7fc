#include "mesher/io/write_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include "mesher/delmesher_files.h"
#include "mesher/io/binary.h"
#include "mesher/io/named_sets.h"
#include "mesher/io/parse_surface.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

namespace fs = std::filesystem;

class WriteMesh : public testing::Test {
 protected:
  WriteMesh() {
    folder_ = fs::temp_directory_path() /
              ("delmesher_write_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~WriteMesh() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static std::string content(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::stringstream out;
    out << in.rdbuf();
    return out.str();
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  // Two tetrahedra, one of them outside, with doubles that are hard to write.
  static TetMesh sample() {
    TetMesh mesh;
    mesh.vertices = {{0.1, 1e-310, -0.0},
                     {std::numeric_limits<double>::max(), 0, 0},
                     {0, 1.0 / 3, 0},
                     {0, 0, 1e22},
                     {-1e300, -5e-324, -1}};
    mesh.tetrahedra = {{0, 1, 2, 4}, {0, 1, 2, 3}};
    mesh.inside = {0, 1};
    mesh.boundary = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}};
    mesh.boundary_labels = {7, 0, -2};
    mesh.boundary_facets = {9, 4, 5};
    return mesh;
  }

  fs::path folder_;
};

const WriteOptions kAscii = {.order = 1, .ascii = true};

const char* const kPoints =
    "0.1 1e-310 -0\n1.7976931348623157e+308 0 0\n0 0.3333333333333333 0\n0 0 1e+22\n"
    "-1e+300 -5e-324 -1\n";

TEST_F(WriteMesh, Tet) {
  OutputSet outputs;
  ASSERT_TRUE(write_mesh(outputs, path("a.tet"), sample()).ok());
  ASSERT_TRUE(outputs.commit().ok());
  EXPECT_EQ(content(path("a.tet")), "5 vertices\n1 inner tets\n1 outer tets\n" +
                                        std::string(kPoints) + "4 0 1 2 3\n4 0 1 2 4\n");
  TetMesh inside = sample();
  inside.tetrahedra.erase(inside.tetrahedra.begin());
  inside.inside.erase(inside.inside.begin());
  OutputSet again;
  ASSERT_TRUE(write_mesh(again, path("a.tet"), inside).ok());
  ASSERT_TRUE(again.commit().ok());
  EXPECT_EQ(content(path("a.tet")), "5 vertices\n1 tets\n" + std::string(kPoints) + "4 0 1 2 3\n");
}

TEST_F(WriteMesh, Medit) {
  OutputSet outputs;
  ASSERT_TRUE(write_mesh(outputs, path("a.mesh"), sample()).ok());
  ASSERT_TRUE(outputs.commit().ok());
  const std::string text = content(path("a.mesh"));
  EXPECT_TRUE(
      text.starts_with("MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0.1 1e-310 -0 0\n"));
  EXPECT_TRUE(
      text.ends_with("Triangles\n3\n1 3 2 7\n1 2 4 0\n2 3 4 -2\n"
                     "Tetrahedra\n2\n1 2 3 5 2\n1 2 3 4 1\n"
                     "End\n# TriangleFacets 3\n# 9\n# 4\n# 5\n"));
}

// In a comment, or a field, that readers pass over.
TEST_F(WriteMesh, HowFarFacetsAreFromPlanar) {
  TetMesh mesh = sample();
  mesh.planar_within = 0.1;
  const std::pair<const char*, const char*> formats[] = {
      {"a.mesh", "# 5\n# PlanarWithin 0.1\n"},
      {"a.msh", "$EndElements\n$Comments\nPlanarWithin 0.1\n$EndComments\n"},
      {"a.node", "\n# PlanarWithin 0.1\n"},
      {"a.vtu",
       "<FieldData>\n<DataArray type=\"Float64\" Name=\"PlanarWithin\" NumberOfTuples=\"1\" "
       "format=\"ascii\">\n0.1\n</DataArray>\n</FieldData>\n"}};
  for (const auto& [name, said] : formats) {
    OutputSet outputs;
    ASSERT_TRUE(write_mesh(outputs, path(name), mesh, {}, kAscii).ok());
    ASSERT_TRUE(outputs.commit().ok());
    EXPECT_NE(content(path(name)).find(said), std::string::npos) << content(path(name));
    const MeshReadResult again = read_mesh(path(name));
    EXPECT_TRUE(again.ok()) << again.error;
    EXPECT_EQ(again.mesh.tetrahedra.size(), 2U) << name;
  }
}

TEST_F(WriteMesh, Gmsh) {
  OutputSet outputs;
  ASSERT_TRUE(write_mesh(outputs, path("a.msh"), sample(), {}, kAscii).ok());
  ASSERT_TRUE(outputs.commit().ok());
  const std::string text = content(path("a.msh"));
  EXPECT_NE(text.find("$PhysicalNames\n5\n2 9 \"label -2\"\n2 8 \"label 0\"\n2 7 \"label 7\"\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("$Entities\n0 0 3 2\n5 0"), std::string::npos);
  EXPECT_NE(text.find("$Nodes\n1 5 1 5\n3 1 0 5\n1\n2\n3\n4\n5\n" + std::string(kPoints)),
            std::string::npos);
  EXPECT_NE(text.find("$Elements\n5 5 1 5\n2 5 2 1\n1 1 2 4\n2 6 2 1\n2 2 3 4\n2 10 2 1\n3 1 3 2\n"
                      "3 1 4 1\n4 1 2 3 4\n3 2 4 1\n5 1 2 3 5\n$EndElements\n"),
            std::string::npos)
      << text;
}

// Programs that number the groups of all dimensions together must not mix them up: no tag is there
// twice, and what cannot be its own tag is told by the name. All of it comes back.
TEST_F(WriteMesh, TagsOfGmshAreUniqueOverDimensions) {
  TetMesh mesh = sample();
  mesh.boundary_labels = {1, 2, -1};
  for (const MshVersion version : {MshVersion::v4_1, MshVersion::v2_2}) {
    ASSERT_TRUE(write_mesh(path("a.msh"), mesh, {}, {.ascii = true, .msh = version}).ok());
    EXPECT_NE(content(path("a.msh"))
                  .find("\n5\n2 3 \"label -1\"\n2 1 \"label 1\"\n2 2 \"label 2\"\n"
                        "3 4 \"inside\"\n3 5 \"outside\"\n$End"),
              std::string::npos)
        << content(path("a.msh"));
    const MeshReadResult back = read_mesh(path("a.msh"));
    ASSERT_TRUE(back.ok()) << back.error;
    EXPECT_TRUE(back.mesh.regions.empty());
    std::vector<std::uint8_t> inside = back.mesh.inside;
    std::sort(inside.begin(), inside.end());
    EXPECT_EQ(inside, (std::vector<std::uint8_t>{0, 1}));
    std::vector<std::int32_t> labels = back.mesh.boundary_labels;
    std::sort(labels.begin(), labels.end());
    EXPECT_EQ(labels, (std::vector<std::int32_t>{-1, 1, 2}));
  }
  mesh.regions = {2, 7};
  const LabelNames names = {{2, "steel"}, {7, "rubber"}};
  ASSERT_TRUE(write_mesh(path("b.msh"), mesh, {}, {.ascii = true, .region_names = names}).ok());
  EXPECT_NE(content(path("b.msh")).find("\n3 9 \"region 2 steel\"\n3 7 \"rubber\"\n$End"),
            std::string::npos)
      << content(path("b.msh"));
  const MeshReadResult regions = read_mesh(path("b.msh"));
  EXPECT_EQ(regions.region_names, names);
  EXPECT_EQ(std::set(regions.mesh.regions.begin(), regions.mesh.regions.end()),
            (std::set<std::int32_t>{2, 7}));
}

TEST_F(WriteMesh, AnOlderVersionOfGmsh) {
  ASSERT_TRUE(write_mesh(path("a.msh"), sample(), {}, {.msh = MshVersion::v2_2}).ok());
  const std::string text = content(path("a.msh"));
  EXPECT_TRUE(text.starts_with("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n"));
  EXPECT_NE(text.find("$Nodes\n5\n1 0.1 1e-310 -0\n"), std::string::npos) << text;
  EXPECT_NE(text.find("$Elements\n5\n1 2 2 8 5 1 2 4\n2 2 2 9 6 2 3 4\n3 2 2 7 10 1 3 2\n"
                      "4 4 2 1 1 1 2 3 4\n5 4 2 2 2 1 2 3 5\n$EndElements\n"),
            std::string::npos)
      << text;
}

// Volumes know their boundaries: facet 5 is behind the inner tetrahedron alone, facet 10 between
// both.
TEST_F(WriteMesh, GmshVolumesKnowTheirSurfaces) {
  OutputSet outputs;
  TetMesh mesh = sample();
  mesh.tetrahedra[0] = {0, 2, 1, 4};  // positive, as in any mesh but that of a writer's test
  ASSERT_TRUE(write_mesh(outputs, path("a.msh"), mesh, {}, kAscii).ok());
  TetMesh inside = sample();
  inside.tetrahedra.erase(inside.tetrahedra.begin());
  inside.inside.erase(inside.inside.begin());
  ASSERT_TRUE(write_mesh(outputs, path("b.msh"), inside, {}, kAscii).ok());
  ASSERT_TRUE(outputs.commit().ok());
  const std::string both = content(path("a.msh")), one = content(path("b.msh"));
  EXPECT_NE(both.find(" 1 1 3 5 6 10\n"), std::string::npos) << both;
  EXPECT_NE(both.find(" 1 2 1 -10\n"), std::string::npos) << both;
  EXPECT_NE(one.find("3 1 \"inside\"\n$End"), std::string::npos) << one;
  EXPECT_NE(one.find("$Entities\n0 0 3 1\n"), std::string::npos) << one;
}

// A label that is not positive cannot be a tag: it stands before its name, and both come back.
TEST_F(WriteMesh, NamesComeBackFromGmsh) {
  OutputSet outputs;
  const LabelNames names = {{7, "hot \"wall\""}, {0, "a b"}};
  ASSERT_TRUE(write_mesh(outputs, path("a.msh"), sample(), names).ok());
  ASSERT_TRUE(outputs.commit().ok());
  const MeshReadResult back = read_mesh(path("a.msh"));
  ASSERT_TRUE(back.ok()) << back.error;
  EXPECT_EQ(back.names, (LabelNames{{7, "hot 'wall'"}, {0, "a b"}}));
  std::vector<std::int32_t> labels = back.mesh.boundary_labels;
  std::sort(labels.begin(), labels.end());
  EXPECT_EQ(labels, (std::vector<std::int32_t>{-2, 0, 7}));
}

TEST_F(WriteMesh, TheNameOfTheOnlyRegionComesBack) {
  for (const std::string file : {"only.msh", "only.vtu"}) {
    TetMesh mesh = sample();
    mesh.regions.assign(mesh.tetrahedra.size(), 1);
    OutputSet outputs;
    ASSERT_TRUE(write_mesh(outputs, path(file), mesh, {}, {.region_names = {{1, "fluid"}}}).ok());
    ASSERT_TRUE(outputs.commit().ok());
    const MeshReadResult back = read_mesh(path(file));
    ASSERT_TRUE(back.ok()) << back.error;
    EXPECT_EQ(back.region_names, (LabelNames{{1, "fluid"}})) << file;
  }
}

// A name as delmesher itself would give it to another label says nothing about numbers.
TEST_F(WriteMesh, NamesLikeItsOwnComeBackFromGmsh) {
  for (const std::string name : {"label 0", "label 5 of it", "label 7 old", "label x"}) {
    OutputSet outputs;
    ASSERT_TRUE(write_mesh(outputs, path("own.msh"), sample(), {{7, name}}).ok());
    ASSERT_TRUE(outputs.commit().ok());
    const MeshReadResult back = read_mesh(path("own.msh"));
    ASSERT_TRUE(back.ok()) << back.error;
    EXPECT_EQ(back.names, (LabelNames{{7, name}}));
    std::vector<std::int32_t> labels = back.mesh.boundary_labels;
    std::sort(labels.begin(), labels.end());
    EXPECT_EQ(labels, (std::vector<std::int32_t>{-2, 0, 7}));
  }
}

// Fields of sixteen characters: the nearest decimal that fits, with a point.
TEST_F(WriteMesh, NastranNumbersFitTheirFields) {
  TetMesh mesh;
  mesh.vertices = {{1, -1.0 / 3, 1e22},
                   {0.1, -1.2345678901234567e-100, 123456789.0123456},
                   {-0.0, 5e-324, -0.001234567890123456}};
  mesh.boundary = {{0, 1, 2}};
  mesh.boundary_labels = {-1};
  mesh.boundary_facets = {0};
  OutputSet outputs;
  ASSERT_TRUE(write_mesh(outputs, path("a.bdf"), mesh).ok());
  ASSERT_TRUE(outputs.commit().ok());
  const auto grid = [](const char* id, std::string x, std::string y, std::string z) {
    for (std::string* text : {&x, &y, &z}) text->resize(16, ' ');
    return std::string("GRID*   ") + id + "       " + std::string(24, ' ') + x + y + "\n*       " +
           z + "\n";
  };
  EXPECT_EQ(content(path("a.bdf")),
            "$ delmesher\n$HMNAME COMP                   1\"label -1\"\nBEGIN BULK\n" +
                grid("1", "1.", "-0.3333333333333", "1.E22") +
                grid("2", "0.1", "-1.23456789E-100", "123456789.012346") +
                grid("3", "-0.", "5.E-324", "-0.0012345678901") +
                "CTRIA3  1       1       1       2       3       \nENDDATA\n");
}

TEST_F(WriteMesh, LabelNamesAreRead) {
  const auto read = [&](const std::string& text) {
    std::ofstream(path("names.txt")) << text;
    return read_label_names(path("names.txt"));
  };
  const NamesResult good = read("# what is what\n\n1 inlet\n -3  the outer wall \r\n0 x#1\n");
  EXPECT_EQ(good.error, "");
  EXPECT_EQ(good.names, (LabelNames{{1, "inlet"}, {-3, "the outer wall"}, {0, "x#1"}}));
  EXPECT_EQ(read("1 a\n2\n").error, path("names.txt") + ":2: label 2 has no name");
  EXPECT_EQ(read("one a\n").error, path("names.txt") + ":1: no label: 'one'");
  EXPECT_EQ(read("1 a\n1 b\n").error, path("names.txt") + ":2: label 1 is named twice");
  EXPECT_FALSE(read_label_names(path("none.txt")).ok());
  EXPECT_EQ(read("1 caf\xe9\n").names.at(1), "caf\xc3\xa9");
}

TEST(DistinctNames, EndInNumbersThatAreFree) {
  const LabelNames names = {{1, "wall"}, {2, "wall 2"}, {3, "wall"}, {4, "inlet"}, {9, "wall"}};
  const LabelNames distinct = {
      {1, "wall"}, {2, "wall 2"}, {3, "wall 3"}, {4, "inlet"}, {9, "wall 4"}};
  EXPECT_EQ(distinct_names(names), distinct);
  EXPECT_EQ(distinct_names(distinct), distinct);
  // One of them in Latin-1.
  EXPECT_EQ(distinct_names({{1, "caf\xe9"}, {2, "caf\xc3\xa9"}}),
            (LabelNames{{1, "caf\xc3\xa9"}, {2, "caf\xc3\xa9 2"}}));
}

// Programs find sets by their names: each label has one of its own.
TEST_F(WriteMesh, EqualNamesAreToldApart) {
  const LabelNames names = {{7, "wall"}, {0, "wall"}, {-2, "inlet"}};
  for (const char* extension : {".msh", ".vtu", ".xdmf", ".bdf", ".stl", ".ply"}) {
    const std::string file = path(std::string("a") + extension);
    ASSERT_TRUE(write_mesh(file, sample(), names, kAscii).ok());
    const std::string text = content(file);
    EXPECT_NE(text.find("wall 2"), std::string::npos) << extension;
  }
}

TEST_F(WriteMesh, RegionsHaveNames) {
  TetMesh mesh = sample();
  mesh.regions = {5, -3};
  const WriteOptions options = {.ascii = true, .region_names = {{5, "steel"}, {-3, "air gap"}}};
  for (const auto& [extension, words] :
       {std::pair(".msh", "3 5 \"steel\"\n"), std::pair(".msh", "\"region -3 air gap\"\n"),
        std::pair(".inp", "ELSET=steel\n"), std::pair(".inp", "ELSET=air_gap\n"),
        std::pair(".bdf", "\"air gap\"\n"),
        std::pair(".xdmf", "<map key=\"steel\" dim=\"3\">5<")}) {
    const std::string file = path(std::string("a") + extension);
    ASSERT_TRUE(write_mesh(file, mesh, {}, options).ok());
    EXPECT_NE(content(file).find(words), std::string::npos) << extension << content(file);
  }
}

TEST(Identifiers, AreDifferentAndPlain) {
  Identifiers identifiers;
  EXPECT_EQ(identifiers.make("hot wall"), "hot_wall");
  EXPECT_EQ(identifiers.make("HOT-wall"), "HOT_wall_2");
  EXPECT_EQ(identifiers.make("hot_wall_2"), "hot_wall_2_2");
  EXPECT_EQ(identifiers.make("hot wall"), "hot_wall_3");
  EXPECT_EQ(identifiers.make("3\xc3\xa4"), "set_3__");
  EXPECT_EQ(identifiers.make(""), "set_");
  EXPECT_EQ(identifiers.make(std::string(500, 'x')).size(), 60U);
}

TEST_F(WriteMesh, VtuAndTetgen) {
  OutputSet outputs;
  ASSERT_TRUE(write_mesh(outputs, path("a.vtu"), sample(), {}, kAscii).ok());
  ASSERT_TRUE(write_mesh(outputs, path("a.node"), sample()).ok());
  EXPECT_FALSE(fs::exists(path("a.vtu")));
  ASSERT_TRUE(outputs.commit().ok());
  EXPECT_EQ(files(), 4U);
  const std::string vtu = content(path("a.vtu"));
  EXPECT_NE(vtu.find("NumberOfPoints=\"5\" NumberOfCells=\"5\""), std::string::npos);
  EXPECT_NE(vtu.find(kPoints), std::string::npos);
  EXPECT_NE(vtu.find("\"facet\" format=\"ascii\">\n-1\n-1\n9\n4\n5\n<"), std::string::npos);
  EXPECT_NE(vtu.find("\"label\" format=\"ascii\">\n0\n0\n7\n0\n-2\n<"), std::string::npos);
  EXPECT_NE(vtu.find("\"inside\" format=\"ascii\">\n0\n1\n-1\n-1\n-1\n<"), std::string::npos);
  EXPECT_NE(vtu.find("\"offsets\" format=\"ascii\">\n4\n8\n11\n14\n17\n<"), std::string::npos);
  EXPECT_TRUE(content(path("a.node")).starts_with("5 3 0 0\n0 0.1 1e-310 -0\n1 1.79"));
  EXPECT_EQ(content(path("a.ele")), "2 4 1\n0 0 1 2 4 2\n1 0 1 2 3 1\n");
  EXPECT_EQ(content(path("a.face")), "3 1\n0 0 2 1 7 9\n1 0 1 3 0 4\n2 1 2 3 -2 5\n");
}

// The middle of the largest doubles is not an infinity; the middle of 1e-310 and 0 is exact.
TEST_F(WriteMesh, SecondOrder) {
  TetMesh mesh = sample();
  mesh.vertices[2][0] = std::numeric_limits<double>::max();
  OutputSet outputs;
  const WriteOptions second{.order = 2, .ascii = true};
  ASSERT_TRUE(write_mesh(outputs, path("a.mesh"), mesh, {}, second).ok());
  ASSERT_TRUE(write_mesh(outputs, path("a.msh"), mesh, {}, second).ok());
  for (const char* name : {"a.node", "a.tet", "a.xdmf", "a.stl", "a.ply", "a.off"}) {
    EXPECT_TRUE(write_mesh(outputs, path(name), mesh, {}, second).error.starts_with(path(name)));
  }
  EXPECT_FALSE(write_mesh(outputs, path("b.msh"), mesh, {}, {.order = 3}).ok());
  ASSERT_TRUE(outputs.commit().ok());
  EXPECT_EQ(files(), 2U);
  // Edges 01 02 03 04 12 13 14 23 24 are nodes 5 to 13.
  const std::string medit = content(path("a.mesh")), gmsh = content(path("a.msh"));
  EXPECT_NE(medit.find("Vertices\n14\n"), std::string::npos) << medit;
  EXPECT_NE(medit.find("\n8.988465674311579e+307 5e-311 0 0\n"), std::string::npos) << medit;
  EXPECT_NE(medit.find("\n1.7976931348623157e+308 0.16666666666666666 0 0\n"), std::string::npos);
  EXPECT_NE(
      medit.find("TrianglesP2\n3\n1 3 2 7 10 6 7\n1 2 4 6 11 8 0\n2 3 4 10 13 11 -2\n"
                 "TetrahedraP2\n2\n1 2 3 5 6 10 7 9 12 14 2\n1 2 3 4 6 10 7 8 11 13 1\nEnd\n"),
      std::string::npos)
      << medit;
  EXPECT_NE(gmsh.find("\n3 1 11 1\n4 1 2 3 4 6 10 7 8 13 11\n"), std::string::npos) << gmsh;
}

// Sizes and numbers as the formats have them, least significant bytes first.
TEST_F(WriteMesh, Bytes) {
  OutputSet outputs;
  ASSERT_TRUE(write_mesh(outputs, path("a.msh"), sample()).ok());
  ASSERT_TRUE(write_mesh(outputs, path("a.vtu"), sample()).ok());
  ASSERT_TRUE(outputs.commit().ok());
  const std::string gmsh = content(path("a.msh")), vtu = content(path("a.vtu"));
  EXPECT_TRUE(
      gmsh.starts_with(std::string("$MeshFormat\n4.1 1 8\n\1\0\0\0\n$EndMeshFormat\n", 40)));
  const auto is_there = [&](const std::string& bytes) {
    return gmsh.find(bytes) != std::string::npos;
  };
  const auto size = [](char low) { return std::string(1, low) + std::string(7, '\0'); };
  const auto tag = [](char low) { return std::string(1, low) + std::string(3, '\0'); };
  EXPECT_TRUE(is_there("$Elements\n" + size(5) + size(5) + size(1) + size(5) + tag(2) + tag(5) +
                       tag(2) + size(1) + size(1) + size(1) + size(2) + size(4)));
  EXPECT_TRUE(is_there("$Nodes\n" + size(1) + size(5) + size(1) + size(5) + tag(3) + tag(1) +
                       tag(0) + size(5)));
  EXPECT_TRUE(is_there(std::string("\x9a\x99\x99\x99\x99\x99\xb9\x3f", 8)));  // 0.1
  EXPECT_TRUE(gmsh.ends_with("\n$EndElements\n"));
  // The numbers of bytes, 5, 20 and 20, then the cells' types, labels and facets.
  for (const char* array :
       {"type=\"UInt8\" Name=\"types\" format=\"binary\">\nBQAAAAAAAAAKCgUFBQ==\n</",
        "type=\"Int32\" Name=\"label\" format=\"binary\">\n"
        "FAAAAAAAAAAAAAAAAAAAAAcAAAAAAAAA/v///w==\n</",
        "type=\"Int32\" Name=\"facet\" format=\"binary\">\n"
        "FAAAAAAAAAD//////////wkAAAAEAAAABQAAAA==\n</"}) {
    EXPECT_NE(vtu.find(array), std::string::npos) << array << "\n" << vtu;
  }
}

// Tags have four bytes: larger ones are written as text, and facets in .vtu with eight.
TEST_F(WriteMesh, WhatDoesNotFitBytesIsText) {
  for (const bool facet : {true, false}) {
    TetMesh mesh = sample();
    (facet ? mesh.boundary_facets[0] = 0xffffff00U
           : static_cast<std::uint32_t>(mesh.boundary_labels[0] = 0x7fffffff));
    ASSERT_TRUE(write_mesh(path("a.msh"), mesh).ok());
    EXPECT_NE(content(path("a.msh")).find("\n4.1 0 8\n"), std::string::npos);
    ASSERT_TRUE(write_mesh(path("a.vtu"), mesh).ok());
    for (const char* name : {"a.msh", "a.vtu"}) {
      const MeshReadResult back = read_mesh(path(name));
      ASSERT_TRUE(back.ok()) << back.error;
      EXPECT_EQ(std::set(back.mesh.boundary_facets.begin(), back.mesh.boundary_facets.end()),
                std::set(mesh.boundary_facets.begin(), mesh.boundary_facets.end()));
      EXPECT_EQ(std::set(back.mesh.boundary_labels.begin(), back.mesh.boundary_labels.end()),
                std::set(mesh.boundary_labels.begin(), mesh.boundary_labels.end()));
    }
  }
}

// The examples of RFC 4648.
TEST(Base64, OfTheStandard) {
  const std::pair<const char*, const char*> kExamples[] = {{"", ""},
                                                           {"f", "Zg=="},
                                                           {"fo", "Zm8="},
                                                           {"foo", "Zm9v"},
                                                           {"foob", "Zm9vYg=="},
                                                           {"fooba", "Zm9vYmE="},
                                                           {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : kExamples) {
    EXPECT_EQ(from_base64(text), bytes);
    EXPECT_EQ(from_base64(std::string("\n ") + text + " \n"), bytes);
  }
  for (const char* bad : {"Z", "Zg=", "Zg==Zg==", "Z===", "====", "Zm9*", "Zm 9v", "Zm8=\n="}) {
    EXPECT_FALSE(from_base64(bad)) << bad;
  }
  EXPECT_EQ(from_base64(" Zg==Zm8=Zm9v", true), "ffofoo");
  EXPECT_FALSE(from_base64("Zg=Zm9v", true));
}

TEST_F(WriteMesh, OffRoundTrip) {
  Surface surface;
  surface.vertices = sample().vertices;
  surface.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 4}};
  OutputSet outputs;
  ASSERT_TRUE(write_off(outputs, path("a.off"), surface).ok());
  ASSERT_TRUE(outputs.commit().ok());
  const ReadResult back = read_surface(path("a.off"));
  ASSERT_TRUE(back.ok()) << back.error;
  EXPECT_EQ(back.surface.vertices, surface.vertices);
  EXPECT_TRUE(std::signbit(back.surface.vertices[0][2]));
  EXPECT_EQ(back.surface.triangles, surface.triangles);
}

TEST_F(WriteMesh, NothingIsLeftWithoutCommit) {
  std::ofstream(path("a.mesh")) << "old";
  std::vector<std::string> seen;
  {
    OutputSet outputs([&](const std::vector<std::string>& names) { seen = names; });
    ASSERT_TRUE(write_mesh(outputs, path("a.mesh"), sample()).ok());
    ASSERT_TRUE(write_mesh(outputs, path("b.node"), sample()).ok());
    EXPECT_EQ(seen.size(), 4U);
    EXPECT_EQ(files(), 5U);
  }
  EXPECT_TRUE(seen.empty());
  EXPECT_EQ(files(), 1U);
  EXPECT_EQ(content(path("a.mesh")), "old");
}

TEST_F(WriteMesh, FailuresAreValues) {
  OutputSet outputs;
  EXPECT_FALSE(write_mesh(outputs, path("no/such/a.mesh"), sample()).ok());
  EXPECT_FALSE(write_mesh(outputs, path("a.xyz"), sample()).ok());
  fs::create_directory(path("dir.mesh"));
  const WriteStatus status = write_mesh(outputs, path("dir.mesh"), sample());
  EXPECT_NE(status.error.find("directory"), std::string::npos) << status.error;
  EXPECT_FALSE(check_writable(path("no/such/a.mesh"), MissingFolder::is_an_error).ok());
  EXPECT_TRUE(check_writable(path("no/such/a.mesh"), MissingFolder::is_made).ok());
  EXPECT_TRUE(check_writable(path("b.mesh"), MissingFolder::is_an_error).ok());
  EXPECT_EQ(files(), 1U);
  TetMesh broken = sample();
  broken.tetrahedra[0][0] = 77;
  EXPECT_FALSE(write_mesh(outputs, path("a.mesh"), broken).ok());
  broken = sample();
  broken.boundary_facets.pop_back();
  EXPECT_FALSE(write_mesh(outputs, path("a.mesh"), broken).ok());
}

// Those that were there stay, those that were made stay with files alone.
TEST_F(WriteMesh, FoldersAreMade) {
  fs::create_directory(path("there"));
  {
    OutputSet outputs;
    outputs.make_folders();
    ASSERT_TRUE(write_mesh(outputs, path("there/new/a.mesh"), sample()).ok());
    ASSERT_TRUE(write_mesh(outputs, path("there/new/er/a.mesh"), sample()).ok());
    EXPECT_TRUE(fs::is_directory(path("there/new/er")));
  }
  EXPECT_TRUE(fs::is_directory(path("there")));
  EXPECT_FALSE(fs::exists(path("there/new")));
  std::vector<std::string> seen;
  OutputSet outputs([&](const std::vector<std::string>& names) { seen = names; });
  outputs.make_folders();
  ASSERT_TRUE(write_mesh(outputs, path("there/new/er/a.mesh"), sample()).ok());
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[1], path("there/new/er"));
  EXPECT_EQ(seen[2], path("there/new"));
  ASSERT_TRUE(outputs.commit().ok());
  EXPECT_TRUE(seen.empty());
  EXPECT_TRUE(content(path("there/new/er/a.mesh")).starts_with("MeshVersion"));
}

TEST_F(WriteMesh, WhatIsInTheWayOfAFolderIsSaid) {
  std::ofstream(path("file")) << "x";
  OutputSet outputs;
  outputs.make_folders();
  for (const char* name : {"file/a.mesh", "file/b/a.mesh"}) {
    EXPECT_NE(write_mesh(outputs, path(name), sample()).error.find("Not a directory"),
              std::string::npos);
    const std::string error = check_writable(path(name), MissingFolder::is_made).error;
    EXPECT_NE(error.find("Not a directory"), std::string::npos) << error;
  }
  EXPECT_EQ(files(), 1U);
}

// Another run may put a file into a folder that this one made, or take one away that it needs.
TEST_F(WriteMesh, FoldersAreSharedWithOtherRuns) {
  OutputSet outputs;
  outputs.make_folders();
  ASSERT_TRUE(write_mesh(outputs, path("out/a.mesh"), sample()).ok());
  {
    OutputSet other;
    other.make_folders();
    ASSERT_TRUE(write_mesh(other, path("out/b.mesh"), sample()).ok());
    ASSERT_TRUE(other.commit().ok());
  }
  ASSERT_TRUE(outputs.commit().ok());
  EXPECT_TRUE(fs::exists(path("out/a.mesh")));
  EXPECT_TRUE(fs::exists(path("out/b.mesh")));
}

TEST_F(WriteMesh, AFullDiskIsReported) {
  if (!fs::exists("/dev/full")) GTEST_SKIP();
  fs::create_symlink("/dev/full", path("full.mesh"));
  OutputSet outputs;
  ASSERT_TRUE(write_mesh(outputs, path("other.mesh"), sample()).ok());
  ASSERT_TRUE(write_mesh(outputs, path("full.mesh"), sample()).ok());
  const WriteStatus status = outputs.commit();
  EXPECT_NE(status.error.find("full.mesh: cannot write"), std::string::npos) << status.error;
  EXPECT_FALSE(fs::exists(path("other.mesh")));  // all or none
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

// A target that cannot be replaced: the targets that were replaced get back their former files.
TEST_F(WriteMesh, RenamingIsUndoneWhereOneFails) {
  std::ofstream(path("a.mesh")) << "old a";
  std::ofstream(path("c.mesh")) << "old c";
  OutputSet outputs;
  for (const char* name : {"a.mesh", "b.mesh", "c.mesh", "d.mesh"}) {
    ASSERT_TRUE(write_mesh(outputs, path(name), sample()).ok());
  }
  fs::create_directories(path("d.mesh/in the way"));
  const WriteStatus status = outputs.commit();
  EXPECT_NE(status.error.find("d.mesh: cannot write"), std::string::npos) << status.error;
  EXPECT_EQ(content(path("a.mesh")), "old a");
  EXPECT_FALSE(fs::exists(path("b.mesh")));
  EXPECT_EQ(content(path("c.mesh")), "old c");
  EXPECT_EQ(files(), 3U);
}

TEST_F(WriteMesh, FormerFilesGoWhenAllAreInPlace) {
  std::ofstream(path("a.mesh")) << "old";
  OutputSet outputs;
  ASSERT_TRUE(write_mesh(outputs, path("a.mesh"), sample()).ok());
  ASSERT_TRUE(write_mesh(outputs, path("b.mesh"), sample()).ok());
  ASSERT_TRUE(outputs.commit().ok());
  EXPECT_EQ(content(path("a.mesh")), content(path("b.mesh")));
  EXPECT_EQ(files(), 2U);
}

TEST_F(WriteMesh, LinksAreFollowed) {
  std::ofstream(path("target.mesh")) << "old";
  fs::create_symlink("target.mesh", path("link.mesh"));
  OutputSet outputs;
  ASSERT_TRUE(write_mesh(outputs, path("link.mesh"), sample()).ok());
  ASSERT_TRUE(outputs.commit().ok());
  EXPECT_TRUE(fs::is_symlink(path("link.mesh")));
  EXPECT_TRUE(content(path("target.mesh")).starts_with("MeshVersion"));
}

TEST(MeshFilesOf, Extensions) {
  using Files = std::vector<std::string>;
  for (const char* path : {"a.mesh", "a/b.MSH", "a.vtu", "a.b.tet", "a.off", "a.inp", "a.BDF"}) {
    EXPECT_EQ(mesh_files_of(path), Files({path}));
  }
  EXPECT_EQ(mesh_files_of("x/a.node"), Files({"x/a.node", "x/a.ele", "x/a.face"}));
  for (const char* path : {"a.obj", "mesh", "a.ele"}) EXPECT_EQ(mesh_files_of(path), Files());
  EXPECT_EQ(mesh_extensions(),
            ".mesh, .msh, .vtu, .vtk, .xdmf, .inp, .bdf, .node, .tet, .stl, .ply or .off");
}

TEST_F(WriteMesh, UnknownExtensionsAreRefused) {
  OutputSet outputs;
  EXPECT_EQ(write_mesh(outputs, "a.obj", sample()).error,
            "a.obj: unknown mesh format (" + mesh_extensions() + ")");
}

}  // namespace
}  // namespace delmesher::io
