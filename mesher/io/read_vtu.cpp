// VTK's XML for unstructured grids: points, tetrahedra, triangles, and the cell data that write_vtu
// writes.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mesher/io/mesh_reading.h"
#include "mesher/io/vtu_arrays.h"

namespace delmesher::io {
namespace {

// Nodes of a cell of VTK's; 0 for those that are not read.
std::uint64_t nodes_of(int type) {
  switch (type) {
    case 1:  // vertex
      return 1;
    case 3:  // line
      return 2;
    case 5:   // triangle
    case 21:  // line of second order
      return 3;
    case 10:  // tetrahedron
      return 4;
    case 22:  // triangle of second order
      return 6;
    case 24:  // tetrahedron of second order
      return 10;
    default:
      return 0;
  }
}

class VtuReader {
 public:
  VtuReader(std::string_view text, Polling& polling, MeshBuilder& builder)
      : arrays_(text, polling), polling_(polling), builder_(builder) {}

  void read() {
    read_points();
    corners_ = arrays_.required_integers<std::uint64_t>("Cells connectivity");
    offsets_ = arrays_.required_integers<std::uint64_t>("Cells offsets");
    types_ = arrays_.required_integers<int>("Cells types");
    inside_ = arrays_.integers<int>("CellData inside");
    region_ = arrays_.integers<std::int32_t>("CellData region");
    label_ = arrays_.integers<std::int32_t>("CellData label");
    facet_ = arrays_.integers<std::int64_t>("CellData facet");
    check_sizes();
    arrays_.each_field_of_two([&](const std::string& name, std::int64_t number, std::int64_t dim) {
      if (!std::in_range<std::int32_t>(number)) return;
      if (dim == 2) builder_.name_label(static_cast<std::int32_t>(number), name);
      if (dim == 3) builder_.name_region(static_cast<std::int32_t>(number), name);
    });
    std::uint64_t begin = 0;
    for (std::size_t n = 0; n < types_.size(); begin = offsets_[n++]) {
      polling_.poll(8);
      read_cell(n, begin);
    }
  }

 private:
  [[noreturn]] static void refuse(const std::string& reason) { fail(at_line(1), reason); }

  void read_points() {
    std::vector<double> x;
    const auto line = at_line(arrays_.line_of("Points"));
    const bool there = arrays_.each_number("Points", [&](auto value) {
      x.push_back(static_cast<double>(value));
      if (!std::isfinite(x.back())) fail(line, "non-finite coordinate");
      if (x.size() < 3) return;
      if (builder_.vertices() >= kMostVertices) fail(line, "too many points");
      builder_.add_vertex({x[0], x[1], x[2]});
      x.clear();
    });
    if (!there) refuse("there are no points");
    if (!x.empty()) fail(line, "the last point has fewer than 3 coordinates");
  }

  void check_sizes() const {
    const auto must_fit = [&](std::size_t size, const char* name) {
      if (size != 0 && size != types_.size()) {
        refuse(std::to_string(size) + " values of '" + name + "' for " +
               std::to_string(types_.size()) + " cells");
      }
    };
    if (offsets_.size() != types_.size()) {
      refuse(std::to_string(offsets_.size()) + " offsets for " + std::to_string(types_.size()) +
             " cells");
    }
    must_fit(inside_.size(), "inside");
    must_fit(region_.size(), "region");
    must_fit(label_.size(), "label");
    must_fit(facet_.size(), "facet");
    if (types_.size() > kMostCells) refuse("too many cells");
  }

  void read_cell(std::size_t n, std::uint64_t begin) {
    const std::uint64_t size = nodes_of(types_[n]);
    if (size == 0) {
      refuse("cell " + std::to_string(n) + " is of type " + std::to_string(types_[n]) +
             ": a mesh of tetrahedra is expected");
    }
    if (offsets_[n] > corners_.size() || offsets_[n] < begin || offsets_[n] - begin != size) {
      refuse("cell " + std::to_string(n) + ": bad offset " + std::to_string(offsets_[n]));
    }
    std::array<std::uint32_t, 10> node{};
    for (std::uint64_t i = 0; i < size; ++i) {
      const std::uint64_t v = corners_[begin + i];
      if (v >= builder_.vertices()) {
        refuse("cell " + std::to_string(n) + ": vertex index out of range: " + std::to_string(v) +
               " of " + std::to_string(builder_.vertices()));
      }
      node[i] = static_cast<std::uint32_t>(v);
    }
    if (types_[n] == 10 || types_[n] == 24) {
      builder_.add_tetrahedron({node[0], node[1], node[2], node[3]},
                               region_.empty() ? std::nullopt : std::optional(region_[n]),
                               inside_.empty() || inside_[n] != 0);
      builder_.add_edge_nodes(std::span(node).first(4), std::span(node).subspan(4, size - 4));
    } else if (types_[n] == 5 || types_[n] == 22) {
      const bool is_facet = !facet_.empty() && facet_[n] >= 0 && facet_[n] <= 0xffffffffLL;
      builder_.add_triangle(
          {node[0], node[1], node[2]}, label_.empty() ? 0 : label_[n],
          is_facet ? std::optional(static_cast<std::uint32_t>(facet_[n])) : std::nullopt);
      builder_.add_edge_nodes(std::span(node).first(3), std::span(node).subspan(3, size - 3));
    }
  }

  VtuArrays arrays_;
  Polling& polling_;
  MeshBuilder& builder_;
  std::vector<std::uint64_t> corners_, offsets_;
  std::vector<int> types_, inside_;
  std::vector<std::int32_t> region_, label_;
  std::vector<std::int64_t> facet_;
};

}  // namespace

void read_vtu(std::string_view text, const std::string& /*path*/, Polling& polling,
              MeshBuilder& builder) {
  VtuReader(text, polling, builder).read();
}

}  // namespace delmesher::io
