// Inside or outside, by parity across the surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesher/cdt/chains.h"

namespace delmesher::cdt {

// Per tetrahedron id: 1 if it is inside the surface made of these faces of the mesh, 0 outside.
// `found` has a guess for each face: where it was when it was recovered, or none. The mesh may have
// changed since.
// Returns an empty vector and stores the face's index in *missing if one is not a face of the mesh.
std::vector<std::uint8_t> classify_tetrahedra(Tetrahedrization& mesh,
                                              std::span<const SurfaceFace> surface,
                                              std::span<const FaceHandle> found,
                                              const Chains& chains, Control& control,
                                              std::size_t* missing);

}  // namespace delmesher::cdt
