// Which facets, edges and vertices of the surface are left while facets are being dropped.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/chamfer/kept_surface.h"

namespace delmesher::chamfer {

// A vertex, constrained edge or facet.
struct Element {
  enum class Kind : std::uint8_t { vertex, edge, facet };
  Kind kind = Kind::vertex;
  std::uint32_t id = kNone;
};

class FacetSet {
 public:
  explicit FacetSet(const KeptSurface& surface);

  const std::vector<std::uint8_t>& kept() const { return kept_; }
  // Is a facet kept that contains the element? A vertex without constrained edges is never alive.
  bool alive(const Element& element) const;
  // The kept facets that contain the element, ascending. Dropping them removes the element.
  std::vector<FacetId> facets(const Element& element) const;
  // All kept facets at a vertex, ascending.
  std::vector<FacetId> facets_at(VertexId v) const;
  // Drops a kept facet; died(edge) is called for every edge that loses its last facet.
  template <class Died>
  void drop(FacetId f, Died died) {
    kept_[f] = 0;
    for (std::uint32_t t : topology_.facet_triangles[f]) {
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t e = topology_.edge_of[h];
        if (topology_.edge_is_flat[e] || --edge_facets_[e] > 0) continue;
        for (VertexId v : topology_.edge_vertices(e)) --vertex_edges_[v];
        died(e);
      }
    }
  }

  // What dropping a facet costs: its area, in the scaled coordinates of the surface.
  double cost(FacetId f) const { return cost_[f]; }
  double cost(const std::vector<FacetId>& facets) const {
    double sum = 0;
    for (FacetId f : facets) sum += cost_[f];
    return sum;
  }

 private:
  const SurfaceTopology& topology_;
  std::vector<std::uint8_t> kept_;
  std::vector<std::uint8_t> edge_facets_;    // kept facets per edge; 0 for flat edges
  std::vector<std::uint32_t> vertex_edges_;  // alive edges per vertex
  std::vector<double> cost_;
};

}  // namespace delmesher::chamfer
