#include "oracles/record/refined_index.h"

#include <algorithm>

namespace tetproof::oracles {

using delmesher::ExactPoint;
using delmesher::ExactRecord;

FacetIndex::FacetIndex(const InputSurface& surface, const ExactRecord& record) : surface_(surface) {
  kept_.assign(surface.facets().size(), 1);
  std::uint64_t named = 0;
  std::vector<std::uint8_t> seen(surface.triangles().size());
  for (const ExactRecord::Facet& facet : record.facets) {
    const Index f = find(facet.id);
    if (f == kNone || surface.facets()[f].label != facet.label) {
      defect_ = "facet " + std::to_string(facet.id) + " of the record is not in the surface";
      continue;
    }
    ++named;
    kept_[f] = facet.filtered ? 0 : 1;
    for (const Index t : facet.triangles) {
      if (t >= surface.triangles().size() || surface.facet_of_triangle()[t] != f) {
        defect_ = "facet " + std::to_string(facet.id) + " of the record has triangle " +
                  std::to_string(t) + ", which is not its";
      } else if (seen[t]++ != 0) {
        defect_ = "triangle " + std::to_string(t) + " is in facets of the record twice";
      }
    }
  }
  if (!record.facets.empty() && defect_.empty()) {
    const auto missing = std::count(seen.begin(), seen.end(), 0);
    if (missing > 0) {
      defect_ = std::to_string(missing) + " triangles are in no facet of the record";
    }
  }
  if (!record.facets.empty() && named != surface.facets().size()) {
    defect_ = "the record has " + std::to_string(named) + " of the " +
              std::to_string(surface.facets().size()) + " facets";
  }
}

// A facet's id is its smallest triangle.
Index FacetIndex::find(Index id) const {
  if (id >= surface_.triangles().size()) return kNone;
  const Index facet = surface_.facet_of_triangle()[id];
  return surface_.facets()[facet].id == id ? facet : kNone;
}

InputEdges::InputEdges(const InputSurface& surface) {
  std::vector<std::array<Index, 2>> ends;
  ends.reserve(surface.edges().size());
  for (const InputSurface::Edge& edge : surface.edges()) ends.push_back({edge.from, edge.to});
  ends_ = SimplexSet<2>(ends);
  edge_.assign(ends_.size(), kNone);
  for (Index e = 0; e < ends.size(); ++e) {
    Index& first = edge_[ends_.find(ends[e])];
    if (first == kNone) first = e;
  }
}

Index InputEdges::find(Index a, Index b) const {
  const std::size_t n = ends_.find({a, b});
  return n < ends_.size() ? edge_[n] : kNone;
}

Index InputEdges::of_chain(const ExactRecord& record, const std::vector<Index>& chain) const {
  if (chain.empty()) return kNone;
  for (const Index v : chain) {
    const ExactPoint& p = record.points[v];
    if (p.kind == ExactPoint::Kind::on_segment) return find(p.i, p.j);
  }
  return find(chain.front(), chain.back());
}

int along_edge(const ExactPoints& points, const InputSurface::Edge& edge, Index p, Index q) {
  if (p == q) return 0;
  if (p == edge.from && q == edge.to) return 1;
  return exact::dot_sign(points, edge.from, edge.to, p, q);
}

SimplexSet<2> edges_of_chains(const ExactRecord& record) {
  std::vector<std::array<Index, 2>> edges;
  for (const ExactRecord::Chain& chain : record.segments) {
    for (std::size_t i = 1; i < chain.vertices.size(); ++i) {
      edges.push_back({chain.vertices[i - 1], chain.vertices[i]});
    }
  }
  return SimplexSet<2>(edges);
}

SimplexSet<3> faces_on_facets(const ExactRecord& record) {
  std::vector<Face> faces;
  faces.reserve(record.refined_facets.size());
  for (const auto& [a, b, c, id] : record.refined_facets) faces.push_back({a, b, c});
  return SimplexSet<3>(faces);
}

}  // namespace tetproof::oracles
