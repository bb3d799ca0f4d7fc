#include "oracles/files/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "oracles/base/text_reader.h"
#include "oracles/files/edge_nodes.h"
#include "oracles/files/gmsh_text.h"
#include "oracles/files/vtu_text.h"

namespace tetproof::oracles {
namespace {

Position read_position(TextReader& reader) {
  const double x = reader.number(), y = reader.number();
  return {x, y, reader.number()};
}

template <std::size_t size>
std::array<Index, size> read_corners(TextReader& reader, std::int64_t first, std::uint64_t count) {
  std::array<Index, size> corners;
  for (Index& corner : corners) corner = reader.index(first, count);
  return corners;
}

// A file that has sides and no numbers: these are those that delmesher writes in their place, so
// that files of one mesh agree whatever their format.
std::int64_t region_of_side(std::uint8_t inside) {
  return inside != 0 ? 1 : 2;
}

// ------------------------------------------------------------------------------------------ MEDIT

class MeditReader {
 public:
  explicit MeditReader(const std::string& path) : path_(path), reader_(TextReader::of_file(path)) {}

  MeshFile read() {
    reader_.expect("MeshVersionFormatted");
    single_ = reader_.index(1, 4) == 0;  // of the versions from 1 on
    for (;;) {
      const std::string section(reader_.required_word("a section or End"));
      if (section == "End") break;
      if (!counts_.emplace(section, 0).second) reader_.fail(section + " is there twice");
      read_section(section);
    }
    for (const char* section : {"Dimension", "Vertices", "Tetrahedra"}) {
      const bool there = counts_.contains(section) || counts_.contains(section + std::string("P2"));
      if (!there) reader_.fail(std::string("there is no ") + section);
    }
    take_out_edge_nodes(mesh_, nodes_, path_);
    check_references();
    read_comments();
    return std::move(mesh_);
  }

 private:
  // A section without use here: of what its entries tell numbers, each of them, and how many other
  // numbers follow these.
  struct Skipped {
    std::vector<const char*> of;
    int others;
  };

  void read_section(const std::string& section) {
    static const std::map<std::string, Skipped> kSkipped = {
        {"Edges", {{"Vertices", "Vertices"}, 1}},
        {"EdgesP2", {{"Vertices", "Vertices", "Vertices"}, 1}},
        {"Corners", {{"Vertices"}, 0}},
        {"RequiredVertices", {{"Vertices"}, 0}},
        {"Ridges", {{"Edges"}, 0}},
        {"RequiredEdges", {{"Edges"}, 0}},
        {"RequiredTriangles", {{"Triangles"}, 0}},
        {"Normals", {{}, 3}},
        {"Tangents", {{}, 3}},
        {"NormalAtVertices", {{"Vertices", "Normals"}, 0}},
        {"TangentAtVertices", {{"Vertices", "Tangents"}, 0}}};
    if (section == "Dimension") {
      if (reader_.integer() != 3) reader_.fail("a mesh that is not in space");
      return;
    }
    const auto skipped = kSkipped.find(section);
    const bool cells = section == "Hexahedra" || section == "Quadrilaterals";
    static const std::set<std::string> kRead = {"Vertices", "Triangles", "Tetrahedra",
                                                "TrianglesP2", "TetrahedraP2"};
    if (!kRead.contains(section) && !cells && skipped == kSkipped.end()) {
      reader_.fail("unknown section " + section.substr(0, 40));
    }
    const std::uint64_t count = counts_[section] = reader_.count();
    // No oracle would look at these.
    if (cells && count > 0) reader_.fail("a section of " + section + ", which are not read");
    const std::uint64_t before = reader_.comments();
    for (std::uint64_t i = 0; i < count; ++i) {
      skipped == kSkipped.end() ? read_entry(section) : skip_entry(skipped->second);
    }
    mesh_.comments_within = mesh_.comments_within || reader_.comments() != before;
  }

  void read_entry(const std::string& section) {
    if (section == "Vertices") {
      const Position& p = mesh_.vertices.emplace_back(read_position(reader_));
      const auto is_single = [](double x) { return static_cast<float>(x) == x; };
      if (single_ && !std::ranges::all_of(p, is_single)) mesh_.more_than_single = true;
      reader_.integer();
    } else if (section.starts_with("Triangles")) {
      mesh_.boundary.push_back(read_corners<3>(reader_, 1, mesh_.vertices.size()));
      if (section.ends_with("P2")) {
        nodes_.of_triangles.push_back(read_corners<3>(reader_, 1, mesh_.vertices.size()));
      }
      mesh_.labels.push_back(reader_.integer32());
    } else {
      mesh_.tetrahedra.push_back(read_corners<4>(reader_, 1, mesh_.vertices.size()));
      if (section.ends_with("P2")) {
        nodes_.of_tetrahedra.push_back(read_corners<6>(reader_, 1, mesh_.vertices.size()));
      }
      mesh_.regions.push_back(reader_.integer());
    }
  }

  void skip_entry(const Skipped& entry) {
    for (const char* of : entry.of) {
      const std::uint64_t value = reader_.index(1, 0xffffffffU) + std::uint64_t{1};
      Reference& largest = largest_[of];
      if (value > largest.number) largest = {value, reader_.line()};
    }
    for (int k = 0; k < entry.others; ++k) reader_.number();
  }

  // What is referred to may come later.
  void check_references() {
    for (const auto& [section, largest] : largest_) {
      const std::uint64_t count = counts_[section] + counts_[section + "P2"];
      if (largest.number <= count) continue;
      throw ReadError(path_ + ":" + std::to_string(largest.line) + ": a reference to " + section +
                      " number " + std::to_string(largest.number) + ", which does not exist");
    }
  }

  // After the end nothing but comments; among them those of delmesher: "# TriangleFacets N", then
  // "# id" for every triangle, and "# PlanarWithin X".
  void read_comments() {
    reader_.without_comments();
    bool found = false;
    while (!reader_.at_end()) {
      if (!reader_.word().starts_with('#')) reader_.fail("something follows the end");
      const std::string keyword(reader_.word_in_line());
      if (keyword == "PlanarWithin") reader_.positive_once(mesh_.planar_within);
      if (keyword != "TriangleFacets") {
        reader_.skip_line();
        continue;
      }
      if (std::exchange(found, true)) reader_.fail("facets are there twice");
      const std::uint64_t count = reader_.count();
      if (count != mesh_.boundary.size()) reader_.fail("there is not a facet for each triangle");
      for (std::uint64_t i = 0; i < count; ++i) {
        reader_.expect_line_end();
        reader_.expect("#");
        mesh_.facets.push_back(reader_.index(0, 0x100000000U));
      }
      reader_.expect_line_end();
    }
  }

  std::string path_;
  TextReader reader_;
  MeshFile mesh_;
  bool single_ = false;  // the file says that numbers have 4 bytes
  NodesOnEdges nodes_;
  std::map<std::string, std::uint64_t> counts_;  // of the sections
  struct Reference {
    std::uint64_t number = 0, line = 0;
  };
  std::map<std::string, Reference> largest_;  // that something refers to, by section
};

// ------------------------------------------------------------------------------------------- .tet

// "N vertices", or the line about inner or outer tetrahedra.
std::uint64_t counted(TextReader& reader, std::initializer_list<const char*> words) {
  const std::uint64_t count = reader.count();
  for (const char* word : words) {
    if (reader.word_in_line() != word) reader.fail(std::string("no number of ") + *words.begin());
  }
  reader.expect_line_end();
  return count;
}

MeshFile read_tet(const std::string& path) {
  TextReader reader = TextReader::of_file(path);
  MeshFile mesh;
  mesh.either_orientation = true;
  mesh.lists_boundary = false;
  mesh.has_second_order = false;
  const std::uint64_t vertices = counted(reader, {"vertices"});
  std::uint64_t inner = reader.count(), outer = 0;
  const std::string kind(reader.word_in_line());
  if (kind == "inner") {
    reader.expect("tets");
    outer = counted(reader, {"outer", "tets"});
    mesh.inside.assign(inner, 1);
    mesh.inside.resize(inner + outer, 0);
    for (const std::uint8_t side : mesh.inside) mesh.regions.push_back(region_of_side(side));
  } else if (kind != "tets") {
    reader.fail("no number of tets");
  }
  for (std::uint64_t v = 0; v < vertices; ++v) {
    mesh.vertices.push_back(read_position(reader));
    reader.expect_line_end();
  }
  for (std::uint64_t t = 0; t < inner + outer; ++t) {
    if (reader.integer() != 4) reader.fail("a cell that is not a tetrahedron");
    mesh.tetrahedra.push_back(read_corners<4>(reader, 0, vertices));
    reader.expect_line_end();
  }
  reader.expect_nothing();
  return mesh;
}

// ------------------------------------------------------------------------------------------ Gmsh

// Physical tags are positive, and no label and region have the same. Labels and regions that cannot
// be tags are written in the name: "label -3", "region 0", and after that what they are called.
std::optional<std::int64_t> number_in(const std::string& name, std::string_view start) {
  if (!name.starts_with(start)) return {};
  const char* const last = name.data() + name.size();
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(name.data() + start.size(), last, value);
  if (error != std::errc() || (end != last && *end != ' ')) return {};
  return value;
}

MeshFile read_gmsh(const std::string& path) {
  MeshFile mesh;
  NodesOnEdges nodes;
  std::vector<std::int64_t> groups, entities;  // of triangles
  GmshText text = read_gmsh_text(path, [&](const GmshElement& element) {
    const std::array<Index, 10>& n = element.nodes;
    if (element.type == 4 || element.type == 11) {
      mesh.tetrahedra.push_back({n[0], n[1], n[2], n[3]});
      if (element.type == 11) nodes.of_tetrahedra.push_back({n[4], n[5], n[6], n[7], n[9], n[8]});
      mesh.regions.push_back(element.group);
    } else if (element.type == 2 || element.type == 9) {
      mesh.boundary.push_back({n[0], n[1], n[2]});
      if (element.type == 9) nodes.of_triangles.push_back({n[3], n[4], n[5]});
      groups.push_back(element.group);
      entities.push_back(element.entity);
    }
  });
  mesh.vertices = std::move(text.nodes);
  mesh.planar_within = text.planar_within;
  mesh.boxes_differ = text.boxes_differ;
  take_out_edge_nodes(mesh, nodes, path);
  const auto called = [&](std::int64_t group, std::string_view name) {
    const auto found = text.names.find({3, group});
    if (found == text.names.end()) return false;
    const std::string_view first = std::string_view(found->second).substr(0, name.size());
    const bool whole = found->second.size() <= name.size() || found->second[name.size()] == ' ';
    return whole && std::ranges::equal(first, name, [](char a, char b) {
             return std::tolower(static_cast<unsigned char>(a)) == b;
           });
  };
  mesh.groups_differ = text.groups_differ;
  mesh.tags_shared = text.tags_shared;
  mesh.sides_contradict = called(1, "outside") || called(2, "inside");
  // Where volumes are the two sides, and nothing else, these are 1 and 2 whatever their tags are.
  const bool sides = std::ranges::all_of(text.names, [](const auto& name) {
    return name.first.first != 3 || name.second == "inside" || name.second == "outside";
  });
  const auto region_of = [&](std::int64_t tag) {
    const auto named = text.names.find({3, tag});
    if (named == text.names.end()) return tag;
    if (sides) return region_of_side(named->second == "inside" ? 1 : 0);
    return number_in(named->second, "region ").value_or(tag);
  };
  for (std::int64_t& region : mesh.regions) {
    const std::int64_t told = region_of(region);
    mesh.sides_contradict = mesh.sides_contradict || (!sides && told > 0 && told != region &&
                                                      !text.names.contains({2, told}));
    region = told;
  }
  mesh.has_names = true;
  for (const auto& [group, name] : text.names) {
    if (group.first != 2 && group.first != 3) continue;
    const std::string_view start = group.first == 2 ? "label " : "region ";
    const std::optional<std::int64_t> told = number_in(name, start);
    const std::size_t blank = told ? name.find(' ', start.size()) : std::string::npos;
    const std::int64_t number =
        group.first == 3 ? region_of(group.second) : told.value_or(group.second);
    mesh.names[{group.first, number}] = !told                        ? name
                                        : blank == std::string::npos ? ""
                                                                     : name.substr(blank + 1);
  }
  for (const std::int64_t group : groups) {
    const auto named = text.names.find({2, group});
    const std::int64_t label =
        named == text.names.end() ? group : number_in(named->second, "label ").value_or(group);
    mesh.labels_contradict = mesh.labels_contradict || (label > 0 && label != group);
    if (label != static_cast<std::int32_t>(label)) {
      throw ReadError(path + ": label " + std::to_string(label) + " is not an integer of 32 bits");
    }
    mesh.labels.push_back(static_cast<std::int32_t>(label));
  }
  for (const std::int64_t entity : entities) {
    const bool known = entity > 0 && entity <= std::int64_t{kNone};
    mesh.facets.push_back(known ? static_cast<Index>(entity - 1) : kNone);
  }
  return mesh;
}

// ------------------------------------------------------------------------------------------- .vtu

class VtuReader {
 public:
  explicit VtuReader(const std::string& path)
      : path_(path), contents_(read_whole_file(path)), text_(path, contents_) {}
  VtuReader(const VtuReader&) = delete;

  MeshFile read() {
    const std::vector<double> points = text_.required_array("Points", "");
    for (std::size_t i = 0; i < points.size(); i += 3) {
      mesh_.vertices.push_back({points[i], points[i + 1], points[i + 2]});
    }
    corners_ = text_.required_array("Cells", "connectivity");
    types_ = text_.required_array("Cells", "types");
    const std::vector<double> offsets = text_.required_array("Cells", "offsets");
    regions_ = text_.array("CellData", "region");
    sides_ = text_.array("CellData", "inside");
    labels_ = text_.array("CellData", "label");
    facets_ = text_.array("CellData", "facet");
    mesh_.has_names = true;
    mesh_.names = text_.names();
    mesh_.planar_within = text_.planar_within();
    for (std::size_t cell = 0; cell < types_.size(); ++cell) {
      const std::int64_t end = text_.integer(offsets[cell]);
      read_cell(cell, end - static_cast<std::int64_t>(start_));
    }
    if (start_ != corners_.size()) text_.fail("the connectivity goes on after the last cell");
    take_out_edge_nodes(mesh_, nodes_, path_);
    mesh_.all_called_inside =
        !regions_.empty() && std::ranges::all_of(mesh_.inside, [](auto side) { return side != 0; });
    return std::move(mesh_);
  }

 private:
  void read_cell(std::size_t cell, std::int64_t size) {
    static const std::map<double, std::int64_t> kSizes = {{1, 1},  {3, 2},  {5, 3},  {10, 4},
                                                          {21, 3}, {22, 6}, {24, 10}};
    const auto wanted = kSizes.find(types_[cell]);
    if (wanted == kSizes.end()) text_.fail("a cell that is neither a tetrahedron nor a triangle");
    const auto end = start_ + static_cast<std::size_t>(wanted->second);
    if (size != wanted->second || end > corners_.size()) text_.fail("offsets that fit no cell");
    std::array<Index, 10> node{};
    for (std::size_t k = start_; k < end; ++k) {
      const std::int64_t v = text_.integer(corners_[k]);
      if (v < 0 || v >= static_cast<std::int64_t>(mesh_.vertices.size())) {
        text_.fail("a cell refers to no point");
      }
      node[k - start_] = static_cast<Index>(v);
    }
    start_ = end;
    const auto& [a, b, c, d, e, f, g, h, i, j] = node;
    const double type = types_[cell];
    if (type == 10 || type == 24) add_tetrahedron(cell, {a, b, c, d});
    if (type == 24) nodes_.of_tetrahedra.push_back({e, f, g, h, i, j});
    if (type == 5 || type == 22) add_triangle(cell, {a, b, c});
    if (type == 22) nodes_.of_triangles.push_back({d, e, f});
  }

  void add_tetrahedron(std::size_t cell, const Tet& tet) {
    mesh_.tetrahedra.push_back(tet);
    if (!sides_.empty()) {
      if (sides_[cell] != 0 && sides_[cell] != 1) text_.fail("a side that is neither 0 nor 1");
      mesh_.inside.push_back(sides_[cell] == 1 ? 1 : 0);
    }
    if (!regions_.empty()) {
      mesh_.regions.push_back(text_.integer(regions_[cell]));
    } else if (!sides_.empty()) {
      mesh_.regions.push_back(region_of_side(mesh_.inside.back()));
    }
    if (!labels_.empty() && labels_[cell] != 0) text_.fail("a label of a tetrahedron");
    if (!facets_.empty() && facets_[cell] != -1) text_.fail("a facet of a tetrahedron");
  }

  void add_triangle(std::size_t cell, const Face& face) {
    mesh_.boundary.push_back(face);
    if (!sides_.empty() && sides_[cell] != -1) text_.fail("a side of a triangle");
    if (!labels_.empty()) mesh_.labels.push_back(text_.integer32(labels_[cell]));
    if (!facets_.empty()) {
      const bool known = facets_[cell] >= 0 && facets_[cell] < 0x1p32;
      mesh_.facets.push_back(known ? static_cast<Index>(text_.integer(facets_[cell])) : kNone);
    }
  }

  const std::string path_, contents_;
  const VtuText text_;
  MeshFile mesh_;
  NodesOnEdges nodes_;
  std::vector<double> corners_, types_, regions_, sides_, labels_, facets_;
  std::size_t start_ = 0;  // of a cell, in the connectivity
};

// ----------------------------------------------------------------------------------------- TetGen

// The next number of this line; 0 if there is none.
std::int64_t integer_in_line(TextReader& reader, const std::string& path) {
  const std::string_view word = reader.word_in_line();
  return word.empty() ? 0 : TextReader(path, word, '\0').integer();
}

// Numbers in this line that say nothing here.
void skip_numbers(TextReader& reader, const std::string& path, std::int64_t count) {
  for (std::int64_t k = 0; k < count; ++k) {
    const std::string_view word = reader.word_in_line();
    if (word.empty()) reader.fail("a number is missing");
    TextReader(path, word, '\0').number();
  }
}

void expect_number(TextReader& reader, std::int64_t wanted) {
  if (reader.integer() != wanted) reader.fail("the numbers are not in order");
}

// The first number of a vertex.
std::int64_t read_tetgen_nodes(const std::string& path, MeshFile& mesh) {
  TextReader reader = TextReader::of_file(path);
  const std::uint64_t count = reader.count();
  if (integer_in_line(reader, path) != 3) reader.fail("vertices are not in space");
  const std::int64_t attributes = integer_in_line(reader, path),
                     markers = integer_in_line(reader, path);
  if (attributes < 0 || (markers != 0 && markers != 1)) reader.fail("no such numbers of markers");
  reader.expect_line_end();
  std::int64_t first = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (i == 0) {
      first = reader.index(0, 2);
    } else {
      expect_number(reader, first + static_cast<std::int64_t>(i));
    }
    mesh.vertices.push_back(read_position(reader));
    skip_numbers(reader, path, attributes + markers);
    reader.expect_line_end();
  }
  reader.without_comments();
  while (!reader.at_end()) {
    if (!reader.word().starts_with('#')) reader.fail("something follows the last vertex");
    if (reader.word_in_line() == "PlanarWithin") reader.positive_once(mesh.planar_within);
    reader.skip_line();
  }
  return first;
}

using TetNodes = std::vector<std::array<Index, 6>>;

void read_tetgen_elements(const std::string& path, std::int64_t first, MeshFile& mesh,
                          TetNodes& nodes) {
  TextReader ele = TextReader::of_file(path);
  const std::uint64_t tets = ele.count();
  const std::int64_t corners = integer_in_line(ele, path);
  if (corners != 4 && corners != 10) ele.fail("elements are not tetrahedra of 4 or 10 nodes");
  const std::int64_t attributes = integer_in_line(ele, path);
  if (attributes < 0) ele.fail("no such number of attributes");
  ele.expect_line_end();
  for (std::uint64_t i = 0; i < tets; ++i) {
    expect_number(ele, first + static_cast<std::int64_t>(i));
    mesh.tetrahedra.push_back(read_corners<4>(ele, first, mesh.vertices.size()));
    if (corners == 10) {  // on cd ad ab bc bd ac: TetGen 1.5, -o2
      const auto n = read_corners<6>(ele, first, mesh.vertices.size());
      nodes.push_back({n[2], n[3], n[5], n[1], n[4], n[0]});
    }
    if (attributes > 0) mesh.regions.push_back(ele.integer());
    skip_numbers(ele, path, std::max<std::int64_t>(attributes - 1, 0));
    ele.expect_line_end();
  }
  ele.expect_nothing();
}

// The nodes that tetrahedra of second order have on the edges of a face.
class NodesOfFaces {
 public:
  NodesOfFaces(const MeshFile& mesh, const TetNodes& nodes) {
    for (std::size_t t = 0; t < nodes.size(); ++t) {
      for (std::size_t e = 0; e < 6; ++e) {
        const auto [a, b] =
            std::minmax(mesh.tetrahedra[t][kNodeEnds[e][0]], mesh.tetrahedra[t][kNodeEnds[e][1]]);
        on_edges_.push_back({a, b, nodes[t][e]});
      }
    }
    std::sort(on_edges_.begin(), on_edges_.end());
  }

  bool are_there() const { return !on_edges_.empty(); }
  // On ab bc ac; nullopt if an edge is of no tetrahedron.
  std::optional<std::array<Index, 3>> of(const Face& face) const {
    std::array<Index, 3> nodes;
    for (std::size_t e = 0; e < 3; ++e) {
      const auto [a, b] = std::minmax(face[kNodeEnds[e][0]], face[kNodeEnds[e][1]]);
      const auto at =
          std::lower_bound(on_edges_.begin(), on_edges_.end(), std::array<Index, 3>{a, b, 0});
      if (at == on_edges_.end() || (*at)[0] != a || (*at)[1] != b) return {};
      nodes[e] = (*at)[2];
    }
    return nodes;
  }

 private:
  std::vector<std::array<Index, 3>> on_edges_;  // the ends, and the node between them
};

// Faces of ten-node tetrahedra have three nodes or six, whose order depends on what TetGen did.
// Their corners must be followed by `markers` numbers and, by its -nn, two more. Takes the
// nodes away, which must be those of the tetrahedra.
std::array<Index, 3> take_nodes_of_face(TextReader& reader, const NodesOfFaces& of_faces,
                                        const Face& face, std::int64_t first, std::size_t markers,
                                        std::vector<std::int64_t>& numbers) {
  const auto nodes = of_faces.of(face);
  if (!nodes) reader.fail("an edge of this face is of no tetrahedron");
  if (numbers.size() < markers + 3) return *nodes;
  std::array<std::int64_t, 3> expected;
  for (std::size_t k = 0; k < 3; ++k) expected[k] = (*nodes)[k] + first;
  if (!std::is_permutation(expected.begin(), expected.end(), numbers.begin())) {
    reader.fail("this face has other nodes than its tetrahedron");
  }
  numbers.erase(numbers.begin(), numbers.begin() + 3);
  return *nodes;
}

void read_tetgen_faces(const std::string& path, std::int64_t first, MeshFile& mesh,
                       NodesOnEdges& nodes) {
  TextReader face = TextReader::of_file(path);
  const NodesOfFaces of_faces(mesh, nodes.of_tetrahedra);
  const std::uint64_t triangles = face.count();
  const std::int64_t markers = integer_in_line(face, path);
  if (markers != 0 && markers != 1) face.fail("no such number of markers");
  face.expect_line_end();
  for (std::uint64_t i = 0; i < triangles; ++i) {
    expect_number(face, first + static_cast<std::int64_t>(i));
    mesh.boundary.push_back(read_corners<3>(face, first, mesh.vertices.size()));
    std::vector<std::int64_t> further;
    for (auto word = face.word_in_line(); !word.empty(); word = face.word_in_line()) {
      further.push_back(TextReader(path, word, '\0').integer());
    }
    if (of_faces.are_there()) {
      nodes.of_triangles.push_back(take_nodes_of_face(face, of_faces, mesh.boundary.back(), first,
                                                      static_cast<std::size_t>(markers), further));
    }
    if (markers == 1) {
      if (further.empty()) face.fail("the marker is missing");
      if (further[0] != static_cast<std::int32_t>(further[0])) {
        face.fail(std::to_string(further[0]) + " is not an integer of 32 bits");
      }
      mesh.labels.push_back(static_cast<std::int32_t>(further[0]));
      further.erase(further.begin());
    }
    // TetGen's own files have no further numbers, or two with another meaning (its -nn); only a
    // record decides what it should be.
    if (further.size() > 2) face.fail("too many numbers");
    if (further.empty() || markers == 0) continue;
    const bool known = further.size() == 1 && further[0] >= 0 && further[0] < std::int64_t{kNone};
    mesh.facets.push_back(known ? static_cast<Index>(further[0]) : kNone);
  }
  face.expect_nothing();
}

MeshFile read_tetgen(const std::string& stem) {
  MeshFile mesh;
  mesh.either_orientation = true;
  mesh.has_second_order = false;
  const std::int64_t first = read_tetgen_nodes(maybe_with_gz(stem + ".node"), mesh);
  NodesOnEdges nodes;
  read_tetgen_elements(maybe_with_gz(stem + ".ele"), first, mesh, nodes.of_tetrahedra);
  const std::string faces = maybe_with_gz(stem + ".face");
  if (std::filesystem::exists(faces)) read_tetgen_faces(faces, first, mesh, nodes);
  take_out_edge_nodes(mesh, nodes, stem + ".ele");
  return mesh;
}

}  // namespace

MeshFile read_mesh(const std::string& path) {
  const std::filesystem::path file(without_gz(path));
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".tet") return read_tet(path);
  const bool tetgen = extension == ".node" || extension == ".ele" || extension == ".face";
  MeshFile mesh = tetgen                ? read_tetgen((file.parent_path() / file.stem()).string())
                  : extension == ".msh" ? read_gmsh(path)
                  : extension == ".vtu" ? VtuReader(path).read()
                                        : MeditReader(path).read();
  mesh.names_sides = true;
  // A list that grew as it was read has up to twice the memory, and a large file stays to the end.
  const auto fit = [](auto&... lists) { (lists.shrink_to_fit(), ...); };
  fit(mesh.vertices, mesh.tetrahedra, mesh.regions, mesh.inside, mesh.boundary, mesh.labels,
      mesh.facets);
  return mesh;
}

}  // namespace tetproof::oracles
