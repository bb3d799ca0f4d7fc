// Holes of a polygon joined to its outer loop.
#pragma once

#include "mesher/base/polling.h"
#include "mesher/geometry/projected_face.h"

namespace delmesher::geometry {

// The outer loop with every hole joined to it by a link, an edge that the result passes once in
// either direction. If the loops are disjoint and the holes inside, the result is weakly simple and
// counter-clockwise: links meet neither each other nor a loop but at their ends. `all` is set to
// false if a hole could not be joined; it is left out then.
Loop join_holes(const ProjectedFace& face, Polling& polling, bool& all);

}  // namespace delmesher::geometry
