// Policy: how far facets may be from planar (Options::planar).
#pragma once

#include "mesher/base/control.h"
#include "mesher/delmesher.h"

namespace delmesher::policies {

// The largest distance that a vertex may have from the plane of its facet, in input units. It is
// half of the deviation allowed, because a triangle may be as far on the other side of the plane.
// For `auto` it is twice the flatness, because planes may be moved by as much again for vertices on
// more than three planes. `diagonal`: of the bounding box.
double planar_bound(const Surface& surface, const Options& options, double diagonal,
                    Control& control);

}  // namespace delmesher::policies
