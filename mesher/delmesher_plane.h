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

}  // namespace delmesher
