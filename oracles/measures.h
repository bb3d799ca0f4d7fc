// Oracles that measure: volume, inside flags, angles.
#pragma once

#include "oracles/input_surface.h"
#include "oracles/tet_complex.h"

namespace tetproof::oracles {

// Volume oracle: the tetrahedra inside add up to exactly the volume of the polyhedron, or, for
// rounded vertices, to within `allowed` of it.
OracleReport check_volume(const TetComplex& complex, const InputSurface& surface, double allowed);

// Interior oracle: the centroid of every tetrahedron is inside by ray parity exactly if its flag
// says so. The surface and the complex must use the same points.
OracleReport check_interior(const TetComplex& complex, const InputSurface& surface);

// Ray parity of every centroid (points exactly on the surface count as outside).
std::vector<std::uint8_t> inside_by_parity(const TetComplex& complex, const InputSurface& surface);

// Rounded; 0 for a flat tetrahedron.
double smallest_altitude(const ExactPoints& points, const Tet& tet);

// Which tetrahedra promise the angle bound.
enum class AngleScope : std::uint8_t {
  solid,  // those whose interior meets the solid (region interior)
  all
};

// Angle oracle: every face angle of those tetrahedra is at least `delta` degrees, certified by
// comparing squared cosines in integers; the bound itself is taken 1e-9 (relative, on the squared
// cosine) to the safe side of libm.
OracleReport check_angles(const TetComplex& complex, const InputSurface& surface, double delta,
                          AngleScope scope);

}  // namespace tetproof::oracles
