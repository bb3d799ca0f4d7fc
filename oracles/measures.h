// Oracles that measure: volume, inside flags.
#pragma once

#include "oracles/input_surface.h"
#include "oracles/tet_complex.h"

namespace tetproof::oracles {

// Volume oracle: the tetrahedra inside add up to exactly the volume of the polyhedron, or, for
// rounded vertices, to within `allowed` of it.
OracleReport check_volume(const TetComplex& complex, const Neighbours& neighbours,
                          const InputSurface& surface, double allowed);

// Six times the sum of the signed volumes of the tetrahedra with selected[t], or of all if it is
// empty; exactly, in integer units. A tetrahedron's is the sum over its faces of what lies between
// them and the origin, and faces that two of them share from opposite sides cancel: only the others
// take arithmetic. `neighbours` only says where to look, and is not believed.
ExactSum sum_of_volumes6(const TetComplex& complex, const Neighbours& neighbours,
                         const std::vector<std::uint8_t>& selected);

// Interior oracle: the centroid of every tetrahedron is inside by ray parity exactly if its flag
// says so. The surface and the complex must use the same points.
OracleReport check_interior(const TetComplex& complex, const InputSurface& surface);

// Ray parity of every centroid (points exactly on the surface count as outside).
std::vector<std::uint8_t> inside_by_parity(const TetComplex& complex, const InputSurface& surface);

// Rounded; 0 for a flat tetrahedron.
double smallest_altitude(const ExactPoints& points, const Tet& tet);

}  // namespace tetproof::oracles
