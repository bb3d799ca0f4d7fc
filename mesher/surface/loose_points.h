// Vertices of no triangle: electrodes and sensors, or what is left of something.
#pragma once

#include <vector>

#include "mesher/predicates/predicates.h"
#include "mesher/surface/topology.h"

namespace delmesher::surface {

// Those that may become vertices of a mesh beside the surface, each place once: in the box of the
// triangles and on none of them.
std::vector<VertexId> loose_points(const SurfaceTopology& topology, const PointStore& points,
                                   Predicates& predicates);

// Adds those of one surface to another.
void add_loose_points(const Surface& from, Surface& to);

}  // namespace delmesher::surface
