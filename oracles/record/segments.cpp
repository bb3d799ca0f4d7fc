#include "oracles/record/refinement.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

std::string chain_name(std::size_t n, const ExactRecord::Chain& chain) {
  return (chain.artificial ? "artificial segment " : "segment ") + std::to_string(n);
}

class Segments {
 public:
  explicit Segments(const RefinedMesh& mesh)
      : record_(*mesh.record),
        points_(*mesh.points),
        surface_(*mesh.surface),
        complex_(*mesh.complex),
        facets_(surface_, record_),
        input_edges_(surface_),
        edges_(edges_of_chains(record_)),
        in_mesh_(edges_.size()),
        chain_of_(edges_.size(), kNone),
        first_(surface_.edges().size(), kNone),
        last_(surface_.edges().size(), kNone) {
    for (const auto& corner : record_.corners) corner_[corner.vertex] = &corner;
  }

  OracleReport run() {
    if (!facets_.defect().empty()) report_.fail(facets_.defect());
    find_mesh_edges();
    for (std::size_t n = 0; n < record_.segments.size(); ++n) {
      const ExactRecord::Chain& chain = record_.segments[n];
      if (!check_mesh_edges(n, chain)) continue;
      chain.artificial ? check_artificial(n, chain) : check_input(n, chain);
    }
    check_ends();
    report_.checked += surface_.edges().size();
    report_.figures.emplace_back("segments", record_.segments.size());
    report_.figures.emplace_back("artificial segments", artificial_);
    report_.figures.emplace_back("largest bend of an artificial segment", largest_bend_);
    return std::move(report_);
  }

 private:
  void find_mesh_edges();
  bool check_mesh_edges(std::size_t n, const ExactRecord::Chain& chain);
  void check_artificial(std::size_t n, const ExactRecord::Chain& chain);
  void check_input(std::size_t n, const ExactRecord::Chain& chain);
  void check_ends();
  void check_gap(const InputSurface::Edge& edge, Index input_vertex, Index end);
  std::string edge_name(const InputSurface::Edge& edge) const {
    return "input edge " + std::to_string(edge.from) + "-" + std::to_string(edge.to);
  }

  const ExactRecord& record_;
  const ExactPoints& points_;
  const InputSurface& surface_;
  const TetComplex& complex_;
  const FacetIndex facets_;
  const InputEdges input_edges_;
  const SimplexSet<2> edges_;          // of chains
  std::vector<std::uint8_t> in_mesh_;  // per edge of a chain
  std::vector<std::size_t> chain_of_;  // the same; kNone: none yet
  std::unordered_map<Index, const ExactRecord::Corner*> corner_;
  std::vector<Index> first_, last_;  // per input edge: ends of its chain
  std::uint64_t artificial_ = 0;
  double largest_bend_ = 0;
  OracleReport report_{"segments", "input edges and edges of segments"};
};

void Segments::find_mesh_edges() {
  for (const Tet& t : complex_.tetrahedra) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        if (const std::size_t e = edges_.find({t[i], t[j]}); e < edges_.size()) in_mesh_[e] = 1;
      }
    }
  }
}

bool Segments::check_mesh_edges(std::size_t n, const ExactRecord::Chain& chain) {
  if (chain.vertices.size() < 2) {
    report_.fail(chain_name(n, chain) + " has fewer than two vertices");
    return false;
  }
  for (std::size_t i = 1; i < chain.vertices.size(); ++i) {
    const Index a = chain.vertices[i - 1], b = chain.vertices[i];
    ++report_.checked;
    const std::size_t e = edges_.find({a, b});
    if (in_mesh_[e] == 0) {
      report_.fail(chain_name(n, chain) + ": " + complex_.vertex_name(a) + " - " +
                   complex_.vertex_name(b) + " is not an edge of the refined mesh");
    }
    if (chain_of_[e] != kNone) {
      report_.fail(chain_name(n, chain) + " shares an edge with segment " +
                   std::to_string(chain_of_[e]));
    } else {
      chain_of_[e] = n;
    }
  }
  return true;
}

void Segments::check_artificial(std::size_t n, const ExactRecord::Chain& chain) {
  ++artificial_;
  const std::string name = chain_name(n, chain);
  const Index facet = facets_.find(chain.facet);
  if (facet == kNone || !facets_.kept(facet)) {
    return report_.fail(name + " lies in facet " + std::to_string(chain.facet) +
                        ", which was not kept");
  }
  const InputSurface::Facet& plane = surface_.facets()[facet];
  std::vector<Index> sorted = chain.vertices;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    report_.fail(name + " passes a vertex twice");
  }
  const Index from = chain.vertices.front(), to = chain.vertices.back();
  const ExactVector along = exact::difference(points_, from, to);
  const ExactNumber length2 = exact::squared(along);
  ExactNumber reached = 0;
  for (const Index v : chain.vertices) {
    if (plane.side(points_, v) != 0) {
      report_.fail(name + ": " + complex_.vertex_name(v) + " is off the plane of facet " +
                   std::to_string(chain.facet));
    }
    if (v == from) continue;
    const ExactVector w = exact::difference(points_, from, v);
    const ExactNumber position = exact::dot(along, w);
    if (position <= reached || position > length2) report_.fail(name + " turns back");
    reached = position;
    if (v == to) continue;
    // The distance from the straight line is |along x w| / |along|.
    const ExactNumber off2 = exact::squared(exact::cross(along, w));
    if (off2 == 0) continue;
    if (off2.shifted(40) > length2 * length2) {
      report_.fail(name + ": " + complex_.vertex_name(v) +
                   " is farther than 2^-20 of the length from the straight line");
    }
    largest_bend_ = std::max(largest_bend_, std::sqrt(ratio(off2, length2 * length2).get_d()));
  }
}

void Segments::check_input(std::size_t n, const ExactRecord::Chain& chain) {
  const std::string name = chain_name(n, chain);
  const Index e = input_edges_.of_chain(record_, chain.vertices);
  if (e == kNone) return report_.fail(name + " lies on no input edge between two facets");
  const InputSurface::Edge& edge = surface_.edges()[e];
  if (!facets_.kept(edge.left) && !facets_.kept(edge.right)) {
    report_.fail(name + " lies between two filtered facets");
  }
  std::vector<Index> ordered = chain.vertices;
  if (along_edge(points_, edge, ordered.front(), ordered.back()) < 0) {
    std::reverse(ordered.begin(), ordered.end());
  }
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    const Index v = ordered[i];
    const bool on = exact::collinear(points_, edge.from, edge.to, v);
    if (!on) report_.fail(name + ": " + complex_.vertex_name(v) + " is off " + edge_name(edge));
    const bool on_way = i == 0 ? along_edge(points_, edge, edge.from, v) >= 0
                               : along_edge(points_, edge, ordered[i - 1], v) > 0;
    if (!on_way) report_.fail(name + " turns back on " + edge_name(edge));
  }
  if (along_edge(points_, edge, ordered.back(), edge.to) < 0) {
    report_.fail(name + " leaves " + edge_name(edge));
  }
  if (first_[e] != kNone) return report_.fail(edge_name(edge) + " has two segments");
  first_[e] = ordered.front();
  last_[e] = ordered.back();
}

// An edge with a kept facet lacks a part at an end that was chamfered. All of it may be missing if
// both ends were chamfered and its dihedral angle, between kept facets, is below 90 degrees;
// check_chamfer_need decides whether it is below the threshold in force.
void Segments::check_ends() {
  std::uint64_t missing = 0;
  for (std::size_t e = 0; e < surface_.edges().size(); ++e) {
    const InputSurface::Edge& edge = surface_.edges()[e];
    if (!facets_.kept(edge.left) && !facets_.kept(edge.right)) continue;
    if (first_[e] == kNone) {
      ++missing;
      const ExactVector n = surface_.facets()[edge.left].normal(points_),
                        m = surface_.facets()[edge.right].normal(points_);
      // The dihedral angle is acute exactly if that of the outward normals is obtuse.
      const bool acute = facets_.kept(edge.left) && facets_.kept(edge.right) &&
                         exact::dot(n, m) < 0 && corner_.contains(edge.from) &&
                         corner_.contains(edge.to);
      if (!acute) report_.fail(edge_name(edge) + " has no segment and is not acute");
      continue;
    }
    check_gap(edge, edge.from, first_[e]);
    check_gap(edge, edge.to, last_[e]);
  }
  report_.figures.emplace_back("acute edges", missing);
}

// All edges at a chamfered vertex are cut at its distance, and those at others not at all.
void Segments::check_gap(const InputSurface::Edge& edge, Index input_vertex, Index end) {
  const auto corner = corner_.find(input_vertex);
  if (corner == corner_.end()) {
    if (end == input_vertex) return;
    return report_.fail(edge_name(edge) + " has no segment near input vertex " +
                        std::to_string(input_vertex) + ", which was not chamfered");
  }
  const double cut = exact::distance(points_, input_vertex, end);
  const double distance = corner->second->distance;
  // Cut points are placed with a relative accuracy of 2^-20.
  if (!(std::fabs(cut - distance) <= distance * 0x1p-16)) {
    report_.fail(edge_name(edge) + " is not cut off at the distance at input vertex " +
                 std::to_string(input_vertex));
  }
}

}  // namespace

OracleReport check_segments(const RefinedMesh& mesh) {
  return Segments(mesh).run();
}

}  // namespace tetproof::oracles
