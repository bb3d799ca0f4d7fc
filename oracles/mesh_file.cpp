#include "oracles/mesh_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>

#include "oracles/text_reader.h"
#include "oracles/vtu_text.h"

namespace tetproof::oracles {
namespace {

void read_positions(TextReader& reader, std::uint64_t count, std::vector<Position>& positions) {
  positions.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const double x = reader.number(), y = reader.number(), z = reader.number();
    positions.push_back({x, y, z});
  }
}

template <std::size_t size>
std::array<Index, size> read_corners(TextReader& reader, std::int64_t first, std::uint64_t count) {
  std::array<Index, size> corners;
  for (Index& corner : corners) corner = reader.index(first, count);
  return corners;
}

// ------------------------------------------------------------------------------------------ MEDIT

// delmesher's comments after the end: "# TriangleFacets N", then "# id" for every triangle.
void read_facet_comments(TextReader& reader, MeshFile& mesh) {
  reader.without_comments();
  for (;;) {
    const std::string_view word = reader.word();
    if (word.empty()) return;
    if (word != "#") continue;
    if (reader.word_in_line() == "TriangleFacets") break;
  }
  const std::uint64_t count = reader.count();
  for (std::uint64_t i = 0; i < count; ++i) {
    if (reader.word() != "#") reader.fail("a damaged list of facets");
    mesh.facets.push_back(reader.index(0, 0x100000000U));
  }
}

MeshFile read_medit(const std::string& path) {
  TextReader reader = TextReader::of_file(path);
  MeshFile mesh;
  // Sections without use here, with how many numbers an entry has.
  static const std::map<std::string_view, int> kSkipped = {
      {"Edges", 3},   {"Corners", 1},           {"RequiredVertices", 1}, {"Ridges", 1},
      {"Normals", 3}, {"RequiredTriangles", 1}, {"RequiredEdges", 1},    {"Tangents", 3}};
  // No oracle would look at these cells.
  const auto none = [&](const std::string& section) {
    if (reader.count() > 0) reader.fail("a section of " + section + ", which are not read");
  };
  if (reader.word() != "MeshVersionFormatted") reader.fail("not a MEDIT file");
  reader.integer();
  for (auto keyword = reader.word(); !keyword.empty() && keyword != "End";
       keyword = reader.word()) {
    if (keyword == "Dimension") {
      reader.integer();
    } else if (keyword == "Vertices") {
      const std::uint64_t count = reader.count();
      for (std::uint64_t i = 0; i < count; ++i) {
        read_positions(reader, 1, mesh.vertices);
        reader.integer();
      }
    } else if (keyword == "Triangles") {
      const std::uint64_t count = reader.count();
      for (std::uint64_t i = 0; i < count; ++i) {
        mesh.boundary.push_back(read_corners<3>(reader, 1, mesh.vertices.size()));
        mesh.labels.push_back(static_cast<std::int32_t>(reader.integer()));
      }
    } else if (keyword == "Tetrahedra") {
      const std::uint64_t count = reader.count();
      for (std::uint64_t i = 0; i < count; ++i) {
        mesh.tetrahedra.push_back(read_corners<4>(reader, 1, mesh.vertices.size()));
        mesh.regions.push_back(reader.integer());
      }
    } else if (keyword == "Hexahedra" || keyword == "Quadrilaterals") {
      none(std::string(keyword));
    } else if (const auto skipped = kSkipped.find(keyword); skipped != kSkipped.end()) {
      const std::uint64_t count = reader.count();
      for (std::uint64_t i = 0; i < count * static_cast<std::uint64_t>(skipped->second); ++i) {
        reader.number();
      }
    } else {
      reader.fail("unknown section " + std::string(keyword.substr(0, 40)));
    }
  }
  read_facet_comments(reader, mesh);
  return mesh;
}

// ------------------------------------------------------------------------------------------- .tet

MeshFile read_tet(const std::string& path) {
  TextReader reader = TextReader::of_file(path);
  MeshFile mesh;
  mesh.either_orientation = true;
  mesh.lists_boundary = false;
  const std::uint64_t vertices = reader.count();
  reader.skip_line();
  const std::uint64_t inner = reader.count();
  std::uint64_t outer = 0;
  if (reader.word_in_line() == "inner") {
    reader.skip_line();
    outer = reader.count();
    mesh.regions.assign(inner, 1);
    mesh.regions.resize(inner + outer, 0);
  }
  reader.skip_line();
  read_positions(reader, vertices, mesh.vertices);
  for (std::uint64_t t = 0; t < inner + outer; ++t) {
    if (reader.integer() != 4) reader.fail("a cell that is no tetrahedron");
    mesh.tetrahedra.push_back(read_corners<4>(reader, 0, vertices));
  }
  return mesh;
}

// ------------------------------------------------------------------------------------------ Gmsh

class GmshReader {
 public:
  explicit GmshReader(const std::string& path) : reader_(TextReader::of_file(path, '\0')) {}

  MeshFile read() {
    for (auto word = reader_.word(); !word.empty(); word = reader_.word()) {
      if (word == "$MeshFormat") {
        version_ = reader_.number();
        if (reader_.integer() != 0) reader_.fail("binary .msh files are not read");
      } else if (word == "$PhysicalNames") {
        read_names();
      } else if (word == "$Entities") {
        read_entities();
      } else if (word == "$Nodes") {
        version_ < 4 ? read_nodes_2() : read_nodes_4();
      } else if (word == "$Elements") {
        version_ < 4 ? read_elements_2() : read_elements_4();
      } else {
        continue;
      }
    }
    return std::move(mesh_);
  }

 private:
  // Physical tags are positive. Labels that are not are written in the name: "label -3".
  void read_names() {
    const std::uint64_t count = reader_.count();
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::int64_t dimension = reader_.integer(), tag = reader_.integer();
      const bool label = reader_.word() == "\"label";
      const std::string_view number = reader_.word_in_line();
      std::int64_t value = 0;
      const auto [end, error] =
          std::from_chars(number.data(), number.data() + number.size(), value);
      if (dimension == 2 && label && error == std::errc()) labels_[tag] = value;
      reader_.skip_line();
    }
  }

  // Physical tags of surfaces and volumes; an entity without one stands for itself.
  void read_entities() {
    std::uint64_t counts[4];
    for (std::uint64_t& count : counts) count = reader_.count();
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (std::uint64_t i = 0; i < counts[dimension]; ++i) {
        const std::int64_t tag = reader_.integer();
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) reader_.number();
        physical_[{dimension, tag}] = tag;
        const std::uint64_t tags = reader_.count();
        for (std::uint64_t k = 0; k < tags; ++k) {
          const std::int64_t value = reader_.integer();
          if (k == 0) physical_[{dimension, tag}] = value;
        }
        if (dimension == 0) continue;
        const std::uint64_t bounding = reader_.count();
        for (std::uint64_t k = 0; k < bounding; ++k) reader_.integer();
      }
    }
  }

  void read_nodes_4() {
    const std::uint64_t blocks = reader_.count();
    for (int i = 0; i < 3; ++i) reader_.integer();
    for (std::uint64_t block = 0; block < blocks; ++block) {
      const std::int64_t dimension = reader_.integer();
      reader_.integer();
      const bool parametric = reader_.integer() != 0;
      const std::uint64_t count = reader_.count();
      for (std::uint64_t i = 0; i < count; ++i) add_node_tag(reader_.integer());
      for (std::uint64_t i = 0; i < count; ++i) {
        read_positions(reader_, 1, mesh_.vertices);
        for (std::int64_t k = 0; parametric && k < dimension; ++k) reader_.number();
      }
    }
  }

  void read_nodes_2() {
    const std::uint64_t count = reader_.count();
    for (std::uint64_t i = 0; i < count; ++i) {
      add_node_tag(reader_.integer());
      read_positions(reader_, 1, mesh_.vertices);
    }
  }

  void read_elements_4() {
    const std::uint64_t blocks = reader_.count();
    for (int i = 0; i < 3; ++i) reader_.integer();
    for (std::uint64_t block = 0; block < blocks; ++block) {
      const int dimension = static_cast<int>(reader_.integer());
      const std::int64_t entity = reader_.integer(), type = reader_.integer();
      const std::uint64_t count = reader_.count();
      const auto found = physical_.find({dimension, entity});
      const std::int64_t tag = found == physical_.end() ? entity : found->second;
      for (std::uint64_t i = 0; i < count; ++i) {
        reader_.integer();
        add_element(type, tag);
        if (type == 2) mesh_.facets.push_back(static_cast<Index>(entity - 1));
      }
    }
  }

  void read_elements_2() {
    const std::uint64_t count = reader_.count();
    for (std::uint64_t i = 0; i < count; ++i) {
      reader_.integer();
      const std::int64_t type = reader_.integer();
      const std::uint64_t tags = reader_.count();
      std::int64_t tag = 0;
      for (std::uint64_t k = 0; k < tags; ++k) {
        const std::int64_t value = reader_.integer();
        if (k == 0) tag = value;
      }
      add_element(type, tag);
    }
  }

  void add_node_tag(std::int64_t tag) {
    if (!nodes_.emplace(tag, static_cast<Index>(nodes_.size())).second) {
      reader_.fail("node " + std::to_string(tag) + " is there twice");
    }
  }

  Index node() {
    const std::int64_t tag = reader_.integer();
    const auto found = nodes_.find(tag);
    if (found == nodes_.end()) reader_.fail("there is no node " + std::to_string(tag));
    return found->second;
  }

  void add_element(std::int64_t type, std::int64_t tag) {
    if (type == 4) {
      mesh_.tetrahedra.push_back({node(), node(), node(), node()});
      mesh_.regions.push_back(tag);
    } else if (type == 2) {
      mesh_.boundary.push_back({node(), node(), node()});
      const auto label = labels_.find(tag);
      mesh_.labels.push_back(
          static_cast<std::int32_t>(label == labels_.end() ? tag : label->second));
    } else if (type == 1 || type == 15) {
      reader_.skip_line();  // lines and points
    } else {
      reader_.fail("an element of type " + std::to_string(type) + ", which is not read");
    }
  }

  TextReader reader_;
  MeshFile mesh_;
  double version_ = 4.1;
  std::map<std::pair<int, std::int64_t>, std::int64_t> physical_;
  std::map<std::int64_t, std::int64_t> labels_;  // of physical tags
  std::map<std::int64_t, Index> nodes_;
};

// ------------------------------------------------------------------------------------------- .vtu

class VtuReader {
 public:
  explicit VtuReader(const std::string& path)
      : contents_(read_whole_file(path)), text_(path, contents_) {}
  VtuReader(const VtuReader&) = delete;

  MeshFile read() {
    MeshFile mesh;
    const std::vector<double> points = text_.array("Points", "");
    const std::vector<double> corners = text_.array("Cells", "connectivity");
    const std::vector<double> types = text_.array("Cells", "types");
    const std::vector<double> offsets = text_.array("Cells", "offsets");
    for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
      mesh.vertices.push_back({points[i], points[i + 1], points[i + 2]});
    }
    if (types.size() != offsets.size()) fail("types and offsets differ in length");
    std::vector<double> values = text_.array("CellData", "region");
    if (values.empty()) values = text_.array("CellData", "inside");
    const std::vector<double> labels = text_.array("CellData", "label");
    const std::vector<double> facets = text_.array("CellData", "facet");
    for (const auto* list :
         std::initializer_list<const std::vector<double>*>{&values, &labels, &facets}) {
      if (!list->empty() && list->size() != types.size()) fail("an array has not a value per cell");
    }
    std::size_t start = 0;
    for (std::size_t cell = 0; cell < types.size(); ++cell) {
      const auto end = static_cast<std::size_t>(integer(offsets[cell]));
      if (end < start || end > corners.size()) fail("offsets leave the connectivity");
      const auto corner = [&](std::size_t k) {
        const std::int64_t v = integer(corners[start + k]);
        if (v < 0 || v >= static_cast<std::int64_t>(mesh.vertices.size())) {
          fail("a cell refers to no point");
        }
        return static_cast<Index>(v);
      };
      if (types[cell] == 10 && end - start == 4) {
        mesh.tetrahedra.push_back({corner(0), corner(1), corner(2), corner(3)});
        if (!values.empty()) mesh.regions.push_back(integer(values[cell]));
      } else if (types[cell] == 5 && end - start == 3) {
        mesh.boundary.push_back({corner(0), corner(1), corner(2)});
        if (!labels.empty())
          mesh.labels.push_back(static_cast<std::int32_t>(integer(labels[cell])));
        if (!facets.empty()) {
          const bool known = facets[cell] >= 0 && facets[cell] < 0x1p32;
          mesh.facets.push_back(known ? static_cast<Index>(integer(facets[cell])) : kNone);
        }
      } else if (types[cell] != 1 && types[cell] != 3) {  // points and lines
        fail("a cell that is no tetrahedron and no triangle");
      }
      start = end;
    }
    return mesh;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const { text_.fail(reason); }
  std::int64_t integer(double value) const { return text_.integer(value); }

  const std::string contents_;
  const VtuText text_;
};

// ----------------------------------------------------------------------------------------- TetGen

MeshFile read_tetgen(const std::string& stem) {
  MeshFile mesh;
  mesh.either_orientation = true;
  TextReader reader = TextReader::of_file(stem + ".node");
  const std::uint64_t count = reader.count();
  reader.skip_line();
  std::int64_t first = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::int64_t number = reader.integer();
    if (i == 0) first = number;
    if (number != first + static_cast<std::int64_t>(i)) reader.fail("nodes are not in order");
    read_positions(reader, 1, mesh.vertices);
    reader.skip_line();
  }
  TextReader ele = TextReader::of_file(stem + ".ele");
  const std::uint64_t tets = ele.count();
  const std::int64_t corners = ele.integer();
  const bool regions = ele.integer() != 0;
  if (corners != 4) ele.fail("elements are not linear tetrahedra");
  for (std::uint64_t i = 0; i < tets; ++i) {
    ele.integer();
    mesh.tetrahedra.push_back(read_corners<4>(ele, first, count));
    if (regions) mesh.regions.push_back(ele.integer());
    ele.skip_line();
  }
  if (!std::filesystem::exists(stem + ".face")) return mesh;
  TextReader face = TextReader::of_file(stem + ".face");
  const std::uint64_t triangles = face.count();
  const bool markers = face.integer() != 0;
  for (std::uint64_t i = 0; i < triangles; ++i) {
    face.integer();
    mesh.boundary.push_back(read_corners<3>(face, first, count));
    if (markers) mesh.labels.push_back(static_cast<std::int32_t>(face.integer()));
    // TetGen's own files have no second number, or one with another meaning; only a record decides
    // what it should be.
    if (const std::string_view facet = face.word_in_line(); !facet.empty() && markers) {
      Index value = 0;
      const auto [end, error] = std::from_chars(facet.data(), facet.data() + facet.size(), value);
      const bool whole = error == std::errc() && end == facet.data() + facet.size();
      mesh.facets.push_back(whole ? value : kNone);
    }
    face.skip_line();
  }
  return mesh;
}

}  // namespace

MeshFile read_mesh(const std::string& path) {
  const std::filesystem::path file(path);
  const std::string extension = file.extension().string();
  if (extension == ".node" || extension == ".ele" || extension == ".face") {
    return read_tetgen((file.parent_path() / file.stem()).string());
  }
  if (extension == ".tet") return read_tet(path);
  if (extension == ".msh") return GmshReader(path).read();
  if (extension == ".vtu") return VtuReader(path).read();
  return read_medit(path);
}

}  // namespace tetproof::oracles
