// Orthogonal chamfering of acute vertices and edges (sections 4.2 and 4.4), decided by facets.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/plc.h"
#include "mesher/surface/topology.h"

namespace delmesher::chamfer {

struct ChamferOptions {
  double cosine_squared = 0.25;  // corners with a smaller angle are acute (0.25: 60 degrees)
  // The same for the angle of two edges; 0: as above. Segments that are split at equal distances
  // from their common end do not encroach each other, however acute their angle.
  double corner_cosine_squared = 0;
  double max_radius = 0;  // nothing farther from its vertex or edge is cut off; 0: no bound
  bool simplify_bridges = true;
  // The paper's way, where the default differs. link_distances: reach a third of the way to the
  // link (section 4.1). bridge_per_triangle: one in each triangle (4.2); needs link_distances.
  bool link_distances = false;
  bool bridge_per_triangle = false;
  // Per facet: 1 if kept, 0 if dropped by the filter; empty: all kept. Edges between two dropped
  // facets disappear; an edge of one kept facet stays as its boundary.
  std::vector<std::uint8_t> facet_kept;
  // Flat vertices (inside a kept facet) closer than this to the facet's boundary or to another one
  // are left out of the Plc, like those near a chamfer. They come back in the enriched CDT.
  double isolated_clearance = 0;
};

struct ChamferResult {
  Plc plc;  // without the outer box; facet f of the input is plc.facets[plc_facet[f]]
  std::vector<std::uint32_t> plc_facet;       // input facet -> index in plc.facets, or kNone
  std::vector<std::uint8_t> vertex_is_acute;  // per input vertex
  std::vector<std::uint8_t> edge_is_acute;    // per undirected input edge
  // Per input vertex: 1 for an apex, where two edges meet below the threshold, but not below that
  // of two edges; so it is not chamfered.
  std::vector<std::uint8_t> vertex_is_apex;
  std::vector<double> vertex_distance;  // chamfer distance along the edges; 0: not chamfered
  // Balls around vertices and cylinders around edges that together contain everything cut off.
  std::vector<double> vertex_radius;  // somewhat above vertex_distance; 0: not chamfered
  std::vector<double> edge_radius;    // largest strip width beside the edge; 0: none
  // The new points are first_new_point ... in the store; for each, the input vertex it was made
  // for.
  VertexId first_new_point = 0;
  std::vector<VertexId> new_point_vertex;
  std::uint64_t acute_vertices = 0, acute_edges = 0;
};

// Appends the new points (on-segment and on-triangle, with supports) to the store. The result
// satisfies the projection condition for the threshold in force, up to the rounding of on-triangle
// points, if features are far larger than an ulp of the surface's size. Throws Stopped, with
// Limit::precision, if doubles cannot place a point.
ChamferResult chamfer(const SurfaceTopology& topology, PointStore& points, Predicates& predicates,
                      const ChamferOptions& options, Control& control);

// Counts the corners and edges of the surface that would be chamfered.
struct AcuteCount {
  std::uint64_t vertices = 0, edges = 0;
};
AcuteCount count_acute(const SurfaceTopology& topology, const PointStore& points,
                       Predicates& predicates, const ChamferOptions& options, Control& control);

}  // namespace delmesher::chamfer
