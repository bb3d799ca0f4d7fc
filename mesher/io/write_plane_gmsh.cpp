// Gmsh MSH 4.1, binary or ASCII, of the plane.
#include <algorithm>
#include <map>
#include <vector>

#include "mesher/io/gmsh_numbers.h"
#include "mesher/io/write_plane_formats.h"

namespace delmesher::io {
namespace {

// One curve per marker, one surface per side.
class PlaneGmshWriter {
 public:
  PlaneGmshWriter(TextSink& out, const PlaneMesh& mesh, bool ascii)
      : out_(out), numbers_(out, ascii), mesh_(mesh) {
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      curves_[mesh.edge_markers[e]].push_back(e);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      surfaces_[region(mesh, t)].push_back(t);
    }
  }

  void write() {
    numbers_.format();
    write_names();
    numbers_.in_section("Entities", [&] { write_entities(); });
    numbers_.in_section("Nodes", [&] { write_nodes(); });
    numbers_.in_section("Elements", [&] { write_elements(); });
  }

 private:
  void write_names() {
    out_.text("$PhysicalNames\n");
    out_.integer(curves_.size() + surfaces_.size());
    line(out_);
    int tag = 0;
    for (const auto& [marker, edges] : curves_) {
      out_.integers(1, ++tag);
      out_.text("\"marker ");
      out_.integer(marker);
      out_.text("\"\n");
    }
    for (const auto& [side, triangles] : surfaces_) {
      out_.integers(2, side);
      out_.text(side == 1 ? "\"inside\"\n" : "\"outside\"\n");
    }
    out_.text("$EndPhysicalNames\n");
  }

  void write_entity(int tag) {
    numbers_.tag(tag);
    for (const auto& [x, y] : {low_, high_}) numbers_.point({x, y, 0});
    numbers_.size(1);
    numbers_.tag(tag);
    numbers_.size(0);
    numbers_.end_line();
  }

  void write_entities() {
    if (!mesh_.vertices.empty()) low_ = high_ = mesh_.vertices[0];
    for (const Point2& p : mesh_.vertices) {
      for (std::size_t k = 0; k < 2; ++k) {
        low_[k] = std::min(low_[k], p[k]);
        high_[k] = std::max(high_[k], p[k]);
      }
    }
    for (const std::size_t count :
         {std::size_t{0}, curves_.size(), surfaces_.size(), std::size_t{0}}) {
      numbers_.size(count);
    }
    numbers_.end_line();
    for (std::size_t k = 0; k < curves_.size(); ++k) write_entity(static_cast<int>(k) + 1);
    for (const auto& [side, triangles] : surfaces_) write_entity(side);
  }

  void write_nodes() {
    const int first = surfaces_.empty() ? 1 : surfaces_.begin()->first;
    numbers_.number_nodes(2, first, mesh_.vertices.size());
    for (const auto& [x, y] : mesh_.vertices) {
      numbers_.point({x, y, 0});
      numbers_.end_line();
    }
  }

  template <class Cells>
  void write_block(int dimension, int tag, int type, const std::vector<std::size_t>& members,
                   const Cells& cells) {
    numbers_.begin_block(dimension, tag, type, members.size());
    for (const std::size_t i : members) {
      numbers_.size(++element_);
      for (const std::uint32_t v : cells[i]) numbers_.size(v + 1ULL);
      numbers_.end_line();
    }
  }

  void write_elements() {
    numbers_.announce(curves_.size() + surfaces_.size(),
                      mesh_.edges.size() + mesh_.triangles.size());
    int tag = 0;
    for (const auto& [marker, edges] : curves_) write_block(1, ++tag, 1, edges, mesh_.edges);
    for (const auto& [side, triangles] : surfaces_) {
      write_block(2, side, 2, triangles, mesh_.triangles);
    }
  }

  TextSink& out_;
  GmshNumbers numbers_;
  const PlaneMesh& mesh_;
  std::map<std::int32_t, std::vector<std::size_t>> curves_;
  std::map<int, std::vector<std::size_t>> surfaces_;
  Point2 low_ = {0, 0}, high_ = {0, 0};
  std::size_t element_ = 0;
};

}  // namespace

void write_plane_gmsh(TextSink& out, const PlaneMesh& mesh, bool ascii) {
  PlaneGmshWriter(out, mesh, ascii).write();
}

}  // namespace delmesher::io
