// Surface validity: what CGAL and OpenMesh say of the input that a mesher has accepted.
#pragma once

#include "oracles/input_surface.h"
#include "oracles/report.h"

namespace tetproof::oracles {

// The input is closed, manifold, consistently oriented and does not intersect itself. Both
// libraries are asked (OpenMesh about the first three); one that objects is a failure, because the
// mesher's own check has let the surface pass. Where some face is not simple in any projection
// nothing is said about intersections.
OracleReport check_surface_validity(const Polyhedron& surface);

}  // namespace tetproof::oracles
