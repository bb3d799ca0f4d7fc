// Which vertices and edges are acute (section 4), decided exactly and by facets.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mesher/chamfer/chamfer.h"
#include "mesher/chamfer/kept_surface.h"

namespace delmesher::chamfer {

// The threshold in force at every vertex, as a squared cosine: the smaller, the stricter. An edge
// obeys the stricter of its ends.
class Thresholds {
 public:
  explicit Thresholds(const ChamferOptions& options) : options_(options) {}
  double at_vertex(VertexId v) const {
    return options_.vertex_cosine_squared.empty() ? options_.cosine_squared
                                                  : options_.vertex_cosine_squared[v];
  }
  // For two edges, of one facet or not.
  double at_corner(VertexId v) const {
    const bool tightened = !options_.vertex_cosine_squared.empty() && at_vertex(v) == 0;
    return tightened ? 0 : std::max(at_vertex(v), options_.corner_cosine_squared);
  }
  double at_edge(const SurfaceTopology& topology, std::uint32_t e) const {
    const auto [v, w] = topology.edge_vertices(e);
    return at_vertex(v) < at_vertex(w) ? at_vertex(v) : at_vertex(w);
  }

 private:
  const ChamferOptions& options_;
};

struct Acuteness {
  std::vector<std::uint8_t> vertex, edge;  // 1: acute; per input vertex, per undirected input edge
  // Per input vertex: acute by at_vertex(), but not by at_corner() and therefore not in `vertex`.
  std::vector<std::uint8_t> apex;
};

// Asks only vertices v with active[v] != 0 and edges between such, or all if `active` is empty.
Acuteness find_acute(const KeptSurface& surface, Predicates& predicates,
                     const Thresholds& thresholds, const std::vector<std::uint8_t>& active,
                     Control& control);

// Does the ray from a towards q project into the wedge of triangle abc at a? The sides ab and ac
// belong to the wedge if so asked.
bool projects_into_wedge(Predicates& predicates, VertexId q, VertexId a, VertexId b, VertexId c,
                         bool with_ab = false, bool with_ac = false);

}  // namespace delmesher::chamfer
