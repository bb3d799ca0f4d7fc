// Gmsh MSH 4.1, ASCII, of the plane.
#include <algorithm>
#include <map>
#include <vector>

#include "mesher/io/write_plane_formats.h"

namespace delmesher::io {
namespace {

// One curve per marker, one surface per side.
class PlaneGmshWriter {
 public:
  PlaneGmshWriter(TextSink& out, const PlaneMesh& mesh) : out_(out), mesh_(mesh) {
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      curves_[mesh.edge_markers[e]].push_back(e);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      surfaces_[region(mesh, t)].push_back(t);
    }
  }

  void write() {
    out_.text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    write_names();
    write_entities();
    write_nodes();
    write_elements();
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
    out_.integers(tag);
    for (const Point2& p : {low_, high_}) {
      point(out_, p);
      out_.text(" 0 ");
    }
    out_.integers(1, tag);
    out_.text("0\n");
  }

  void write_entities() {
    if (!mesh_.vertices.empty()) low_ = high_ = mesh_.vertices[0];
    for (const Point2& p : mesh_.vertices) {
      for (std::size_t k = 0; k < 2; ++k) {
        low_[k] = std::min(low_[k], p[k]);
        high_[k] = std::max(high_[k], p[k]);
      }
    }
    out_.text("$Entities\n0 ");
    out_.integers(curves_.size(), surfaces_.size());
    out_.text("0\n");
    for (std::size_t k = 0; k < curves_.size(); ++k) write_entity(static_cast<int>(k) + 1);
    for (const auto& [side, triangles] : surfaces_) write_entity(side);
    out_.text("$EndEntities\n");
  }

  void write_nodes() {
    const std::size_t n = mesh_.vertices.size();
    const int side = surfaces_.empty() ? 1 : surfaces_.begin()->first;
    out_.text("$Nodes\n");
    out_.integers(n == 0 ? 0 : 1, n, n == 0 ? 0 : 1);
    out_.integer(n);
    line(out_);
    if (n != 0) {
      out_.integers(2, side, 0);
      out_.integer(n);
      line(out_);
    }
    for (std::size_t i = 1; i <= n; ++i) {
      out_.integer(i);
      line(out_);
    }
    for (const Point2& p : mesh_.vertices) {
      point(out_, p);
      out_.text(" 0\n");
    }
    out_.text("$EndNodes\n");
  }

  template <class Cells>
  void write_block(int dimension, int tag, int type, const std::vector<std::size_t>& members,
                   const Cells& cells) {
    out_.integers(dimension, tag, type);
    out_.integer(members.size());
    line(out_);
    for (const std::size_t i : members) {
      out_.integers(++element_);
      for (const std::uint32_t v : cells[i]) out_.integers(v + 1);
      line(out_);
    }
  }

  void write_elements() {
    const std::size_t total = mesh_.edges.size() + mesh_.triangles.size();
    out_.text("$Elements\n");
    out_.integers(curves_.size() + surfaces_.size(), total, total == 0 ? 0 : 1);
    out_.integer(total);
    line(out_);
    int tag = 0;
    for (const auto& [marker, edges] : curves_) write_block(1, ++tag, 1, edges, mesh_.edges);
    for (const auto& [side, triangles] : surfaces_) {
      write_block(2, side, 2, triangles, mesh_.triangles);
    }
    out_.text("$EndElements\n");
  }

  TextSink& out_;
  const PlaneMesh& mesh_;
  std::map<std::int32_t, std::vector<std::size_t>> curves_;
  std::map<int, std::vector<std::size_t>> surfaces_;
  Point2 low_ = {0, 0}, high_ = {0, 0};
  std::size_t element_ = 0;
};

}  // namespace

void write_plane_gmsh(TextSink& out, const PlaneMesh& mesh) {
  PlaneGmshWriter(out, mesh).write();
}

}  // namespace delmesher::io
