#include "oracles/files/edge_nodes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "oracles/base/text_reader.h"
#include "oracles/base/vectors.h"
#include "oracles/verdict/verdict.h"

namespace tetproof::oracles {
namespace {

class EdgeNodeList {
 public:
  EdgeNodeList(MeshFile& mesh, const std::string& path) : mesh_(mesh), path_(path) {}

  template <class Cells, class Nodes>
  void add(const Cells& cells, const Nodes& nodes) {
    if (cells.size() != nodes.size()) fail("elements of first and of second order");
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for (std::size_t e = 0; e < nodes[i].size(); ++e) {
        const Index a = cells[i][kNodeEnds[e][0]], b = cells[i][kNodeEnds[e][1]];
        on_edges_.push_back({std::min(a, b), std::max(a, b), nodes[i][e]});
      }
    }
  }

  void take_out() {
    std::sort(on_edges_.begin(), on_edges_.end());
    on_edges_.erase(std::unique(on_edges_.begin(), on_edges_.end()), on_edges_.end());
    check_edges();
    const std::vector<Index> number = numbers_without();
    for (const auto& [a, b, node] : on_edges_) {
      mesh_.edge_nodes.push_back({{number[a], number[b]}, mesh_.vertices[node]});
    }
    for (Tet& tet : mesh_.tetrahedra) renumber(tet, number);
    for (Face& face : mesh_.boundary) renumber(face, number);
    std::vector<Position> vertices;
    for (Index v = 0; v < number.size(); ++v) {
      if (number[v] != kNone) vertices.push_back(mesh_.vertices[v]);
    }
    mesh_.vertices = std::move(vertices);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw ReadError(path_ + ": " + reason);
  }

  void check_edges() const {
    for (std::size_t i = 1; i < on_edges_.size(); ++i) {
      const auto& [c, d, other] = on_edges_[i - 1];
      const auto& [a, b, node] = on_edges_[i];
      if (a == c && b == d) {
        fail("the edge of nodes " + std::to_string(a) + " and " + std::to_string(b) +
             " has two nodes between them, " + std::to_string(other) + " and " +
             std::to_string(node));
      }
    }
  }

  // Per node: its number among those that are on no edge, or kNone.
  std::vector<Index> numbers_without() const {
    std::vector<Index> number(mesh_.vertices.size(), 0);
    for (const auto& [a, b, node] : on_edges_) {
      if (number[node] == kNone) fail("node " + std::to_string(node) + " is on two edges");
      number[node] = kNone;
    }
    for (const auto& [a, b, node] : on_edges_) {
      for (const Index v : {a, b}) {
        if (number[v] == kNone) fail("node " + std::to_string(v) + " is a corner and on an edge");
      }
    }
    Index next = 0;
    for (Index& n : number) n = n == kNone ? kNone : next++;
    return number;
  }

  template <class Cell>
  static void renumber(Cell& cell, const std::vector<Index>& number) {
    for (Index& v : cell) v = number[v];
  }

  MeshFile& mesh_;
  const std::string& path_;
  std::vector<std::array<Index, 3>> on_edges_;  // the ends, and the node between them
};

}  // namespace

void take_out_edge_nodes(MeshFile& mesh, const NodesOnEdges& nodes, const std::string& path) {
  if (nodes.of_tetrahedra.empty() && nodes.of_triangles.empty()) return;
  EdgeNodeList list(mesh, path);
  list.add(mesh.tetrahedra, nodes.of_tetrahedra);
  list.add(mesh.boundary, nodes.of_triangles);
  list.take_out();
}

OracleReport check_edge_nodes(const MeshFile& mesh, double declared, double largest_given) {
  OracleReport report("edge-nodes", "edges");
  if (mesh.edge_nodes.empty()) report.fail("the elements are linear, promised was --order 2");
  double farthest = 0;
  for (const auto& [ends, at] : mesh.edge_nodes) {
    ++report.checked;
    const double largest = std::max({largest_component(mesh.vertices[ends[0]]),
                                     largest_component(mesh.vertices[ends[1]]), largest_given});
    const double allowed = std::max(kRoundedUlps * unit_in_last_place(largest), declared);
    double off = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double middle = mesh.vertices[ends[0]][k] / 2 + mesh.vertices[ends[1]][k] / 2;
      const double distance = std::fabs(at[k] - middle);
      off = distance <= off || std::isnan(off) ? off : distance;
    }
    if (off <= allowed) {  // false for NaN
      farthest = std::max(farthest, off);
      continue;
    }
    char text[120];
    std::snprintf(text, sizeof text, "the node of edge %u %u is %.3g away from the middle", ends[0],
                  ends[1], off);
    report.fail(text);
  }
  report.figures.emplace_back("farthest from the middle", farthest);
  return report;
}

}  // namespace tetproof::oracles
