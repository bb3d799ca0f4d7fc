// Oracles of volumes and of the flags of tetrahedra inside.
#pragma once

#include "oracles/mesh/tet_complex.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {

// Volume oracle: the tetrahedra inside add up to exactly the volume of the polyhedron, or, for
// rounded vertices, to within `allowed` (a length times surface_area) of it.
OracleReport check_volume(const TetComplex& complex, const Neighbours& neighbours,
                          const InputSurface& surface, double allowed);

// Six times the sum of the signed volumes of the tetrahedra with selected[t], or of all if it is
// empty; exactly, in cubic integer units. The volume of a tetrahedron is the sum over its faces of
// the volumes between face and origin. Faces that two tetrahedra share from opposite sides cancel,
// so that only the others take arithmetic. `neighbours` only says where to look, and is not
// believed.
ExactSum sum_of_volumes6(const TetComplex& complex, const Neighbours& neighbours,
                         const std::vector<std::uint8_t>& selected);

// Interior oracle: the flag of a tetrahedron says inside exactly if its centroid is inside by the
// parity of a ray. The surface and the complex must use the same points. Tetrahedra with a common
// face that is not a wall (see walls_of) share a ray: where the conformity oracle passes, the walls
// are the surface.
OracleReport check_interior(const TetComplex& complex, const Neighbours& neighbours,
                            const InputSurface& surface, const std::vector<std::uint8_t>& walls);

// Per tetrahedron: is its centroid inside by the parity of a ray? Points exactly on the surface
// count as outside.
std::vector<std::uint8_t> inside_by_parity(const TetComplex& complex, const InputSurface& surface);

// In input units, rounded; 0 for a flat tetrahedron.
double smallest_altitude(const ExactPoints& points, const Tet& tet);

}  // namespace tetproof::oracles
