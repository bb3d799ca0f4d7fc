#include "mesher/chamfer/facet_set.h"

#include <algorithm>

#include "mesher/base/sort_unique.h"

namespace delmesher::chamfer {

FacetSet::FacetSet(const KeptSurface& surface) : topology_(surface.topology()) {
  const std::size_t facet_count = topology_.facet_triangles.size();
  kept_.resize(facet_count);
  cost_.assign(facet_count, 0);
  for (FacetId f = 0; f < facet_count; ++f) {
    kept_[f] = surface.facet_is_kept(f);
    for (std::uint32_t t : topology_.facet_triangles[f]) {
      const auto& corner = topology_.triangles[t];
      cost_[f] += 0.5 * norm(cross(surface.edge_vector(corner[0], corner[1]),
                                   surface.edge_vector(corner[0], corner[2])));
    }
  }
  edge_facets_.assign(topology_.edge_count(), 0);
  vertex_edges_.assign(surface.vertex_count(), 0);
  for (std::uint32_t e = 0; e < topology_.edge_count(); ++e) {
    if (topology_.edge_is_flat[e]) continue;
    for (std::uint32_t h : topology_.edge_half_edges(e)) {
      edge_facets_[e] =
          static_cast<std::uint8_t>(edge_facets_[e] + kept_[topology_.facet_of_half_edge(h)]);
    }
    if (edge_facets_[e] == 0) continue;
    for (VertexId v : topology_.edge_vertices(e)) ++vertex_edges_[v];
  }
}

bool FacetSet::alive(const Element& element) const {
  switch (element.kind) {
    case Element::Kind::vertex:
      return vertex_edges_[element.id] > 0;
    case Element::Kind::edge:
      return edge_facets_[element.id] > 0;
    default:
      return kept_[element.id] != 0;
  }
}

std::vector<FacetId> FacetSet::facets(const Element& element) const {
  if (element.kind == Element::Kind::vertex) return facets_at(element.id);
  if (element.kind == Element::Kind::facet) return {element.id};
  std::vector<FacetId> result;
  for (std::uint32_t h : topology_.edge_half_edges(element.id)) {
    const FacetId f = topology_.facet_of_half_edge(h);
    if (kept_[f]) result.push_back(f);
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<FacetId> FacetSet::facets_at(VertexId v) const {
  std::vector<FacetId> result;
  topology_.for_each_outgoing(v, [&](std::uint32_t h) {
    const FacetId f = topology_.facet_of_half_edge(h);
    if (kept_[f] && (result.empty() || result.back() != f)) result.push_back(f);
    return true;
  });
  sort_unique(result);
  return result;
}

}  // namespace delmesher::chamfer
