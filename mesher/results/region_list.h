// The regions of a written mesh.
#pragma once

#include "mesher/delmesher.h"
#include "mesher/surface/complex.h"

namespace delmesher::results {

// Numbers the regions of result.mesh by their volume, the largest first, from 1 on, and lists them
// in result.regions. `merged`: the surface that was meshed; its facets become those of the
// triangles given.
void list_regions(const surface::MergedSurface& merged, Result& result);

}  // namespace delmesher::results
