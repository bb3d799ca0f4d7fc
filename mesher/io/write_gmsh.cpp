// Gmsh MSH 4.1, ASCII (Gmsh reference manual, "MSH file format"). One surface entity per facet, one
// volume entity per region; physical groups carry the labels.
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "mesher/io/write_formats.h"

namespace delmesher::io {
namespace {

struct Box {
  std::array<double, 3> low, high;
  Box() {
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
  }
  void add(const std::array<double, 3>& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
};

class GmshWriter {
 public:
  GmshWriter(TextSink& out, const TetMesh& mesh) : out_(out), mesh_(mesh) {
    number_labels();
    order_triangles();
  }

  void write() {
    out_.text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    write_physical_names();
    write_entities();
    write_nodes();
    write_elements();
  }

 private:
  void number_labels();
  void order_triangles();
  void write_physical_names();
  void write_entities();
  void write_volume(int tag);
  void write_nodes();
  void write_elements();
  void box(const Box& b) {
    out_.point(b.low);
    out_.text(" ");
    out_.point(b.high);
    out_.text(" ");
  }
  std::uint64_t facet_tag(std::size_t triangle) const {
    return std::uint64_t{mesh_.boundary_facets[triangle]} + 1;  // tags begin at 1
  }
  // Calls action(begin, end) for every run of one facet in order_.
  template <typename Action>
  void each_facet(Action action) const {
    for (std::size_t begin = 0, end = 0; begin < order_.size(); begin = end) {
      while (end < order_.size() && facet_tag(order_[end]) == facet_tag(order_[begin])) ++end;
      action(begin, end);
    }
  }

  TextSink& out_;
  const TetMesh& mesh_;
  std::map<std::int32_t, std::int64_t> physical_;  // of a label
  std::vector<std::size_t> order_;                 // boundary triangles by facet
  std::size_t facets_ = 0;
};

// A physical tag has to be positive: positive labels are their own tag, the others (0, the default,
// among them) get the tags after the largest. The names tell the labels in every case.
void GmshWriter::number_labels() {
  for (std::int32_t label : mesh_.boundary_labels) physical_[label] = label;
  std::int64_t next = physical_.empty() ? 1 : std::max(physical_.rbegin()->first, 0) + 1LL;
  for (auto it = physical_.rbegin(); it != physical_.rend(); ++it) {
    if (it->first <= 0) it->second = next++;
  }
}

void GmshWriter::order_triangles() {
  order_.resize(mesh_.boundary.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return mesh_.boundary_facets[a] < mesh_.boundary_facets[b];
  });
  each_facet([&](std::size_t, std::size_t) { ++facets_; });
}

void GmshWriter::write_physical_names() {
  out_.text("$PhysicalNames\n");
  out_.integer(physical_.size() + 2);
  out_.text("\n");
  for (const auto& [label, tag] : physical_) {
    out_.text("2 ");
    out_.integer(tag);
    out_.text(" \"label ");
    out_.integer(label);
    out_.text("\"\n");
  }
  out_.text("3 1 \"inside\"\n3 2 \"outside\"\n$EndPhysicalNames\n");
}

void GmshWriter::write_volume(int tag) {
  Box volume;
  for (const auto& v : mesh_.vertices) volume.add(v);
  if (mesh_.vertices.empty()) volume.add({0, 0, 0});
  out_.integers(tag);
  box(volume);
  out_.integers(1, tag);
  out_.text("0\n");
}

void GmshWriter::write_entities() {
  out_.text("$Entities\n0 0 ");
  out_.integers(facets_);
  out_.text("2\n");
  each_facet([&](std::size_t begin, std::size_t end) {
    Box facet;
    for (std::size_t i = begin; i < end; ++i) {
      for (std::uint32_t v : mesh_.boundary[order_[i]]) facet.add(mesh_.vertices[v]);
    }
    out_.integers(facet_tag(order_[begin]));
    box(facet);
    out_.integers(1, physical_.at(mesh_.boundary_labels[order_[begin]]));
    out_.text("0\n");
  });
  write_volume(kRegionInside);
  write_volume(kRegionOutside);
  out_.text("$EndEntities\n");
}

void GmshWriter::write_nodes() {
  const std::size_t n = mesh_.vertices.size();
  out_.text("$Nodes\n");
  out_.integers(n == 0 ? 0 : 1, n, n == 0 ? 0 : 1);
  out_.integer(n);
  out_.text("\n");
  if (n != 0) {
    out_.text("3 1 0 ");
    out_.integer(n);
    out_.text("\n");
  }
  for (std::size_t i = 1; i <= n; ++i) {
    out_.integer(i);
    out_.text("\n");
  }
  for (const auto& v : mesh_.vertices) {
    out_.point(v);
    out_.text("\n");
  }
  out_.text("$EndNodes\n");
}

void GmshWriter::write_elements() {
  std::array<std::size_t, 3> count = {0, 0, 0};  // by region
  for (auto flag : mesh_.inside) ++count[flag != 0 ? kRegionInside : kRegionOutside];
  const std::size_t volumes = (count[kRegionInside] > 0 ? 1U : 0U) + (count[kRegionOutside] > 0);
  const std::size_t total = mesh_.boundary.size() + mesh_.tetrahedra.size();
  out_.text("$Elements\n");
  out_.integers(facets_ + volumes, total, total == 0 ? 0 : 1);
  out_.integer(total);
  out_.text("\n");
  std::size_t tag = 1;
  each_facet([&](std::size_t begin, std::size_t end) {
    out_.text("2 ");
    out_.integers(facet_tag(order_[begin]));
    out_.text("2 ");
    out_.integer(end - begin);
    out_.text("\n");
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [a, b, c] = mesh_.boundary[order_[i]];
      out_.integers(tag++, a + 1, b + 1);
      out_.integer(c + 1);
      out_.text("\n");
    }
  });
  for (const int region : {kRegionInside, kRegionOutside}) {
    if (count[static_cast<std::size_t>(region)] == 0) continue;
    out_.text("3 ");
    out_.integers(region);
    out_.text("4 ");
    out_.integer(count[static_cast<std::size_t>(region)]);
    out_.text("\n");
    for (std::size_t i = 0; i < mesh_.tetrahedra.size(); ++i) {
      if ((mesh_.inside[i] != 0 ? kRegionInside : kRegionOutside) != region) continue;
      const auto& [a, b, c, d] = mesh_.tetrahedra[i];
      out_.integers(tag++, a + 1, b + 1, c + 1);
      out_.integer(d + 1);
      out_.text("\n");
    }
  }
  out_.text("$EndElements\n");
}

}  // namespace

void write_gmsh(TextSink& out, const TetMesh& mesh) {
  GmshWriter(out, mesh).write();
}

}  // namespace delmesher::io
