// Walls between regions, and sheets, whose two sides are to part: cracks, contact.
#pragma once

#include "mesher/delmesher.h"
#include "mesher/surface/complex.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::results {

// Is there a wall or a sheet of each name in Options::split_wall_names? `mesh`: without what is not
// written.
Status check_wall_names(const Options& options, const surface::MergedSurface& merged,
                        const std::vector<MeshRegion>& regions, const ConformingMesh& mesh);

// Gives the two sides of chosen walls vertices of their own, where they then hang together nowhere
// else: not on the border of a sheet. result.mesh.boundary_facets are triangles of `merged`. The
// triangles of a wall are listed once for each side, seen from outside of that: the second ones as
// those of further facets. Labels of both are new, with names in result.wall_names.
void split_walls(const Options& options, const surface::MergedSurface& merged, Result& result);

}  // namespace delmesher::results
