// The refined mesh and the final one belong together (section 6).
#pragma once

#include "oracles/refinement.h"

namespace tetproof::oracles {

// Of the final mesh before repairs of rounding:
// - every vertex is an input vertex, a vertex of the refined mesh, or exactly on the surface;
// - every vertex of the refined mesh that is missing lies strictly inside the sphere of a chamfered
//   corner or the cylinder of an acute edge, or on an artificial segment, or coincides with an
//   input vertex, or is nearer to a facet that the filter dropped than 0.3 times its distance to
//   the nearest neighbour in the refined mesh (the last and those on artificial segments are
//   deviations from the paper). A mesh of the solid alone may do without any of them if it has no
//   vertex but those of the input, at most 1000 triangles of which were given, and keeps the bound
//   all the same.
// Of the final mesh after repairs: no vertex is new, and what has changed is near tetrahedra that
// are not positive on the nearest doubles.
OracleReport check_enrichment(const RefinedMesh& mesh);

// The last, which a record without a refined mesh can be asked as well.
OracleReport check_repairs(const delmesher::ExactRecord& record, const ExactPoints& points,
                           const Promise& promise);

// Of a plain constrained Delaunay tetrahedrization: every vertex is an input vertex or exactly on
// the surface. Nothing else gives it points, and none may widen the hull.
OracleReport check_origins(const delmesher::ExactRecord& record, const ExactPoints& points,
                           const InputSurface& surface, Index input_vertices);

}  // namespace tetproof::oracles
