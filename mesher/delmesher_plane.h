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
  PlanarGraph chamfered;  // if PlaneOptions::want_chamfered: rounded, for display
  PlaneRecord exact;      // if PlaneOptions::want_exact
  PlaneStatistics statistics;
};

// The paper's algorithm in the plane (section 3): chamfers up to 90 degrees, no filter, everything
// down to the outer box, circumcentres.
PlaneOptions paper_plane_options();

// Meshes the inside of a planar straight-line graph (section 3). An invalid graph is
// StatusCode::invalid_surface with a message that names the offending vertices or segments.
PlaneResult triangulate_polygon(const PlanarGraph& graph, const PlaneOptions& options = {});

// Can the inside of a graph be meshed? If not, what is wrong, and where? Decided exactly.
GraphReport check_graph(const PlanarGraph& graph, const TimeLimit& limits = {});

// "equal vertices", "crossing", ...
const char* defect_name(GraphDefect defect);

// Merges vertices at the same place or no farther apart than `weld`, drops segments without length
// and those that repeat others, cuts overlapping segments at each other's ends and crossing ones at
// their crossings. A crossing is rounded; nothing else moves, unless it is merged.
GraphRepairResult repair_graph(const PlanarGraph& graph, double weld = 0,
                               const TimeLimit& limits = {});

}  // namespace delmesher
