// Checks the promises of segment recovery and facet recovery on a whole tetrahedrization.
#pragma once

#include <cstdint>
#include <span>

#include "mesher/cdt/chains.h"

namespace delmesher::cdt {

// Throws InternalError unless the tetrahedrization is Delaunay, its structure and the chains are
// sound and every subsegment of the chains is an edge. A few predicates per tetrahedron, which are
// not counted.
void validate_segments(Tetrahedrization& mesh, const Chains& chains);

// Throws InternalError unless the structure is sound, every subsegment is an edge and every
// triangle of `surface` a face, every other face is locally Delaunay, and `region` (by
// tetrahedron) changes across no other face, and of two sides across each of them, being kOutside
// outside the hull.
void validate_facets(Tetrahedrization& mesh, const Chains& chains,
                     std::span<const SurfaceFace> surface, std::span<const RegionId> region,
                     Partition partition);

}  // namespace delmesher::cdt
