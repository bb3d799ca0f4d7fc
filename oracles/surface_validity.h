// Surface validity: what CGAL and OpenMesh say of the input that a mesher has accepted.
#pragma once

#include "oracles/input_surface.h"
#include "oracles/report.h"

namespace tetproof::oracles {

// The input is closed, manifold, consistently oriented and does not intersect itself. Both
// libraries are asked (OpenMesh about the first three); one that objects is a failure, because the
// mesher's own check has let the surface pass. Of polygons with more than three corners nothing is
// said about intersections: how the mesher has triangulated them is not known.
OracleReport check_surface_validity(const Polyhedron& surface);

}  // namespace tetproof::oracles
