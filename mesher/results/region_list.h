// The regions of a complex: what they are called, what is between them, and which are written.
#pragma once

#include <vector>

#include "mesher/delmesher.h"
#include "mesher/predicates/points.h"
#include "mesher/surface/complex.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::results {

struct RegionList {
  ComplexReport report;
  std::size_t bare = 0;  // triangles with the outside on both sides
};

// Numbers the regions of the mesh by their volume, the largest first, from 1 on, and lists them.
// Those whose exact volumes are the same number of 24 bits (single precision) come in the order of
// their first triangles: equal bodies differ by roundings. `merged`: the surface of the mesh, with
// a facet for each triangle.
RegionList list_regions(const surface::MergedSurface& merged, const PointStore& points,
                        ConformingMesh& mesh);

// Makes regions that are not to be written outside, as holes are. An error if a name is that of no
// region.
Status choose_regions(const Options& options, const std::vector<MeshRegion>& regions,
                      ConformingMesh& mesh);

// The longest edge in each region, by its number, of options and region points; empty if none is
// bounded on its own. 0: any.
Status find_region_sizes(const Options& options, const std::vector<MeshRegion>& regions,
                         std::vector<double>& sizes);

// Counts the tetrahedra of each region of result.mesh, and splits walls; the facets of its boundary
// become those of the triangles given, of which there are so many.
void finish_regions(const Options& options, const surface::MergedSurface& merged,
                    std::size_t triangles, Result& result);

}  // namespace delmesher::results
