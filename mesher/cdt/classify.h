// The regions that a surface divides space into.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesher/cdt/chains.h"

namespace delmesher::cdt {

// Per tetrahedron id its region, for a surface made of these faces of the mesh. Regions are
// numbered from kInside on, by their first tetrahedron. `found` has a guess for each face: where it
// was when it was recovered, or none. The mesh may have changed since. Returns an empty vector and
// stores the face's index in *missing if one is not a face of the mesh.
std::vector<RegionId> classify_tetrahedra(Tetrahedrization& mesh,
                                          std::span<const SurfaceFace> surface,
                                          std::span<const FaceHandle> found, const Chains& chains,
                                          Partition partition, Control& control,
                                          std::size_t* missing);

}  // namespace delmesher::cdt
