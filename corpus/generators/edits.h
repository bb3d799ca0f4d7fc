// Local changes of valid surfaces on a half-edge structure (OpenMesh), each certified: the surface
// is valid before and after.
#pragma once

#include "corpus/generators/random.h"
#include "mesher/delmesher.h"

namespace tetproof {

// A random edge flip, edge split, collapse, stellar subdivision, vertex nudge (along the normal, an
// edge, or by single doubles), extrusion of a triangle, pull towards a facet, or cut by a
// plane. `bits` bounds the exponent of small distances. Returns whether the surface has changed.
bool edit(delmesher::Surface& surface, Random& random, int bits);

// Both surfaces in one, the second scaled and moved beside, inside or around the first one. Returns
// whether that was possible.
bool combine(delmesher::Surface& surface, const delmesher::Surface& other, Random& random);

// The part where p[axis] < value, closed by caps. Not certified.
delmesher::Surface cut(const delmesher::Surface& surface, int axis, double value);

}  // namespace tetproof
