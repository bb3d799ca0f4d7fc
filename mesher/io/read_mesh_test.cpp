#include "mesher/io/read_mesh.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

namespace delmesher::io::read_mesh_test {
namespace {

namespace fs = std::filesystem;

// Two tetrahedra on both sides of a face, which is listed with three of the hull.
TetMesh pair() {
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.2, 1e300}, {-0.0, 1e-320, -1.25}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  mesh.inside = {1, 1};
  mesh.boundary = {{0, 1, 2}, {1, 2, 3}, {0, 3, 2}, {4, 1, 2}};
  mesh.boundary_labels = {-7, 5, 5, 0};
  mesh.boundary_facets = {4294967290U, 0, 3, 9};
  return mesh;
}

class Files : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("read_mesh_test_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
  }
  std::string text(const std::string& name) const {
    std::ifstream in(path(name));
    return {std::istreambuf_iterator<char>(in), {}};
  }

  // As it is when it has been written and read.
  TetMesh again(const TetMesh& mesh, const std::string& extension) const {
    MeshReadResult as[2];
    for (const bool ascii : {false, true}) {
      const WriteStatus status = write_mesh(path("a" + extension), mesh, {}, {.ascii = ascii});
      EXPECT_TRUE(status.ok()) << status.error;
      as[ascii ? 1 : 0] = read_mesh(path("a" + extension));
      EXPECT_TRUE(as[ascii ? 1 : 0].ok()) << as[ascii ? 1 : 0].error;
    }
    const TetMesh &bytes = as[0].mesh, &text = as[1].mesh;
    EXPECT_EQ(bytes.vertices, text.vertices);
    EXPECT_EQ(bytes.tetrahedra, text.tetrahedra);
    EXPECT_EQ(bytes.inside, text.inside);
    EXPECT_EQ(bytes.regions, text.regions);
    EXPECT_EQ(bytes.boundary, text.boundary);
    EXPECT_EQ(bytes.boundary_labels, text.boundary_labels);
    EXPECT_EQ(bytes.boundary_facets, text.boundary_facets);
    return std::move(as[0].mesh);
  }

  fs::path folder_;
};

using Cell = std::pair<std::array<std::uint32_t, 4>, std::pair<int, int>>;

// Formats may order cells by region or facet.
std::multiset<Cell> tetrahedra(const TetMesh& mesh) {
  std::multiset<Cell> cells;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const int region = mesh.regions.empty() ? (mesh.inside[t] != 0 ? 1 : 2) : mesh.regions[t];
    cells.insert({mesh.tetrahedra[t], {mesh.inside[t], region}});
  }
  return cells;
}

using Triangle = std::tuple<std::array<std::uint32_t, 3>, std::int32_t, std::uint32_t>;
std::multiset<Triangle> triangles(const TetMesh& mesh) {
  std::multiset<Triangle> cells;
  for (std::size_t n = 0; n < mesh.boundary.size(); ++n) {
    cells.insert({mesh.boundary[n], mesh.boundary_labels[n], mesh.boundary_facets[n]});
  }
  return cells;
}

TEST_F(Files, AreReadAsTheyWereWritten) {
  for (const char* extension : {".mesh", ".msh", ".vtu", ".node", ".tet"}) {
    SCOPED_TRACE(extension);
    const TetMesh mesh = again(pair(), extension);
    EXPECT_EQ(mesh.vertices, pair().vertices);
    EXPECT_EQ(tetrahedra(mesh), tetrahedra(pair()));
    EXPECT_TRUE(mesh.regions.empty());
    if (std::string(extension) == ".tet") continue;
    EXPECT_EQ(triangles(mesh), triangles(pair()));
  }
}

// One of two labels with the same name gets a number.
TEST_F(Files, KeepNamesOfLabels) {
  const LabelNames given = {{-7, "in & <out> 'x'"}, {5, "in & <out> 'x'"}, {0, "0"}};
  const LabelNames names = {{-7, "in & <out> 'x'"}, {5, "in & <out> 'x' 2"}, {0, "0"}};
  for (const char* extension : {".msh", ".vtu"}) {
    for (const bool ascii : {false, true}) {
      ASSERT_TRUE(write_mesh(path("a") + extension, pair(), given, {.ascii = ascii}).ok());
      EXPECT_EQ(read_mesh(path("a") + extension).names, names) << extension;
    }
  }
}

TEST_F(Files, KeepRegions) {
  TetMesh given = pair();
  for (const std::vector<std::int32_t>& regions :
       {std::vector<std::int32_t>{0, 0}, {-5, 2147483647}, {2, 1}, {3, 3}}) {
    given.regions = regions;
    for (const char* extension : {".mesh", ".msh", ".vtu", ".node"}) {
      SCOPED_TRACE(extension);
      const TetMesh mesh = again(given, extension);
      EXPECT_EQ(tetrahedra(mesh), tetrahedra(given));
      EXPECT_EQ(triangles(mesh), triangles(given));
    }
  }
}

TEST_F(Files, KeepNamesOfRegions) {
  TetMesh given = pair();
  for (const std::vector<std::int32_t>& regions :
       {std::vector<std::int32_t>{0, 7}, {-5, 2147483647}, {2, 1}}) {
    given.regions = regions;
    const LabelNames names = {{regions[0], "steel"}, {regions[1], "inside"}};
    for (const char* extension : {".msh", ".vtu"}) {
      for (const bool ascii : {false, true}) {
        SCOPED_TRACE(extension);
        const std::string file = path("a") + extension;
        ASSERT_TRUE(write_mesh(file, given, {}, {.ascii = ascii, .region_names = names}).ok());
        const MeshReadResult back = read_mesh(file);
        EXPECT_EQ(back.region_names, names);
        EXPECT_EQ(tetrahedra(back.mesh), tetrahedra(given));
      }
    }
  }
  given.regions.clear();
  ASSERT_TRUE(write_mesh(path("a.msh"), given).ok());
  EXPECT_TRUE(read_mesh(path("a.msh")).region_names.empty());
}

TEST_F(Files, TellTheOutsideWhereTheFormatDoes) {
  TetMesh given = pair();
  given.inside = {0, 1};
  for (const char* extension : {".msh", ".vtu", ".tet"}) {
    EXPECT_EQ(tetrahedra(again(given, extension)), tetrahedra(given)) << extension;
  }
  // Elsewhere it is region 2 of any mesh.
  for (const char* extension : {".mesh", ".node"}) {
    EXPECT_EQ(again(given, extension).regions, (std::vector<std::int32_t>{2, 1})) << extension;
    EXPECT_EQ(again(given, extension).inside, (std::vector<std::uint8_t>{1, 1})) << extension;
  }
}

TEST_F(Files, OfTetgenStandTogether) {
  ASSERT_TRUE(write_mesh(path("a.node"), pair()).ok());
  EXPECT_EQ(tetrahedra(read_mesh(path("a.ele")).mesh), tetrahedra(pair()));
  fs::remove(path("a.face"));
  EXPECT_TRUE(read_mesh(path("a.node")).mesh.boundary.empty());
  fs::remove(path("a.ele"));
  EXPECT_EQ(read_mesh(path("a.node")).error,
            path("a.node") + ": there is no " + path("a.ele") + " beside it");
  fs::remove(path("a.node"));
  EXPECT_NE(read_mesh(path("a.ele")).error.find("a.node: cannot open"), std::string::npos);
  // Numbered from 1, with attributes, markers and the neighbours of `tetgen -nn`.
  write("b.node", "# points\n4 3 1 1\n1 0 0 0 0.5 7\n2 1 0 0 0.5 7\n3 0 1 0 1 7\n4 0 0 1 1 7\n");
  write("b.ele", "1 4 1\n1 1 2 3 4 -3.0\n# Generated\n");
  write("b.face", "1 1\n1 1 2 3 8 -1 1\n");
  const MeshReadResult result = read_mesh(path("b.node"));
  ASSERT_TRUE(result.ok()) << result.error;
  EXPECT_EQ(result.mesh.tetrahedra, (std::vector<std::array<std::uint32_t, 4>>{{0, 1, 2, 3}}));
  EXPECT_EQ(result.mesh.regions, (std::vector<std::int32_t>{-3}));
  EXPECT_EQ(triangles(result.mesh), (std::multiset<Triangle>{{{0, 1, 2}, 8, 0}}));
}

constexpr const char* kGmsh2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"left, or so\"\n"
    "$EndPhysicalNames\n$Nodes\n4\n10 0 0 0\n20 1 0 0\n5 0 1 0\n7 0 0 1\n$EndNodes\n"
    "$Elements\n4\n1 15 2 0 1 10\n2 1 2 0 1 10 20\n3 2 2 3 6 10 20 5\n4 4 2 7 1 10 20 5 7\n"
    "$EndElements\n";

constexpr const char* kGmsh4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\nwhatever\n$EndComments\n"
    "$Entities\n1 0 1 2\n1 0 0 0 0\n6 0 0 0 1 1 1 1 3 1 -2\n"
    "1 0 0 0 1 1 1 0 1 6\n2 0 0 0 1 1 1 2 -7 8 0\n$EndEntities\n"
    "$Nodes\n2 4 1 4\n0 1 0 1\n3\n0 0 1\n2 6 1 3\n1\n2\n4\n0 0 0 0.5 0.5\n1 0 0 0.5 0.5\n"
    "0 1 0 0.5 0.5\n$EndNodes\n"
    "$Elements\n3 4 1 4\n0 1 15 1\n1 3\n2 6 2 1\n3 1 2 4\n3 2 4 1\n4 1 2 4 3\n$EndElements\n";

TEST_F(Files, OfGmshAreRead) {
  write("a.msh", kGmsh2);
  const MeshReadResult two = read_mesh(path("a.msh"));
  ASSERT_TRUE(two.ok()) << two.error;
  EXPECT_EQ(two.mesh.tetrahedra[0], (std::array<std::uint32_t, 4>{0, 1, 2, 3}));
  EXPECT_EQ(two.mesh.regions, (std::vector<std::int32_t>{7}));
  EXPECT_EQ(triangles(two.mesh), (std::multiset<Triangle>{{{0, 1, 2}, 3, 5}}));
  EXPECT_EQ(two.mesh.vertices[3], (std::array<double, 3>{0, 0, 1}));
  write("b.msh", kGmsh4);
  MeshReadResult four = read_mesh(path("b.msh"));
  ASSERT_TRUE(four.ok()) << four.error;
  EXPECT_EQ(four.mesh.tetrahedra[0], (std::array<std::uint32_t, 4>{1, 2, 3, 0}));
  EXPECT_EQ(four.mesh.regions, (std::vector<std::int32_t>{7}));  // the first group, unsigned
  EXPECT_EQ(triangles(four.mesh), (std::multiset<Triangle>{{{1, 2, 3}, 3, 5}}));
  EXPECT_EQ(four.mesh.vertices[0], (std::array<double, 3>{0, 0, 1}));
  // Without a group, the entity tells.
  std::string text = kGmsh4;
  text.replace(text.find("2 -7 8"), 6, "0     ");
  write("b.msh", text);
  four = read_mesh(path("b.msh"));
  EXPECT_EQ(four.mesh.regions, (std::vector<std::int32_t>{2}));
}

TEST_F(Files, AFacetOfSeveralLabelsIsDivided) {
  TetMesh given = pair();
  given.boundary_facets = {4, 4, 4, 4};
  EXPECT_EQ(again(given, ".mesh").boundary_facets, (std::vector<std::uint32_t>{0, 1, 1, 2}));
}

struct Garbage {
  const char* law;
  const char* name;
  std::string text;
  const char* error;  // after the path and ':' or ": "
};

void PrintTo(const Garbage& garbage, std::ostream* stream) {
  *stream << garbage.law;
}

class BadMeshes : public testing::TestWithParam<Garbage> {};

TEST_P(BadMeshes, AreRefusedWithFileAndLine) {
  const FileBeside beside = [](const char* extension) -> std::optional<std::string> {
    return std::string_view(extension) == ".ele" ? std::optional("1 4 0\n0 0 1 2 9\n")
                                                 : std::nullopt;
  };
  const MeshReadResult result = parse_mesh(GetParam().text, GetParam().name, beside);
  EXPECT_EQ(result.code, ReadCode::unreadable);
  EXPECT_EQ(result.error, GetParam().error);
  EXPECT_TRUE(result.mesh.vertices.empty());
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  text.replace(text.find(what), what.size(), by);
  return text;
}

const std::string kMedit =
    "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
    "Triangles\n1\n1 2 3 5\nTetrahedra\n1\n1 2 3 4 1\nEnd\n# TriangleFacets 1\n# 8\n";
const std::string kTet = "4 vertices\n1 tets\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 0 1 2 3\n";
const std::string kNode = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n";

const Garbage kGarbage[] = {
    {"UnknownFormat", "a.xyz", "",
     "a.xyz: not a known mesh format (.mesh, .msh, .vtu, .node, .ele or .tet)"},
    {"EmptyMedit", "a.mesh", "", "a.mesh: the file is empty"},
    {"Plane", "a.mesh", replaced(kMedit, "Dimension 3", "Dimension 2"),
     "a.mesh:2: dimension 2, not 3"},
    {"UnknownSection", "a.mesh", replaced(kMedit, "Triangles", "Nonsense"),
     "a.mesh:9: unknown section 'Nonsense'"},
    {"Hexahedra", "a.mesh", replaced(kMedit, "Triangles", "Hexahedra"),
     "a.mesh:10: a section of 'Hexahedra': a mesh of tetrahedra is expected"},
    {"IndexZero", "a.mesh", replaced(kMedit, "1 2 3 4 1", "0 2 3 4 1"),
     "a.mesh:14: vertex index out of range: 0 of 4 (numbered from 1)"},
    {"IndexTooLarge", "a.mesh", replaced(kMedit, "1 2 3 5", "1 2 5 5"),
     "a.mesh:11: vertex index out of range: 5 of 4 (numbered from 1)"},
    {"BadNumber", "a.mesh", replaced(kMedit, "0 1 0 0", "0 l 0 0"), "a.mesh:7: bad number 'l'"},
    {"NotFinite", "a.mesh", replaced(kMedit, "0 1 0 0", "0 inf 0 0"),
     "a.mesh:7: non-finite coordinate 'inf'"},
    {"TooManyPromised", "a.mesh", replaced(kMedit, "Tetrahedra\n1", "Tetrahedra\n900"),
     "a.mesh:13: the file is too short for the number of tetrahedra 900"},
    {"Negative", "a.mesh", replaced(kMedit, "Tetrahedra\n1", "Tetrahedra\n-1"),
     "a.mesh:13: bad number of tetrahedra '-1'"},
    {"NoTetrahedra", "a.mesh", replaced(kMedit, "Tetrahedra\n1\n1 2 3 4 1\n", ""),
     "a.mesh: no tetrahedra"},
    {"FacetsOfOthers", "a.mesh", replaced(kMedit, "Facets 1", "Facets 0"),
     "a.mesh:16: 0 facets for 1 triangles"},
    {"BadFacet", "a.mesh", replaced(kMedit, "# 8", "# x"), "a.mesh:17: bad facet 'x'"},
    {"TetWithoutHeader", "a.tet", "hello", "a.tet:1: bad number of vertices 'hello'"},
    {"TetOfFive", "a.tet", replaced(kTet, "4 0 1", "5 0 1"), "a.tet:7: a cell of not 4 corners"},
    {"TetOutOfRange", "a.tet", replaced(kTet, "4 0 1 2 3", "4 0 1 2 4"),
     "a.tet:7: vertex index out of range: 4 of 4 (numbered from 0)"},
    {"TetCut", "a.tet", replaced(kTet, " 3\n", ""),
     "a.tet:7: the file ends where a vertex is expected"},
    {"NodeNumbers", "a.node", replaced(kNode, "2 0 1 0", "3 0 1 0"),
     "a.node:4: number 3 where 2 is expected"},
    {"NodePlane", "a.node", replaced(kNode, "4 3", "4 2"), "a.node:1: dimension 2, not 3"},
    {"NodeShort", "a.node", replaced(kNode, "2 0 1 0", "2 0 1"),
     "a.node:4: a coordinate is missing"},
    {"EleOutOfRange", "a.node", kNode,
     "a.ele:2: vertex index out of range: 9 of 4 (numbered from 0)"},
    {"GmshBinary", "a.msh", replaced(kGmsh4, "4.1 0 8", "4.1 1 8"),
     "a.msh:2: bytes in big-endian order are not read: save as text (gmsh -bin 0)"},
    {"GmshBinary2", "a.msh", replaced(kGmsh2, "2.2 0 8", "2.2 1 8"),
     "a.msh:2: binary .msh files are read of version 4.1 alone: save as text (gmsh -bin 0)"},
    {"GmshVersion", "a.msh", replaced(kGmsh4, "4.1 0", "4.0 0"),
     "a.msh:2: version '4.0' is not read, only 4.1 and 2.2"},
    {"GmshWithoutFormat", "a.msh", "$Nodes\n0\n$EndNodes\n",
     "a.msh:1: $MeshFormat is expected, not '$Nodes'"},
    {"GmshEmpty", "a.msh", "", "a.msh: the file is empty"},
    {"GmshBlank", "a.msh", "\n", "a.msh:1: no $MeshFormat: not a file of Gmsh"},
    {"GmshNoSuchNode", "a.msh", replaced(kGmsh2, "7 1 10 20 5 7", "7 1 10 20 5 8"),
     "a.msh:20: there is no node with the tag 8"},
    {"GmshNodeTwice", "a.msh", replaced(kGmsh2, "\n20 1", "\n10 1"),
     "a.msh:13: two nodes have the tag 10"},
    {"GmshPrism", "a.msh", replaced(kGmsh2, "4 4 2 7", "4 6 2 7"),
     "a.msh:20: elements of type 6: a mesh of tetrahedra of first or second order is expected"},
    {"GmshCornerOnAnEdge", "a.msh",
     replaced(kGmsh2, "4 4 2 7 1 10 20 5 7", "4 11 2 7 1 10 20 5 7 10 20 5 7 10 20"),
     "a.msh: node 0 (numbered from 0) is a corner of an element, and of another one in the middle "
     "of an edge"},
    {"GmshCut", "a.msh", replaced(kGmsh2, "$EndElements\n", ""),
     "a.msh:20: the file ends where $EndElements is expected"},
    {"VtuWithoutFile", "a.vtu", "<xml>", "a.vtu:1: no VTKFile: not a file of VTK"},
    {"VtuOfPolygons", "a.vtu", "\n<VTKFile type=\"PolyData\">",
     "a.vtu:2: not an unstructured grid"},
    {"VtuShort", "a.vtu",
     "<VTKFile type=\"UnstructuredGrid\">\n<Piece>\n<Points>\n"
     "<DataArray type=\"Float64\" format=\"binary\">CAAAAAAAAAA=</DataArray>",
     "a.vtu:4: an array of 4 bytes, but 8 were announced"},
    {"VtuNoBase64", "a.vtu",
     "<VTKFile type=\"UnstructuredGrid\">\n<Piece>\n<Points>\n"
     "<DataArray type=\"Float64\" format=\"binary\">1 2</DataArray>",
     "a.vtu:4: an array that is not in base 64"},
};

INSTANTIATE_TEST_SUITE_P(ReadMesh, BadMeshes, testing::ValuesIn(kGarbage),
                         [](const auto& garbage) { return std::string(garbage.param.law); });

// In every format, a file cut anywhere or with a changed byte gives a mesh in range or one line.
TEST_F(Files, DamagedAnywhereAreRefusedOrRead) {
  std::size_t refused = 0;
  for (const std::string name :
       {".mesh", ".msh", ".vtu", ".node", ".tet", ".msh ascii", ".vtu ascii"}) {
    const std::string extension = name.substr(0, name.find(' '));
    const WriteOptions options = {.ascii = extension != name};
    ASSERT_TRUE(write_mesh(path("a" + extension), pair(), {}, options).ok());
    const std::string whole = text("a" + extension);
    const FileBeside beside = [&](const char* other) {
      return std::optional(text(std::string("a") + other));
    };
    for (std::size_t at = 0; at < whole.size(); ++at) {
      std::string changed = whole;
      changed[at] = static_cast<char>("x9- \n"[at % 5]);
      for (const std::string& bytes : {whole.substr(0, at), changed}) {
        const MeshReadResult result = parse_mesh(bytes, std::string("a") + extension, beside);
        if (!result.ok()) {
          ++refused;
          EXPECT_EQ(result.error.find_first_of("\r\n"), std::string::npos);
          EXPECT_EQ(result.error.find("a."), 0U) << result.error;
          continue;
        }
        EXPECT_EQ(result.mesh.inside.size(), result.mesh.tetrahedra.size());
        EXPECT_EQ(result.mesh.boundary_facets.size(), result.mesh.boundary.size());
        for (const auto& t : result.mesh.tetrahedra) {
          EXPECT_LT(*std::max_element(t.begin(), t.end()), result.mesh.vertices.size());
        }
      }
    }
  }
  EXPECT_GT(refused, 2500U);
}

// With --order 2 each edge has a node in its middle, which is not a vertex of the mesh.
TEST_F(Files, OfSecondOrderAreReadByTheirCorners) {
  for (const char* extension : {".mesh", ".msh", ".vtu"}) {
    for (const bool ascii : {false, true}) {
      const std::string file = path(std::string("a") + extension);
      ASSERT_TRUE(write_mesh(file, pair(), {}, {.order = 2, .ascii = ascii}).ok());
      const MeshReadResult read = read_mesh(file);
      ASSERT_TRUE(read.ok()) << read.error;
      EXPECT_EQ(read.order, 2);
      EXPECT_EQ(read.warnings, std::vector<std::string>());
      EXPECT_EQ(read.mesh.vertices, pair().vertices);
      EXPECT_EQ(tetrahedra(read.mesh), tetrahedra(pair())) << extension;
      EXPECT_EQ(triangles(read.mesh), triangles(pair())) << extension;
    }
  }
  ASSERT_TRUE(write_mesh(path("a.mesh"), pair()).ok());
  EXPECT_EQ(read_mesh(path("a.mesh")).order, 1);
}

// Those of TetGen's -o2, with nodes before corners; one is off the middle of its edge.
TEST_F(Files, ACurvedEdgeIsTakenAsStraight) {
  write("a.node",
        "10 3 0 0\n1 0.5 0 0\n2 0 0.5 0\n3 0 0 0.5\n4 0 0 0\n5 1 0 0\n6 0.5 0.5 0.25\n"
        "7 0.5 0 0.5\n8 0 0.5 0.5\n9 0 1 0\n10 0 0 1\n");
  write("a.ele", "1 10 0\n1 4 5 9 10 6 8 7 1 2 3\n");
  const MeshReadResult read = read_mesh(path("a.node"));
  ASSERT_TRUE(read.ok()) << read.error;
  EXPECT_EQ(read.order, 2);
  EXPECT_EQ(read.warnings,
            std::vector<std::string>{"1 curved elements: nodes are up to 0.25 of an edge's length "
                                     "off its middle, and the edges are taken as straight"});
  EXPECT_EQ(read.mesh.tetrahedra, (std::vector<std::array<std::uint32_t, 4>>{{0, 1, 2, 3}}));
  EXPECT_EQ(read.mesh.vertices,
            (std::vector<std::array<double, 3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

// What TetGen 1.5 makes of a tetrahedron with -pQo2, -pQo2nn and -Qo2.
TEST_F(Files, OfTetgenOfSecondOrderHaveTheirLabels) {
  write("a.node",
        "10 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 0.5 0 0.5\n5 0.5 0 0\n6 0 0.5 0\n"
        "7 0 0.5 0.5\n8 0.5 0.5 0\n9 0 0 0.5\n");
  write("a.ele", "1 10 0\n0 0 2 3 1 4 5 6 7 8 9\n");
  for (const char* faces : {"2 1\n0 2 0 1 6 5 8 7\n1 0 2 3 6 7 9 -3\n",
                            "2 1\n0 2 0 1 6 5 8 7 0 -1\n1 0 2 3 6 7 9 -3 0 -1\n"}) {
    write("a.face", faces);
    const MeshReadResult read = read_mesh(path("a.ele"));
    ASSERT_TRUE(read.ok()) << read.error;
    EXPECT_EQ(read.mesh.boundary,
              (std::vector<std::array<std::uint32_t, 3>>{{2, 0, 1}, {0, 2, 3}}));
    EXPECT_EQ(read.mesh.boundary_labels, (std::vector<std::int32_t>{7, -3}));
    EXPECT_EQ(read.warnings, std::vector<std::string>());
  }
  write("a.face", "1 0\n0 2 0 1\n");
  EXPECT_EQ(read_mesh(path("a.ele")).mesh.boundary_labels, (std::vector<std::int32_t>{0}));
}

TEST_F(Files, ReadingStopsWhenAsked) {
  std::string large = "9000 vertices\n1 tets\n";
  for (int v = 0; v < 9000; ++v) large += "0 0 1\n";
  write("a.tet", large + "4 0 1 2 3\n");
  EXPECT_TRUE(read_mesh(path("a.tet"), [] { return true; }).ok());
  EXPECT_EQ(read_mesh(path("a.tet"), [] { return false; }).code, ReadCode::stopped);
}

}  // namespace
}  // namespace delmesher::io::read_mesh_test
