// The exact end (section 3): the unchamfered input, enriched with the vertices of the refined mesh.
#pragma once

#include "mesher/base/control.h"
#include "mesher/plane/chamfer.h"
#include "mesher/plane/graph.h"
#include "mesher/plane/refine.h"

namespace delmesher::plane {

// Enters the chamfered vertices and the missing parts of the segments into the refined mesh, which
// becomes the constrained Delaunay triangulation of the input segments and all its vertices. It
// does not change elsewhere.
void enrich(const InputGraph& graph, const Chamfered& chamfered, Triangulation& mesh,
            const PointStore& points, Control& control);

}  // namespace delmesher::plane
