// The exact end (section 3): the unchamfered input, enriched with the vertices of the refined mesh.
#pragma once

#include "mesher/base/control.h"
#include "mesher/plane/chamfer.h"
#include "mesher/plane/graph.h"
#include "mesher/plane/refine.h"

namespace delmesher::plane {

// Enters the chamfered vertices and the missing parts of the segments into the refined mesh, which
// becomes the constrained Delaunay triangulation of the input segments and its vertices. It does
// not change elsewhere.
//
// The refinement knows nothing of missing parts and puts points beside them, as near as it happens.
// So unless `keep_points`, vertices in faces go that encroach on a part cut off at a corner: that
// are in its open diametral disc. `carrier`: per vertex the piece that it is on, or kNone.
void enrich(const InputGraph& graph, const Chamfered& chamfered,
            const std::vector<PieceId>& carrier, bool keep_points, Triangulation& mesh,
            const PointStore& points, PlanePredicates& predicates, Control& control);

}  // namespace delmesher::plane
