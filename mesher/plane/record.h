// The exact record of a run in the plane, and the graphs shown to the caller.
#pragma once

#include <vector>

#include "mesher/delmesher/planar_graph.h"
#include "mesher/plane/chamfer.h"
#include "mesher/plane/graph.h"
#include "mesher/plane/refine.h"

namespace delmesher::plane {

void record_points(const InputGraph& graph, const PointStore& points, PlaneRecord& record);
void record_triangles(const InputGraph& graph, const Triangulation& mesh,
                      const std::vector<Side>& side, std::vector<PlaneRecord::Triangle>& triangles,
                      std::vector<PlaneRecord::Edge>& edges);

// The chamfered graph with rounded coordinates.
PlanarGraph chamfered_graph(const InputGraph& graph, const Chamfered& chamfered,
                            const PointStore& points);

}  // namespace delmesher::plane
