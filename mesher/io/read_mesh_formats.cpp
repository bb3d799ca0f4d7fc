// MEDIT, TetGen and .tet; the formats that take more have files of their own.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "mesher/io/mesh_reading.h"

namespace delmesher::io {
namespace {

// --- MEDIT

// Sections that are not kept, with how many numbers an item has.
int numbers_skipped(std::string_view section) {
  static const std::map<std::string_view, int> kNumbers = {{"Edges", 3},
                                                           {"EdgesP2", 4},
                                                           {"Corners", 1},
                                                           {"Ridges", 1},
                                                           {"RequiredVertices", 1},
                                                           {"RequiredEdges", 1},
                                                           {"RequiredTriangles", 1},
                                                           {"Normals", 3},
                                                           {"NormalAtVertices", 2},
                                                           {"Tangents", 3},
                                                           {"TangentAtVertices", 2}};
  const auto found = kNumbers.find(section);
  return found == kNumbers.end() ? 0 : found->second;
}

// An element with `nodes` nodes besides its corners.
template <std::size_t corners, std::size_t nodes>
void add_medit_element(MeshText& in, MeshBuilder& builder) {
  const auto node = in.cell<corners + nodes>(1, builder.vertices());
  const auto reference = in.integer<std::int32_t>("reference");
  if constexpr (corners == 3) {
    builder.add_triangle({node[0], node[1], node[2]}, reference, std::nullopt);
  } else {
    builder.add_tetrahedron({node[0], node[1], node[2], node[3]}, reference);
  }
  builder.add_edge_nodes(std::span(node).first(corners), std::span(node).subspan(corners));
}

void read_medit_section(std::string_view section, MeshText& in, MeshBuilder& builder) {
  if (section == "Dimension") {
    const auto dimension = in.integer<std::int64_t>("dimension");
    if (dimension != 3) in.fail("dimension " + std::to_string(dimension) + ", not 3");
  } else if (section == "Vertices") {
    if (builder.vertices() > 0) in.fail("a second list of vertices");
    for (auto n = in.count("number of vertices", kMostVertices, 8); n > 0; --n) {
      builder.add_vertex(in.point());
      in.integer<std::int64_t>("reference");
    }
  } else if (section == "Triangles" || section == "TrianglesP2") {
    const bool second = section == "TrianglesP2";
    for (auto n = in.count("number of triangles", kMostCells, second ? 14 : 8); n > 0; --n) {
      second ? add_medit_element<3, 3>(in, builder) : add_medit_element<3, 0>(in, builder);
    }
  } else if (section == "Tetrahedra" || section == "TetrahedraP2") {
    const bool second = section == "TetrahedraP2";
    for (auto n = in.count("number of tetrahedra", kMostCells, second ? 22 : 10); n > 0; --n) {
      second ? add_medit_element<4, 6>(in, builder) : add_medit_element<4, 0>(in, builder);
    }
  } else if (const int numbers = numbers_skipped(section); numbers > 0) {
    const auto per_item = static_cast<std::uint64_t>(numbers);
    in.skip(per_item * in.count("number of items", kMostCells, 2 * per_item));
  } else {
    const std::string name = in_quotes(section);
    if (section != "Quadrilaterals" && section != "Hexahedra" && section != "Prisms" &&
        section != "Pyramids") {
      in.fail("unknown section " + name);
    }
    if (in.integer<std::uint64_t>("number of items") > 0) {
      in.fail("a section of " + name + ": a mesh of tetrahedra is expected");
    }
  }
}

// delmesher's comments after the end: "# TriangleFacets N", then "# id" for every triangle.
void read_facets(MeshText& in, MeshBuilder& builder) {
  if (!in.next_line() || in.word_in_line() != "#" || in.word_in_line() != "TriangleFacets") return;
  const auto n = in.count("number of facets", kMostCells, 4);
  if (n != builder.triangles()) {
    in.fail(std::to_string(n) + " facets for " + std::to_string(builder.triangles()) +
            " triangles");
  }
  std::vector<std::uint32_t> facets;
  while (facets.size() < n) {
    if (in.need("a facet") != "#") in.fail("a damaged list of facets");
    facets.push_back(in.integer<std::uint32_t>("facet"));
  }
  builder.set_facets(std::move(facets));
}

}  // namespace

void read_medit(std::string_view text, const std::string& path, Polling& polling,
                MeshBuilder& builder) {
  MeshText in(text, path, Comments::at_token_start, polling);
  if (in.word() != "MeshVersionFormatted") in.fail("not a text file of MEDIT");
  in.integer<std::int64_t>("version");
  for (auto section = in.word(); !section.empty(); section = in.word()) {
    if (section != "End") {
      read_medit_section(section, in, builder);
      continue;
    }
    MeshText rest(text.substr(in.next_offset()), path, Comments::none, polling, in.line() + 1);
    read_facets(rest, builder);
    return;
  }
}

// --- TetGen

namespace {

// The lines of one of TetGen's files, each of which begins with a number that counts from `first`.
class NumberedLines {
 public:
  NumberedLines(std::string_view text, const std::string& file, Polling& polling)
      : in_(text, file, Comments::anywhere, polling) {}

  void begin(const char* what, std::uint64_t most, std::uint64_t bytes) {
    what_ = what;
    count_ = in_.count(what, most, bytes);
  }
  // A number of the header; `fallback` if the line has ended.
  template <class T>
  T header(T fallback, const char* what) {
    const std::string_view token = in_.word_in_line();
    return token.empty() ? fallback : in_.parsed<T>(token, what);
  }
  // To the next line; checks its number. Numbers of the first lines are 0 or 1, unless `first` is
  // told.
  bool next() {
    if (read_ == count_) {
      if (in_.next_line()) in_.fail("lines after the last one");
      return false;
    }
    if (!in_.next_line()) {
      in_.fail("the file ends after " + std::to_string(read_) + " of the " + what_ + " " +
               std::to_string(count_));
    }
    const auto number = in_.parsed<std::uint64_t>(in_.word_in_line(), "number");
    if (read_ == 0) first_ = number;
    if (first_ > 1) in_.fail("the numbers have to begin with 0 or 1");
    if (number != first_ + read_) {
      in_.fail("number " + std::to_string(number) + " where " + std::to_string(first_ + read_) +
               " is expected");
    }
    ++read_;
    return true;
  }
  // Everything of an item is on its line.
  std::string_view need(const char* what) {
    const std::string_view token = in_.word_in_line();
    if (token.empty()) in_.fail(std::string(what) + " is missing");
    return token;
  }
  std::string_view rest() { return in_.word_in_line(); }
  std::uint64_t first() const { return first_; }
  MeshText& text() { return in_; }

 private:
  MeshText in_;
  std::string what_;
  std::uint64_t count_ = 0, read_ = 0, first_ = 0;
};

double coordinate(NumberedLines& lines) {
  return lines.text().finite(lines.need("a coordinate"));
}

template <std::size_t N>
std::array<std::uint32_t, N> cell(NumberedLines& lines, std::uint64_t first,
                                  std::uint64_t vertices) {
  std::array<std::uint32_t, N> corners;
  for (std::uint32_t& corner : corners) {
    corner = lines.text().vertex(lines.need("a vertex"), first, vertices);
  }
  return corners;
}

// Attributes are real numbers for TetGen; as regions they must be whole.
std::int32_t region(NumberedLines& lines) {
  const std::string_view token = lines.need("the attribute");
  double value = 0;
  using Bounds = std::numeric_limits<std::int32_t>;
  if (parse_double(token, value) != NumberStatus::ok || std::trunc(value) != value ||
      value < Bounds::min() || value > Bounds::max()) {
    lines.text().fail("bad attribute " + in_quotes(token) + ": regions are whole numbers");
  }
  return static_cast<std::int32_t>(value);
}

std::uint64_t read_nodes(std::string_view text, const std::string& file, Polling& polling,
                         MeshBuilder& builder) {
  NumberedLines lines(text, file, polling);
  lines.begin("number of points", kMostVertices, 8);
  const auto dimension = lines.header<std::int64_t>(3, "dimension");
  if (dimension != 3) lines.text().fail("dimension " + std::to_string(dimension) + ", not 3");
  while (lines.next()) {
    const double x = coordinate(lines), y = coordinate(lines), z = coordinate(lines);
    builder.add_vertex({x, y, z});
  }
  return lines.first();
}

void read_elements(std::string_view text, const std::string& file, std::uint64_t first,
                   Polling& polling, MeshBuilder& builder) {
  NumberedLines lines(text, file, polling);
  lines.begin("number of tetrahedra", kMostCells, 10);
  const auto corners = lines.header<std::int64_t>(4, "number of corners");
  if (corners != 4 && corners != 10) {
    lines.text().fail("tetrahedra of " + std::to_string(corners) + " points, not 4 or 10");
  }
  const auto attributes = lines.header<std::int64_t>(0, "number of attributes");
  while (lines.next()) {
    const auto tetrahedron = cell<4>(lines, first, builder.vertices());
    std::array<std::uint32_t, 6> nodes{};
    if (corners == 10) nodes = cell<6>(lines, first, builder.vertices());
    builder.add_tetrahedron(tetrahedron,
                            attributes > 0 ? std::optional(region(lines)) : std::nullopt);
    builder.add_edge_nodes(tetrahedron, std::span(nodes).first(corners == 10 ? 6 : 0));
  }
}

void read_faces(std::string_view text, const std::string& file, std::uint64_t first,
                Polling& polling, MeshBuilder& builder) {
  NumberedLines lines(text, file, polling);
  lines.begin("number of faces", kMostCells, 8);
  const auto markers = lines.header<std::int64_t>(0, "number of markers");
  while (lines.next()) {
    const auto triangle = cell<3>(lines, first, builder.vertices());
    std::int32_t label = 0;
    std::optional<std::uint32_t> facet;
    std::vector<std::string_view> numbers;
    for (auto number = lines.rest(); !number.empty(); number = lines.rest()) {
      numbers.push_back(number);
    }
    // TetGen's -o2 gives faces of a surface the nodes on their edges, and those of a hull not.
    if (builder.order() == 2 && numbers.size() >= (markers > 0 ? 4 : 3)) {
      numbers.erase(numbers.begin(), numbers.begin() + 3);
    }
    if (markers > 0) {
      if (numbers.empty()) lines.text().fail("the marker is missing");
      label = lines.text().parsed<std::int32_t>(numbers[0], "marker");
      // One number more is delmesher's facet; two are the tetrahedra of `tetgen -nn`.
      if (numbers.size() == 2) facet = lines.text().parsed<std::uint32_t>(numbers[1], "facet");
    }
    builder.add_triangle(triangle, label, facet);
  }
}

}  // namespace

void read_tetgen_mesh(std::string_view node, const std::string& path, const FileBeside& beside,
                      Polling& polling, MeshBuilder& builder) {
  const std::uint64_t first = read_nodes(node, path, polling, builder);
  const std::optional<std::string> ele = beside ? beside(".ele") : std::nullopt;
  const std::string ele_name = name_beside(path, ".ele");
  if (!ele) throw FileError{path + ": there is no " + ele_name + " beside it"};
  read_elements(*ele, ele_name, first, polling, builder);
  if (const std::optional<std::string> face = beside(".face")) {
    read_faces(*face, name_beside(path, ".face"), first, polling, builder);
  }
}

// --- .tet

void read_tet(std::string_view text, const std::string& path, Polling& polling,
              MeshBuilder& builder) {
  MeshText in(text, path, Comments::none, polling);
  const auto need_word = [&](std::string_view expected) {
    const std::string_view token = in.need("the header");
    if (token != expected) {
      in.fail("'" + std::string(expected) + "' expected, not " + in_quotes(token));
    }
  };
  const auto vertices = in.count("number of vertices", kMostVertices, 6);
  need_word("vertices");
  const auto inner = in.count("number of tetrahedra", kMostCells, 10);
  std::uint64_t outer = 0;
  const std::string_view kind = in.need("the header");
  if (kind == "inner") {
    need_word("tets");
    outer = in.count("number of tetrahedra", kMostCells - inner, 10);
    need_word("outer");
    need_word("tets");
  } else if (kind != "tets") {
    in.fail("'tets' expected, not " + in_quotes(kind));
  }
  for (std::uint64_t v = 0; v < vertices; ++v) builder.add_vertex(in.point());
  for (std::uint64_t t = 0; t < inner + outer; ++t) {
    if (in.integer<std::uint64_t>("number of corners") != 4) in.fail("a cell of not 4 corners");
    builder.add_tetrahedron(in.cell<4>(0, vertices), std::nullopt, t < inner);
  }
}

}  // namespace delmesher::io
