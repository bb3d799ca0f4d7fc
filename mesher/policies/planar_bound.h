// Policy: how far facets may be from planar (Options::planar).
#pragma once

#include "mesher/delmesher.h"

namespace delmesher::policies {

// The largest distance of a vertex from the plane of its facet, in input units: half of the
// deviation allowed, because a triangle may be as far on the other side of the plane. `diagonal`:
// of the bounding box. For `auto` it is twice the flatness, because planes are moved once more for
// vertices of more than three.
double planar_bound(const Surface& surface, const Options& options, double diagonal);

}  // namespace delmesher::policies
