// Surface validity: do CGAL and OpenMesh agree with the mesher, which has accepted the input?
#pragma once

#include "oracles/surface/input_surface.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// The input is closed, manifold, consistently oriented and does not intersect itself. Both
// libraries decide as well (OpenMesh the first three). If one objects the oracle fails, because
// the mesher's own check has let the surface pass. If a face is not simple in any projection,
// intersections are not looked for.
OracleReport check_surface_validity(const Polyhedron& surface);

// The triangles of a complex have area, and two of them meet in common vertices or an edge alone,
// or are the same. CGAL decides.
OracleReport check_complex_validity(const Polyhedron& complex);

}  // namespace tetproof::oracles
