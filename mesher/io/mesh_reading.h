// The common parts of the readers of tetrahedral meshes: numbers as tokens, and the builder of a
// mesh. The readers throw FileError; parse_mesh chooses among them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesher/base/polling.h"
#include "mesher/delmesher_files.h"
#include "mesher/io/binary.h"
#include "mesher/io/reading.h"
#include "mesher/io/text.h"

namespace delmesher::io {

// A file's text, token by token, on any lines.
class MeshText {
 public:
  // `file` is its name in messages, `first_line` the number of the text's first line in it.
  MeshText(std::string_view text, std::string file, Comments comments, Polling& polling,
           std::uint64_t first_line = 1)
      : lines_(text, comments, ','),
        file_(std::move(file)),
        polling_(polling),
        skipped_(first_line - 1) {}

  [[noreturn]] void fail(const std::string& reason) const;

  // The next token on this line or a later one; empty at the end.
  std::string_view word();
  // The same; `what` is missing at the end.
  std::string_view need(const char* what);
  // The next token of this line; empty if there is none.
  std::string_view word_in_line();
  // To the next line that holds something; false at the end.
  bool next_line() { return lines_.next_line(); }
  // Takes the rest of this line.
  std::string_view take_rest_of_line();
  std::size_t next_offset() const { return lines_.next_offset(); }
  std::uint64_t line() const { return lines_.line() + skipped_; }

  template <class T>
  T integer(const char* what) {
    return parsed<T>(need(what), what);
  }
  // A number as bytes, after this line or the bytes before it.
  template <class T>
  T binary(const char* what) {
    return number_from<T>(bytes(sizeof(T), what));
  }
  std::string_view bytes(std::size_t count, const char* what);
  template <class T>
  T parsed(std::string_view token, const char* what) const {
    T value{};
    if (!parse_integer(token, value)) fail("bad " + std::string(what) + " " + in_quotes(token));
    return value;
  }
  double coordinate() { return finite(need("a coordinate")); }
  double finite(std::string_view token) const;
  std::array<double, 3> point();
  // How many items follow, of at least `bytes` bytes each; no more than `most`.
  std::uint64_t count(const char* what, std::uint64_t most, std::uint64_t bytes);
  // The same of a number that is known.
  std::uint64_t count(std::uint64_t n, const char* what, std::uint64_t most, std::uint64_t bytes);
  // The number, from 0, of a vertex that the file counts from `first`.
  std::uint32_t vertex(std::string_view token, std::uint64_t first, std::uint64_t vertices) const;
  template <std::size_t N>
  std::array<std::uint32_t, N> cell(std::uint64_t first, std::uint64_t vertices) {
    std::array<std::uint32_t, N> corners;
    for (std::uint32_t& corner : corners) corner = vertex(need("a vertex"), first, vertices);
    return corners;
  }
  // Passes over tokens that are not used.
  void skip(std::uint64_t tokens);

 private:
  TextLines lines_;
  std::string file_;
  Polling& polling_;
  std::uint64_t skipped_;
};

inline constexpr std::uint64_t kMostVertices = 0xfffffff0ULL;
inline constexpr std::uint64_t kMostCells = (std::uint64_t{1} << 30U) - 16;

// The mesh that a reader finds. Facets are kept if every triangle has one; if not, or if triangles
// of a facet have several labels, all triangles of a label are one facet.
class MeshBuilder {
 public:
  std::uint64_t vertices() const { return mesh_.vertices.size(); }
  void add_vertex(const std::array<double, 3>& p) { mesh_.vertices.push_back(p); }
  void add_tetrahedron(const std::array<std::uint32_t, 4>& t, std::optional<std::int32_t> region,
                       bool inside = true);
  void add_triangle(const std::array<std::uint32_t, 3>& t, std::int32_t label,
                    std::optional<std::uint32_t> facet);
  // Nodes that an element of second order has besides its corners, each of which is meant to be in
  // the middle of an edge. They are not vertices of the mesh.
  void add_edge_nodes(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> nodes);
  // For the formats that tell them at the end of a file; of the number of triangles.
  void set_facets(std::vector<std::uint32_t> facets);
  std::size_t triangles() const { return mesh_.boundary.size(); }
  std::size_t tetrahedra() const { return mesh_.tetrahedra.size(); }
  void name_label(std::int32_t label, std::string_view name) {
    if (!name.empty()) names_[label] = as_utf8(name);
  }
  void name_region(std::int32_t region, std::string_view name) {
    if (!name.empty()) region_names_[region] = as_utf8(name);
  }
  const LabelNames& names() const { return names_; }
  const LabelNames& region_names() const { return region_names_; }
  // 2 if there are elements of second order, else 1.
  int order() const { return is_edge_node_.empty() ? 1 : 2; }
  const std::vector<std::string>& warnings() const { return warnings_; }

  // Throws ParseError, without a place.
  TetMesh finish();

 private:
  void take_out_edge_nodes();
  void choose_facets();

  TetMesh mesh_;
  LabelNames names_, region_names_;
  bool all_facets_ = true;
  std::vector<bool> is_edge_node_;  // of the vertices; empty if all elements are of first order
  std::uint64_t curved_ = 0;        // elements with a node that is not in the middle of an edge
  double farthest_ = 0;             // of these nodes, as a fraction of the edge
  std::vector<std::string> warnings_;
};

// The text of the file beside, with this extension; nullopt if there is none.
using FileBeside = std::function<std::optional<std::string>(const char* extension)>;

void read_medit(std::string_view text, const std::string& path, Polling& polling,
                MeshBuilder& builder);
void read_gmsh(std::string_view text, const std::string& path, Polling& polling,
               MeshBuilder& builder);
void read_vtu(std::string_view text, const std::string& path, Polling& polling,
              MeshBuilder& builder);
void read_tet(std::string_view text, const std::string& path, Polling& polling,
              MeshBuilder& builder);
// `node` is the text of the .node file; .ele and .face are beside it.
void read_tetgen_mesh(std::string_view node, const std::string& path, const FileBeside& beside,
                      Polling& polling, MeshBuilder& builder);

}  // namespace delmesher::io
