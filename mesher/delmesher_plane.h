// delmesher in the plane: graded triangulations of planar straight-line graphs (section 3).
#pragma once

#include <string>
#include <vector>

#include "delmesher.h"
#include "delmesher/planar_graph.h"

namespace delmesher {

struct PlaneResult {
  Status status;
  std::vector<std::string> warnings;
  PlaneMesh mesh;         // empty unless status.ok()
  PlanarGraph chamfered;  // if Options::want_chamfered: rounded, for display
  PlaneRecord exact;      // if Options::want_exact
  PlaneStatistics statistics;
};

// Options with the defaults of the plane: delta is 20.7, which is guaranteed. In the plane, tau is
// the narrowest channel between two segments, as a fraction of its length, that is refined;
// slivers, simplify_bridges and as_paper but for steiner_point mean nothing; max_vertices 0 is 1e7
// and 64 more per input vertex.
Options plane_options();

// The paper's algorithm in the plane (section 3): chamfers up to 90 degrees, no filter, everything
// down to the outer box, circumcentres.
Options paper_plane_options();

inline constexpr OptionBounds kPlaneBounds{.delta = {.low = 0, .high = 34, .above_low = true},
                                           .tau = {.low = 0, .high = 1},
                                           .acute = {.low = 60, .high = 90},
                                           .corner = {.low = 0, .high = 90}};

// Meshes the inside of a planar straight-line graph (section 3). An invalid graph is
// StatusCode::invalid_surface with a message that names the offending vertices or segments.
PlaneResult triangulate_polygon(const PlanarGraph& graph, const Options& options = plane_options());

}  // namespace delmesher
