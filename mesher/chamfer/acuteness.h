// Which vertices and edges are acute (section 4), decided exactly and by facets.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mesher/chamfer/chamfer.h"
#include "mesher/chamfer/kept_surface.h"

namespace delmesher::chamfer {

// The thresholds in force, as squared cosines: the smaller, the stricter.
struct Thresholds {
  explicit Thresholds(const ChamferOptions& options)
      : with_facets(options.cosine_squared),
        of_edges(std::max(with_facets, options.corner_cosine_squared)) {}

  double with_facets;  // of an edge and a facet, of two facets
  double of_edges;     // of two edges, of one facet or not
};

struct Acuteness {
  std::vector<std::uint8_t> vertex, edge;  // 1: acute; per input vertex, per undirected input edge
  // Per input vertex: below `with_facets`, but not below `of_edges` and therefore not in `vertex`.
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
