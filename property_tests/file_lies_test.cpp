// Files that are not what their formats say: sections missing, twice, cut short or longer than they
// announce, numbers that are none or wrap around, references to nothing, numbers for cells that the
// format does not give. Another reader might take something else out of them, so each is rejected
// or fails, with a record and without. Those that a record alone shows are marked.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "oracles/verify_command.h"

namespace tetproof::file_lies_test {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// As a text: the file is not there.
const std::string kRemoved = "removed";

// A model, meshed, and its files by extension. A set of files of one mesh is named by its first.
class Meshed {
 public:
  Meshed(const char* name, const char* input, const char* promise,
         std::vector<std::vector<std::string>> sets)
      : folder_(fs::path(TETPROOF_SCRATCH) / "file_lies" /
                testing::UnitTest::GetInstance()->current_test_info()->name()),
        input_((folder_ / name).string()),
        promise_(promise),
        sets_(std::move(sets)) {
    fs::create_directories(folder_);
    std::ofstream(input_) << input;
    std::string command = std::string(DELMESHER_PATH) + " " + promise_ + " -q " + input_ +
                          " --exact " + path("in.exact");
    for (const auto& set : sets_) command += " -o " + path("in." + set[0]);
    EXPECT_EQ(std::system(command.c_str()), 0);
    for (const auto& set : sets_) {
      for (const std::string& extension : set) files_[extension] = read(path("in." + extension));
    }
  }

  const std::map<std::string, std::string>& files() const { return files_; }

  // Exit code of the verification where the file of that extension has this text.
  int verify(const std::string& extension, const std::string& text, bool with_record) const {
    for (const auto& set : sets_) {
      if (std::ranges::find(set, extension) == set.end()) continue;
      for (const std::string& e : set) {
        std::ofstream(path("lie." + e), std::ios::binary) << (e == extension ? text : files_.at(e));
        if (e == extension && text == kRemoved) fs::remove(path("lie." + e));
      }
      return verify(path("lie." + set[0]), with_record);
    }
    ADD_FAILURE() << extension;
    return 0;
  }

 private:
  std::string path(const std::string& name) const { return input_ + "." + name; }

  int verify(const std::string& mesh, bool with_record) const {
    std::vector<std::string> arguments = {"verify", input_, mesh, "--promised", promise_};
    if (with_record) arguments.insert(arguments.end(), {"--exact", path("in.exact")});
    if (!with_record) arguments.emplace_back("--json");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_verify(static_cast<int>(argv.size()), argv.data());
    testing::internal::GetCapturedStdout();
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_LE(std::count(said.begin(), said.end(), '\n'), 1) << said;
    return code;
  }

  fs::path folder_;
  std::string input_, promise_;
  std::vector<std::vector<std::string>> sets_;
  std::map<std::string, std::string> files_;
};

// An L of two boxes with a label for each side.
const char* const kL =
    "12 3\n0 0 0 0\n1 2 0 0\n2 2 1 0\n3 1 1 0\n4 1 2 0\n5 0 2 0\n6 0 0 1\n7 2 0 1\n8 2 1 1\n"
    "9 1 1 1\n10 1 2 1\n11 0 2 1\n8 1\n6 5 4 3 2 1 0 11\n6 6 7 8 9 10 11 12\n4 0 1 7 6 13\n"
    "4 1 2 8 7 14\n4 2 3 9 8 15\n4 3 4 10 9 16\n4 4 5 11 10 17\n4 5 0 6 11 18\n0\n0\n";

// What is outside, too: the mesh of its hull.
const Meshed& in_space() {
  static const Meshed meshed("l.smesh", kL, "mesh --region hull --ascii",
                             {{"mesh"}, {"msh"}, {"vtu"}, {"tet"}, {"node", "ele", "face"}});
  return meshed;
}

// A box of ten-node tetrahedra, in the formats of those that are read.
const Meshed& of_second_order() {
  static const Meshed meshed(
      "box.off",
      "OFF\n8 6 0\n0 0 0\n4 0 0\n4 4 0\n0 4 0\n0 0 1\n4 0 1\n4 4 1\n0 4 1\n4 0 3 2 1\n"
      "4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n",
      "mesh --order 2 --region hull --ascii", {{"mesh"}, {"msh"}, {"vtu"}});
  return meshed;
}

// The same L as bytes.
const Meshed& of_bytes() {
  static const Meshed meshed("l_bytes.smesh", kL, "mesh --region hull", {{"msh"}, {"vtu"}});
  return meshed;
}

// A square with a hole.
const Meshed& in_the_plane() {
  static const Meshed meshed(
      "square.poly",
      "8 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 1 1\n6 3 1\n7 3 3\n8 1 3\n8 1\n1 1 2 5\n2 2 3 5\n"
      "3 3 4 5\n4 4 1 5\n5 5 6 9\n6 6 7 9\n7 7 8 9\n8 8 5 9\n1\n1 2 2\n",
      "plane --region hull --ascii", {{"msh"}, {"vtu"}, {"off"}, {"node", "ele", "poly"}});
  return meshed;
}

// A square within another one, each a region.
const Meshed& of_regions() {
  static const Meshed meshed(
      "regions.poly",
      "8 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 1 1\n6 3 1\n7 3 3\n8 1 3\n8 1\n"
      "1 1 2 5\n2 2 3 5\n3 3 4 5\n4 4 1 5\n5 5 6 9\n6 6 7 9\n7 7 8 9\n8 8 5 9\n"
      "0\n2\n1 0.5 0.5 77\n2 2 2 99\n",
      "plane --ascii", {{"vtu"}, {"off"}, {"node", "ele", "poly"}});
  return meshed;
}

// A tetrahedron of two solids, which have names.
const Meshed& of_names() {
  static const Meshed meshed(
      "names.stl",
      "solid inlet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 "
      "0\nendloop\n"
      "endfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 "
      "1\nendloop\n"
      "endfacet\nendsolid\nsolid out  let\nfacet normal 0 0 0\nouter loop\nvertex 1 0 0\n"
      "vertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nfacet normal 0 0 0\nouter loop\n"
      "vertex 0 1 0\nvertex 0 0 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid\n",
      "mesh --size none --ascii", {{"msh"}, {"vtu"}});
  return meshed;
}

struct Lie {
  const char *extension, *name, *pattern, *replacement;
  int without_record = 3, with_record = 3;  // exit codes
};

const Lie kLies[] = {
    {"mesh", "no end", "End\n", ""},
    {"mesh", "an edge to a vertex beyond the last", "End\n", "Edges\n1\n1 99999 0\nEnd\n"},
    {"mesh", "an edge to no vertex", "End\n", "Edges\n1\n1 0 0\nEnd\n"},
    {"mesh", "a required vertex that wraps around", "End\n",
     "RequiredVertices\n1\n4294967297\nEnd\n"},
    {"mesh", "half a corner", "End\n", "Corners\n1\n1.5\nEnd\n"},
    {"mesh", "a ridge without edges", "End\n", "Ridges\n1\n1\nEnd\n"},
    {"mesh", "a required triangle beyond the last", "End\n", "RequiredTriangles\n1\n99999\nEnd\n"},
    {"mesh", "a normal beyond the last", "End\n",
     "Normals\n1\n0 0 1\nNormalAtVertices\n1\n1 2\nEnd\n"},
    {"mesh", "a normal at no vertex", "End\n",
     "NormalAtVertices\n1\n99999 1\nNormals\n1\n0 0 1\nEnd\n"},
    {"mesh", "half a normal", "End\n",
     "Normals\n2\n0 0 1\n1 0 0\nNormalAtVertices\n1\n1 1.5\nEnd\n"},
    {"mesh", "a tangent where there are none", "End\n", "TangentAtVertices\n1\n1 1\nEnd\n"},
    {"mesh", "a section after the end", "End\n", "End\nTetrahedra\n0\n"},
    {"mesh", "triangles twice", "End\n", "Triangles\n0\nEnd\n"},
    {"mesh", "vertices twice", "End\n", "Vertices\n0\nEnd\n"},
    {"mesh", "facets twice", "# TriangleFacets", "# TriangleFacets 0\n# TriangleFacets"},
    {"mesh", "a facet fewer", "# \\d+\n$", ""},
    {"mesh", "a facet that wraps around", "# (\\d)\n", "# 429496729$1\n# 1\n"},
    {"mesh", "in the plane", "Dimension 3", "Dimension 2"},
    {"mesh", "no dimension", "Dimension 3", ""},
    {"mesh", "version 99", "Formatted 2", "Formatted 99"},
    {"mesh", "a comment that others take for a vertex", "Vertices\n(\\d+)\n",
     "Vertices\n$1\n# 1 1 1 0\n", 0, 1},
    {"mesh", "a label that wraps around", " 11\n", " 4294967307\n"},
    {"mesh", "a number that goes on", "Vertices\n(\\d+)\n0 ", "Vertices\n$1\n0x "},
    {"mesh", "two signs", "Vertices\n(\\d+)\n(\\S+ \\S+ \\S+) 0", "Vertices\n$1\n$2 +-0"},
    {"mesh", "no number", "Vertices\n(\\d+)\n0 ", "Vertices\n$1\nnan ", 1, 1},
    {"tet", "something after the end", "\n$", "\n0 0 0\n"},
    {"tet", "apples for vertices", "vertices", "apples"},
    {"tet", "apples for tetrahedra", "inner tets", "inner apples"},
    {"tet", "neither inner nor outer tetrahedra", "inner tets", "inside tets"},
    {"tet", "a coordinate more", "outer tets\n(\\S+ \\S+ \\S+)\n", "outer tets\n$1 7\n"},
    {"tet", "inner and outer exchanged", "(\\d+) inner tets\n(\\d+) outer tets",
     "$2 inner tets\n$1 outer tets", 1, 1},
    {"vtu", "points without components", " NumberOfComponents=\"3\"", ""},
    {"vtu", "points of two components", "NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""},
    {"vtu", "labels of two components", "Name=\"label\"",
     "Name=\"label\" NumberOfComponents=\"2\""},
    {"vtu", "a tetrahedron on the other side", "Name=\"inside\"([^>]*)>\n0\n",
     "Name=\"inside\"$1>\n1\n", 1, 1},
    {"vtu", "no sides", "<DataArray[^>]*Name=\"inside\"[^/]*</DataArray>\n", "", 0, 1},
    {"vtu", "a side that is none", "Name=\"inside\"([^>]*)>\n[01]\n", "Name=\"inside\"$1>\n7\n"},
    {"vtu", "a side of a triangle", "\n-1\n", "\n1\n"},
    {"vtu", "a label of a tetrahedron", "Name=\"label\"([^>]*)>\n0\n", "Name=\"label\"$1>\n3\n"},
    {"vtu", "a facet of a tetrahedron", "Name=\"facet\"([^>]*)>\n-1\n", "Name=\"facet\"$1>\n3\n"},
    {"vtu", "a label that wraps around", "\n11\n", "\n4294967307\n"},
    {"vtu", "another number of points announced", "NumberOfPoints=\"", "NumberOfPoints=\"1"},
    {"vtu", "another number of cells announced", "NumberOfCells=\"", "NumberOfCells=\"1"},
    {"vtu", "cells in a comment", "<Cells>([^]*)</Cells>", "<!--<Cells>$1</Cells>-->"},
    {"vtu", "a corner after the last cell", "</DataArray>\n(.*Name=\"offsets\")",
     "0\n</DataArray>\n$1"},
    {"vtu", "a coordinate more", "</DataArray>\n</Points>", "0\n</DataArray>\n</Points>"},
    {"vtu", "two numbers of cells", "NumberOfCells=\"", "NumberOfCells=\"1\" NumberOfCells=\""},
    {"vtu", "two numbers of points, the second another", "NumberOfPoints=\"",
     "NumberOfPoints=\"22\" NumberOfPoints=\"1"},
    {"vtu", "a byte order that is none", "LittleEndian", "MiddleEndian"},
    {"vtu", "another number of tuples", "Name=\"label\"", "NumberOfTuples=\"5\" Name=\"label\""},
    {"vtu", "another number of points in their array", "Name=\"Points\"",
     "NumberOfTuples=\"66\" Name=\"Points\""},
    {"vtu", "corners that are not integers", "\"Int64\" Name=\"connectivity\"",
     "\"Float64\" Name=\"connectivity\""},
    {"vtu", "types that are not integers", "\"UInt8\" Name=\"types\"",
     "\"Float32\" Name=\"types\""},
    {"vtu", "something after the end", "\n$", "\nx\n"},
    {"vtu", "a surface instead of a grid", "UnstructuredGrid\"", "PolyData\""},
    {"vtu", "facets of a type without negative numbers", "\"Int(\\d+)\" Name=\"facet\"",
     "\"UInt$1\" Name=\"facet\""},
    {"vtu", "points of a type that is none", "\"Float64\"", "\"Real\""},
    {"vtu", "an element within an array", "Name=\"label\"([^>]*)>\n", "Name=\"label\"$1>\n<X/>"},
    {"vtu", "a coordinate that others take for zero", "\\S+\n(</DataArray>\n</Points>)",
     "0x1p-1\n$1"},
    {"vtu", "a corner that others take for zero", "(Name=\"connectivity\"[^<]*\\s)\\d+(\\s*<)",
     "$010e0$2"},
    {"vtu", "a type with a fraction", "(Name=\"types\"[^<]*\\s)\\d+(\\s*<)", "$015.0$2"},
    {"vtu", "other points in a step in time", "</Points>",
     "<Array type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" TimeStep=\"0\" "
     "format=\"ascii\">9</Array></Points>"},
    {"vtu", "points in a step in time", "Name=\"Points\"", "TimeStep=\"1\" Name=\"Points\""},
    {"vtu", "a grid of steps in time", "<UnstructuredGrid", "<UnstructuredGrid TimeValues=\"0 1\""},
    {"vtu", "other labels in another kind of array", "</CellData>",
     "<Array type=\"Int32\" Name=\"label\" format=\"ascii\">9</Array></CellData>"},
    {"vtu", "sizes of a type that is none", "header_type=\"UInt64\"", "header_type=\"UInt16\""},
    {"vtu", "a type of two lines", "\"Float64\"", "\"Re&#10;al&#x9b;\""},
    {"vtu", "a comment among values", "Name=\"label\"([^>]*)>\n", "Name=\"label\"$1>\n<!--0-->"},
    {"vtu", "values in a marked section", "(Name=\"label\"[^>]*>)([^<]*)<", "$1<![CDATA[$2]]><"},
    {"vtu", "values behind an element", "(Name=\"label\"[^>]*>)([^<]*)<",
     "$1$2<InformationKey/>0\n<"},
    {"vtu", "values between elements", "(Name=\"label\"[^>]*>)([^<]*)<",
     "$1$2<InformationKey/>0\n<InformationKey/><"},
    {"vtu", "a document type", "<VTKFile", "<!DOCTYPE VTKFile><VTKFile"},
    {"vtu", "an attribute twice", "Name=\"label\"", "Name=\"label\" Name=\"label\""},
    {"vtu", "elements that do not nest", "</Piece>\n</UnstructuredGrid>",
     "</UnstructuredGrid>\n</Piece>"},
    {"vtu", "an element that does not end", "<CellData>", "<PointData>\n<CellData>"},
    {"vtu", "cells beside the piece", "<Cells>([^]*)</Cells>([^]*)</Piece>",
     "$2</Piece>\n<Cells>$1</Cells>"},
    {"vtu", "sides in an element that nobody knows",
     "(<DataArray[^>]*Name=\"inside\"[^>]*>[^<]*</DataArray>)", "<Hidden>$1</Hidden>"},
    {"msh", "nodes without an end", "\\$EndNodes\n", ""},
    {"msh", "elements without an end", "\\$EndElements\n", ""},
    {"msh", "a word between sections", "\\$Nodes\n", "foo\n$$Nodes\n"},
    {"msh", "a word after the end", "\n$", "\nfoo\n"},
    {"msh", "elements twice", "(\\$Elements[^]*)$", "$1$1"},
    {"msh", "a name twice", "\n2 11 \"label 11\"", "\n2 11 \"label 11\"\n2 11 \"label 12\""},
    {"msh", "more nodes announced", "\\$Nodes\n1 ", "$$Nodes\n1 1"},
    {"msh", "more elements announced", "\\$Elements\n(\\d+) ", "$$Elements\n$1 1"},
    {"msh", "a larger node announced", "(\\$Nodes\n\\d+ \\d+ 1 \\d+)\n", "$010\n"},
    {"msh", "a smaller node announced", "(\\$Nodes\n\\d+ \\d+) 1 ", "$01 0 "},
    {"msh", "a larger element announced", "(\\$Elements\n\\d+ \\d+ 1 \\d+)\n", "$010\n"},
    {"msh", "a smaller element announced", "(\\$Elements\n\\d+ \\d+) 1 ", "$01 0 "},
    {"msh", "a side of the label that is none", " 1 11 0\n", " 1 0 0\n"},
    {"msh", "version 4.0", "4.1 0 8", "4 0 8"},
    {"msh", "version 3", "4.1 0 8", "3 0 8"},
    {"msh", "no version", "\\$MeshFormat[^]*\\$EndMeshFormat\n", ""},
    {"msh", "nodes of a volume that is not listed", "\\$Nodes\n(.*)\n3 1 0 ",
     "$$Nodes\n$1\n3 7 0 "},
    {"msh", "nodes of a point that is not listed", "\\$Nodes\n(.*)\n3 1 0 ", "$$Nodes\n$1\n0 1 0 "},
    {"msh", "entities after the nodes", "(\\$Entities[^]*)(\\$Nodes[^]*\\$EndNodes\n)", "$2$1"},
    {"msh", "triangles of no entity", "\n2 \\d+ 2 (\\d+)\n", "\n2 77 2 $1\n", 1, 1},
    {"msh", "tetrahedra in a surface", "\n3 \\d+ 4 (\\d+)\n", "\n2 1 4 $1\n"},
    {"msh", "a side of two labels", " 1 11 0\n", " 2 11 12 0\n"},
    {"msh", "a side of a label and of a group without a name", " 1 11 0\n", " 2 11 77 0\n", 0, 1},
    {"msh", "a solid in no group", "\n(1( \\S+){6}) 1 1 ", "\n$1 0 ", 0, 1},
    {"msh", "a solid that is inside and outside", "\n(1( \\S+){6}) 1 1 ", "\n$1 2 1 2 "},
    {"msh", "a label and the solid with one tag", "\n3 1 (\"inside\"[^]*\n1( \\S+){6}) 1 1 ",
     "\n3 11 $1 1 11 ", 0, 1},
    {"msh", "a label that wraps around", "\"label 11\"", "\"label 4294967307\""},
    {"msh", "names of the sides exchanged", "\"inside\"([^]*)\"outside\"",
     "\"outside\"$1\"inside\"", 0, 1},
    {"msh", "names of the sides exchanged, and spelt in another way", "\"inside\"([^]*)\"outside\"",
     "\"Outside the solid\"$1\"inside the solid\"", 0, 1},
    {"node", "in the plane", " 3 0 0", " 2 0 0"},
    {"node", "a coordinate more", "\n(0 \\S+ \\S+ \\S+)\n", "\n$1 5\n"},
    {"node", "something after the end", "\n$", "\njunk\n"},
    {"ele", "a tetrahedron more than announced", "\n$", "\n9999 1 2 3 4 1\n"},
    {"ele", "numbers out of order", "\n1 ", "\n5 "},
    {"ele", "a number more", "\n(0 .*)\n", "\n$1 8\n"},
    {"ele", "regions that are not announced", " 4 1\n", " 4 0\n"},
    {"face", "something after the end", "\n$", "\nx\n"},
    {"face", "two markers", " 1\n", " 2\n"},
    {"face", "a label that wraps around", " 11 ", " 4294967307 "},
    {"face", "half a facet", "( \\d+)\n$", "$1.5\n"},
    {"face", "a facet that wraps around", " (\\d+)\n$", " 429496729$1\n", 0, 1},
};

// The node of an edge of the box from (0 0 0) to (4 0 0) elsewhere, two nodes exchanged, elements
// of both orders.
const Lie kSecondOrderLies[] = {
    {"mesh", "a curved edge", "\n2 0 0 0\n", "\n2 0 0.25 0\n", 1, 1},
    {"msh", "a curved edge", "\n2 0 0\n", "\n2 0 0.25\n", 1, 1},
    {"vtu", "a curved edge", "\n2 0 0\n", "\n2 0 0.25\n", 1, 1},
    {"vtu", "a node on an edge, but not in the middle", "\n2 0 0\n", "\n2.001 0 0\n", 1, 1},
    {"mesh", "an edge with a node that is not a number", "\n2 0 0 0\n", "\nnan 0 0 0\n", 1, 1},
    {"mesh", "nodes exchanged", "(TetrahedraP2\n\\d+\n\\d+ \\d+ \\d+ \\d+) (\\d+) (\\d+) ",
     "$1 $3 $2 "},
    {"mesh", "a corner on an edge", "(TetrahedraP2\n\\d+\n)(\\d+) (\\d+ \\d+ \\d+) (\\d+) ",
     "$1$2 $3 $2 "},
    {"mesh", "linear triangles", "TrianglesP2[^]*TetrahedraP2",
     "Triangles\n1\n1 2 3 0\nTetrahedraP2"},
    {"mesh", "a triangle without its nodes", "TrianglesP2", "Triangles"},
    {"msh", "the edges in the order of others", "(\n3 1 11 \\d+\n\\d+( \\d+){8}) (\\d+) (\\d+)\n",
     "$1 $4 $3\n"},
};

const Lie kPlaneLies[] = {
    {"vtu", "no sides", "<DataArray[^>]*Name=\"inside\"[^/]*</DataArray>\n", ""},
    {"vtu", "a side that is none", "Name=\"inside\"([^>]*)>\n[01]\n", "Name=\"inside\"$1>\n7\n"},
    {"vtu", "a side of a line", "\n-1\n", "\n1\n"},
    {"vtu", "a marker of a triangle", "Name=\"marker\"([^>]*)>\n0\n", "Name=\"marker\"$1>\n7\n"},
    {"vtu", "a segment of a triangle", "Name=\"segment\"([^>]*)>\n-1\n",
     "Name=\"segment\"$1>\n0\n"},
    {"vtu", "no markers", "<DataArray[^>]*Name=\"marker\"[^/]*</DataArray>\n", ""},
    {"vtu", "no segments", "<DataArray[^>]*Name=\"segment\"[^/]*</DataArray>\n", ""},
    {"vtu", "a marker that wraps around", "\n9\n([^]*\"segment\")", "\n4294967305\n$1"},
    {"off", "something after the end", "\n$", "\n1 2 3\n"},
    {"off", "a number more", "\n(3 \\d+ \\d+ \\d+)\n", "\n$1 9\n"},
    {"off", "out of the plane", "\n(\\S+ \\S+) 0\n", "\n$1 0.5\n"},
    {"node", "in space", " 2 0 0", " 3 0 0"},
    {"node", "something after the end", "\n$", "\n8\n"},
    {"node", "a number more", "\n(0 \\S+ \\S+)\n", "\n$1 0\n"},
    {"ele", "something after the end", "\n$", "\n8\n"},
    {"ele", "an attribute that is not a side", "\n(0 \\d+ \\d+ \\d+) [12]\n", "\n$1 7\n"},
    {"ele", "sides that are not announced", " 3 1\n", " 3 0\n"},
    {"poly", "no holes", "\n1\n0 2 2\n$", "\n0\n", 1, 1},
    {"poly", "a hole elsewhere", "\n0 2 2\n", "\n0 2 2.5\n", 1, 1},
    {"poly", "a hole twice", "\n1\n0 2 2\n", "\n2\n0 2 2\n1 2 2\n", 1, 1},
    {"poly", "a region", "\n$", "\n1\n0 0.5 0.5 7\n", 1, 1},
    {"poly", "two markers of a segment", " 5\n", " 5 9\n"},
    {"poly", "vertices of its own", "^0 2 0 0", "1 2 0 0"},
    {"poly", "in space", "^0 2 0 0", "0 3 0 0"},
    {"poly", "a marker that wraps around", " 5\n", " 4294967301\n"},
    {"poly", "something after the end", "\n$", "\njunk\n"},
    {"msh", "names of the sides exchanged", "\"inside\"([^]*)\"outside\"",
     "\"outside\"$1\"inside\""},
    {"msh", "another marker", "\"marker 5\"", "\"marker 6\"", 1, 1},
    {"msh", "a marker that wraps around", "\"marker 5\"", "\"marker 4294967301\""},
    {"msh", "a marker that goes on", "\"marker 5\"", "\"marker 5x\""},
    {"msh", "no marker", "\"marker 5\"", "\"side\""},
    {"msh", "elements without an end", "\\$EndElements\n", ""},
};

const Lie kRegionLies[] = {
    {"ele", "an attribute of another region", "\n(0 \\d+ \\d+ \\d+) (77|99)\n", "\n$1 88\n", 1, 1},
    {"ele", "the attributes of a region exchanged", " 77\n([^]*) 99\n", " 99\n$1 77\n", 1, 1},
    {"vtu", "an attribute of another region", "(Name=\"attribute\"[^>]*)>\n(77|99)\n", "$1>\n88\n",
     1, 1},
    {"vtu", "no attributes", "<DataArray[^>]*Name=\"attribute\"[^/]*</DataArray>\n", "", 0, 1},
};

const Lie kNameLies[] = {
    {"msh", "names exchanged", "\"inlet\"([^]*)\"out +let\"", "\"out let\"$1\"inlet\"", 0, 1},
    {"msh", "the name of another set", "\"inlet\"", "\"wing\"", 0, 1},
    {"vtu", "the name of another set", "Name=\"inlet\"", "Name=\"wing\"", 0, 1},
    {"vtu", "another name in a second field", "<Piece ",
     "<FieldData><DataArray type=\"Int64\" Name=\"wing\" NumberOfTuples=\"2\" format=\"ascii\">1 2"
     "</DataArray></FieldData><Piece ",
     0, 1},
    {"msh", "a solid that is called by the name of a side of it", "\"inside\"", "\"inlet\"", 0, 1},
    {"vtu", "no names", "<FieldData>[^]*</FieldData>\n", "", 0, 1},
    {"vtu", "two sets of one name", "<FieldData>([^]*)out +let", "<FieldData>$1inlet", 0, 1},
};

TEST(FileLies, HonestFilesPass) {
  for (const Meshed* model :
       {&in_space(), &of_second_order(), &in_the_plane(), &of_regions(), &of_names()}) {
    for (const auto& [extension, text] : model->files()) {
      for (const bool with_record : {false, true}) {
        EXPECT_EQ(model->verify(extension, text, with_record), 0) << extension;
      }
      const std::string windows = std::regex_replace(text, std::regex("\n"), "\r\n");
      EXPECT_EQ(model->verify(extension, windows, true), 0) << extension;
    }
  }
}

// Comments, and sections that say nothing here, as other programs write them.
TEST(FileLies, HonestFilesOfOthersPass) {
  const Lie changes[] = {
      {"mesh", "", "End\n", "Edges\n1\n1 2 0\nRidges\n1\n1\nRequiredVertices\n2\n1\n2\nEnd\n"},
      {"mesh", "", "End\n", "End\n# another comment\n"},
      {"mesh", "", "End\n", "NormalAtVertices\n2\n1 2\n2 2\nNormals\n2\n0 0 1\n1 0 0\nEnd\n"},
      {"msh", "", "\\$Nodes\n", "$$Comments\nsome words\n$$EndComments\n$$Nodes\n"},
      {"vtu", "", "<VTKFile", "<!--by another program <Points>--><VTKFile"},
      {"vtu", "", "<CellData>", "<PointData></PointData>\n<CellData>"},
      {"vtu", "", "<DataArray ", "<DataArray other=\" Name=\" "},
      {"vtu", "", "<DataArray ", "<DataArray other=' Name=\"label\" > '\n"},
      {"vtu", "", "Name=\"inside\"", "Name = 'in&#115;ide'"},
      {"vtu", "", "<Cells>", "<?note?><Cells><![CDATA[ ]]>"},
      {"vtu", "", "</DataArray>",
       "<InformationKey name=\"RANGE\"><Value>7</Value></InformationKey></DataArray>"},
      {"node", "", "\n$", "\n# Generated by another program\n"}};
  for (const Lie& change : changes) {
    const std::string& written = in_space().files().at(change.extension);
    const std::string changed =
        std::regex_replace(written, std::regex(change.pattern), change.replacement);
    ASSERT_TRUE(changed != written) << change.replacement;
    EXPECT_EQ(in_space().verify(change.extension, changed, true), 0) << change.replacement;
  }
}

void tell(const Meshed& model, const Lie& lie) {
  SCOPED_TRACE(std::string(lie.extension) + ": " + lie.name);
  const std::string& honest = model.files().at(lie.extension);
  const std::string changed = std::regex_replace(honest, std::regex(lie.pattern), lie.replacement,
                                                 std::regex_constants::format_first_only);
  ASSERT_TRUE(changed != honest);
  EXPECT_EQ(model.verify(lie.extension, changed, false), lie.without_record);
  EXPECT_EQ(model.verify(lie.extension, changed, true), lie.with_record);
}

TEST(FileLies, AreRefused) {
  for (const Lie& lie : kLies) tell(in_space(), lie);
  for (const Lie& lie : kSecondOrderLies) tell(of_second_order(), lie);
  for (const Lie& lie : kPlaneLies) tell(in_the_plane(), lie);
  for (const Lie& lie : kRegionLies) tell(of_regions(), lie);
  for (const Lie& lie : kNameLies) tell(of_names(), lie);
}

// A box that was rotated and rounded to four decimals, so that its facets are planar within more
// than `auto` takes without evidence. Each file says its number; a record, which says it as well,
// is believed only where that is less.
TEST(FileLies, SayHowFarFacetsAreFromPlanar) {
  const Meshed model("turned.off",
                     "OFF\n8 12 0\n0 0 0\n1.9182 0.7780 2.1714\n-1.0422 1.6768 0.3199\n"
                     "0.8761 2.4548 2.4913\n-0.5654 -0.4794 0.6712\n1.3529 0.2986 2.8426\n"
                     "-1.6075 1.1973 0.9911\n0.3107 1.9754 3.1625\n3 0 2 3\n3 0 3 1\n3 4 5 7\n"
                     "3 4 7 6\n3 0 1 5\n3 0 5 4\n3 2 6 7\n3 2 7 3\n3 0 4 6\n3 0 6 2\n3 1 3 7\n"
                     "3 1 7 5\n",
                     "mesh --ascii", {{"mesh"}, {"msh"}, {"vtu"}, {"node", "ele", "face"}});
  for (const char* const extension : {"mesh", "msh", "vtu", "node"}) {
    const std::string& honest = model.files().at(extension);
    EXPECT_EQ(model.verify(extension, honest, false), 0) << extension;
    EXPECT_EQ(model.verify(extension, honest, true), 0) << extension;
    const char* const number = "(PlanarWithin( |[^>\n]*>\\s*))[-0-9.e]+";
    for (const Lie& lie : {Lie{extension, "less than the facets are", number, "$011e-12", 1, 1},
                           {extension, "more than auto may", number, "$010.0003", 1, 0},
                           {extension, "nothing", "PlanarWithin", "OtherNumber", 1, 0},
                           {extension, "a negative one", number, "$01-1e-5", 3, 3},
                           {extension, "zero", number, "$010", 3, 3},
                           {extension, "a word", number, "$01less", 3, 3}}) {
      tell(model, lie);
    }
  }
  const char* const line = "(# PlanarWithin.*\n)";
  tell(model, {"mesh", "twice", line, "$01$01", 3, 3});
  tell(model, {"node", "twice", line, "$01$01", 3, 3});
  tell(model, {"msh", "twice", "(PlanarWithin.*\n)", "$01$01", 3, 3});
  tell(model, {"vtu", "twice", "(<DataArray[^>]*PlanarWithin[^/]*</DataArray>)", "$01$01", 3, 3});
}

// Files of others often have names in Latin-1, which XML cannot have, and which Python refuses.
TEST(FileLies, NamesInLatin1BecomeUtf8) {
  std::string stl;
  const char* const kSides[] = {
      "0 0 0\nvertex 0 1 0\nvertex 1 0 0", "0 0 0\nvertex 1 0 0\nvertex 0 0 1",
      "1 0 0\nvertex 0 1 0\nvertex 0 0 1", "0 1 0\nvertex 0 0 0\nvertex 0 0 1"};
  for (int side = 0; side < 4; ++side) {
    stl += (side == 0   ? "solid Einla\xdf\n"
            : side == 1 ? "endsolid\nsolid \xc3\xa9t\xc3\xa9\n"
                        : "");
    stl += std::string("facet normal 0 0 0\nouter loop\nvertex ") + kSides[side] +
           "\nendloop\nendfacet\n";
  }
  const Meshed model("latin1.stl", (stl + "endsolid\n").c_str(), "mesh --ascii",
                     {{"msh"}, {"vtu"}});
  for (const auto& [extension, text] : model.files()) {
    EXPECT_NE(text.find("\"Einla\xc3\x9f\""), std::string::npos);
    EXPECT_NE(text.find("\"\xc3\xa9t\xc3\xa9\""), std::string::npos);
    EXPECT_EQ(model.verify(extension, text, true), 0);
    const char* const of = extension == "msh" ? "msh" : "vtu";
    tell(model, {of, "twice in UTF-8", "\xc3\x9f", "\xc3\x83\xc2\x9f", 0, 1});
    tell(model, {of, "the other name in UTF-8 again", "\xc3\xa9t", "\xc3\x83\xc2\xa9t", 0, 1});
  }
  tell(model, {"vtu", "in Latin-1", "\xc3\x9f", "\xdf"});
  tell(model, {"msh", "in Latin-1 with a letter more", "\xc3\x9f", "\xdf!", 0, 1});
}

// Some readers make numbers of 4 bytes of all coordinates of such a file.
TEST(FileLies, CoordinatesOfMoreThanTheAnnouncedPrecision) {
  const Meshed tenth(
      "tenth.smesh",
      "4 3\n0 0 0 0\n1 0.1 0 0\n2 0 0.1 0\n3 0 0 0.1\n4 0\n3 0 2 1\n3 0 1 3\n3 1 2 3\n"
      "3 2 0 3\n0\n0\n",
      "mesh", {{"mesh"}});
  tell(tenth, {"mesh", "numbers of 4 bytes announced", "Formatted 2", "Formatted 1", 0, 1});
}

// The triangles of the inner square left out, with the vertices that no other one has.
TEST(FileLies, ARegionThatIsMissingIsMissed) {
  std::istringstream text(of_regions().files().at("off"));
  std::string word;
  std::size_t vertices = 0, faces = 0;
  text >> word >> vertices >> faces >> word;
  std::vector<std::array<double, 3>> points(vertices);
  for (auto& p : points) text >> p[0] >> p[1] >> p[2];
  std::map<std::size_t, std::size_t> number;
  std::ostringstream made_points, made_faces;
  std::size_t left = 0;
  for (std::size_t f = 0; f < faces; ++f) {
    std::array<std::size_t, 3> v{};
    text >> word >> v[0] >> v[1] >> v[2];
    std::array<double, 2> m{};
    for (const std::size_t c : v) {
      for (std::size_t k = 0; k < 2; ++k) m[k] += points[c][k] / 3;
    }
    if (m[0] > 1 && m[0] < 3 && m[1] > 1 && m[1] < 3) continue;
    ++left;
    made_faces << 3;
    for (const std::size_t c : v) {
      const auto [found, fresh] = number.emplace(c, number.size());
      if (fresh)
        made_points << std::setprecision(17) << points[c][0] << ' ' << points[c][1] << " 0\n";
      made_faces << ' ' << found->second;
    }
    made_faces << '\n';
  }
  ASSERT_TRUE(text && left > 0 && left < faces);
  const std::string lie = "OFF\n" + std::to_string(number.size()) + " " + std::to_string(left) +
                          " 0\n" + made_points.str() + made_faces.str();
  EXPECT_EQ(of_regions().verify("off", lie, false), 1);
  EXPECT_EQ(of_regions().verify("off", lie, true), 1);
}

// A .vtu with numbers for regions, as a mesh has that was read: then its sides are not known, and
// all is called inside. A mesh that was made has sides, and a record of them.
TEST(FileLies, RegionsAndSidesThatContradictEachOther) {
  std::string text = in_space().files().at("vtu"), regions;
  const std::string start = text.substr(0, text.find("Name=\"inside\""));
  const std::size_t tag = start.rfind("<DataArray"), first = text.find('\n', tag) + 1,
                    end = text.find("</DataArray>", first);
  std::string sides = text.substr(first, end - first), called = sides;
  for (std::size_t at = 0; at < sides.size(); at = sides.find('\n', at) + 1) {
    if (sides[at] == '0') called[at] = '1', sides[at] = '2';
  }
  ASSERT_NE(called, sides);
  regions = text.substr(tag, first - tag) + sides + "</DataArray>\n";
  regions.replace(regions.find("inside"), 6, "region");
  const std::string both = text.substr(0, tag) + regions + text.substr(tag);
  EXPECT_EQ(in_space().verify("vtu", both, false), 0);
  EXPECT_EQ(in_space().verify("vtu", both, true), 0);
  text.replace(first, end - first, called);
  const std::string lie = text.substr(0, tag) + regions + text.substr(tag);
  EXPECT_EQ(in_space().verify("vtu", lie, false), 0);
  EXPECT_EQ(in_space().verify("vtu", lie, true), 1);
}

// A group whose number and name are two labels.
TEST(FileLies, ALabelThatIsNotTheNumberOfItsGroup) {
  const std::string& honest = in_space().files().at("msh");
  std::string lie =
      std::regex_replace(honest, std::regex("\n2 11 \"label 11\""), "\n2 77 \"label 11\"");
  ASSERT_NE(lie, honest);
  const std::size_t entities = lie.find("$Entities"), end = lie.find("$EndEntities");
  const std::size_t group = lie.find(" 1 11 ", entities);
  ASSERT_LT(group, end);
  lie.replace(group, 6, " 1 77 ");
  EXPECT_EQ(in_space().verify("msh", lie, false), 0);
  EXPECT_EQ(in_space().verify("msh", lie, true), 1);
}

// It lists the segments, their markers and the holes.
TEST(FileLies, WithARecordThePolyIsThere) {
  const Meshed& meshed = in_the_plane();
  EXPECT_EQ(meshed.verify("poly", meshed.files().at("poly"), true), 0);
  EXPECT_EQ(meshed.verify("poly", kRemoved, true), 1);
}

std::string bytes_of(std::uint64_t number, std::size_t count) {
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) bytes += static_cast<char>(number >> 8 * i & 255);
  return bytes;
}

// Numbers of elements and nodes that are announced, references, and bytes after the end.
TEST(FileLies, OfBytesAreRefused) {
  const std::string &gmsh = of_bytes().files().at("msh"), &vtu = of_bytes().files().at("vtu");
  for (const auto& [extension, text] : of_bytes().files()) {
    for (const bool with_record : {false, true}) {
      EXPECT_EQ(of_bytes().verify(extension, text, with_record), 0) << extension;
    }
  }
  const auto changed = [&](std::string text, std::size_t at, const std::string& bytes) {
    EXPECT_NE(text.substr(at, bytes.size()), bytes);
    return text.replace(at, bytes.size(), bytes);
  };
  const std::size_t nodes = gmsh.find("$Nodes\n") + 7, elements = gmsh.find("$Elements\n") + 10;
  const std::string gmsh_lies[] = {
      changed(gmsh, gmsh.find("4.1 1 8"), "4.1 1 4"),
      changed(gmsh, gmsh.find("4.1 1 8"), "4.1 2 8"),
      changed(gmsh, gmsh.find("4.1 1 8"), "2.2 1 8"),
      changed(gmsh, gmsh.find("4.1 1 8") + 8, std::string("\0\0\0\1", 4)),
      changed(gmsh, nodes + 8, bytes_of(10, 8)),             // as many nodes in all
      changed(gmsh, nodes + 24, bytes_of(99999, 8)),         // a larger tag
      changed(gmsh, nodes, bytes_of(~std::uint64_t{0}, 8)),  // as many blocks
      changed(gmsh, nodes + 32 + 12, bytes_of(11, 8)),       // as many in the block
      changed(gmsh, nodes + 32 + 20, bytes_of(2, 8)),        // the first one's tag
      changed(gmsh, elements + 8, bytes_of(9, 8)),
      changed(gmsh, elements + 32, bytes_of(3, 4)),        // the dimension of the first
      changed(gmsh, elements + 32 + 8, bytes_of(3, 4)),    // its type
      changed(gmsh, elements + 32 + 28, bytes_of(99, 8)),  // its first node
      gmsh + "x"};
  for (const std::string& lie : gmsh_lies) {
    EXPECT_EQ(of_bytes().verify("msh", lie, true), 3) << &lie - gmsh_lies;
  }
  const auto in_array = [&](const char* name) {
    return vtu.find('\n', vtu.find("Name=\"" + std::string(name) + "\"")) + 1;
  };
  const std::string vtu_lies[] = {changed(vtu, in_array("types"), "A"),  // the number of bytes
                                  changed(vtu, in_array("types") + 12, "////"),
                                  changed(vtu, in_array("connectivity") + 12, "////"),
                                  changed(vtu, in_array("offsets") + 12, "////"),
                                  changed(vtu, in_array("connectivity") + 12, "****"),
                                  changed(vtu, vtu.find("UInt64"), "UInt32"),
                                  changed(vtu, vtu.find("LittleEndian"), "BiggerEndian"),
                                  changed(vtu, vtu.find(" header_type"), " compressor "),
                                  changed(vtu, vtu.find("Int32"), "Int99")};
  for (const std::string& lie : vtu_lies) {
    EXPECT_EQ(of_bytes().verify("vtu", lie, true), 3) << &lie - vtu_lies;
  }
}

// The oracles label the input on their own, as the promise says.
TEST(FileLies, LabelsByAngle) {
  const Meshed meshed(
      "box.off",
      "OFF\n8 6 0\n0 0 0\n4 0 0\n4 4 0\n0 4 0\n0 0 1\n4 0 1\n4 4 1\n0 4 1\n4 0 3 2 1\n"
      "4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n",
      "mesh --size none --label-by-angle 30 --ascii", {{"mesh"}, {"msh"}, {"vtu"}});
  const std::map<std::string, std::array<const char*, 2>> lies = {
      {"mesh", {"Triangles\n(\\d+)\n(\\d+ \\d+ \\d+) \\d+\n", "Triangles\n$1\n$2 7\n"}},
      {"msh", {"\n2 3 \"face_3\"", "\n2 3 \"face_4\""}},
      {"vtu", {"(Name=\"label\"[^>]*>\n(?:0\n)*)[2-6]\n", "$011\n"}}};
  for (const auto& [extension, text] : meshed.files()) {
    const auto& [pattern, replacement] = lies.at(extension);
    const std::string lie = std::regex_replace(text, std::regex(pattern), replacement,
                                               std::regex_constants::format_first_only);
    EXPECT_NE(lie, text) << extension;
    for (const bool with_record : {false, true}) {
      EXPECT_EQ(meshed.verify(extension, text, with_record), 0) << extension;
      // Names are promised with a record alone.
      const bool told = with_record || extension != "msh";
      EXPECT_EQ(meshed.verify(extension, lie, with_record), told ? 1 : 0) << extension;
    }
  }
}

// A file cut short is rejected, wherever that is.
TEST(FileLies, CutShortAreRefused) {
  for (const Meshed* model : {&in_space(), &of_second_order(), &of_bytes(), &in_the_plane()}) {
    for (const auto& [extension, text] : model->files()) {
      // A .poly may end after its segments; that the holes are missing is seen with the input.
      for (std::size_t size = 1; size + 8 < text.size(); size += 1 + size / 16) {
        EXPECT_NE(model->verify(extension, text.substr(0, size), true), 0)
            << extension << " " << size;
      }
    }
  }
}

}  // namespace
}  // namespace tetproof::file_lies_test
