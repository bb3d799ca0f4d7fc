// The refined mesh and the final one belong together (section 6).
#pragma once

#include "oracles/refinement.h"

namespace tetproof::oracles {

// Of the final mesh before repairs of rounding:
// - Every vertex is an input vertex, a vertex of the refined mesh, or exactly on the surface.
// - A vertex of the refined mesh is missing only on an artificial segment, or where it coincides
//   with an input vertex, or, if it was put into the volume, strictly inside the sphere of a
//   chamfered corner or the cylinder of an acute edge, or nearer to a facet that the filter dropped
//   than 0.3 times its distance to the nearest neighbour in the refined mesh. The first and the
//   last are deviations from the paper. A mesh of the solid alone may do without any of them if it
//   has no vertex but those of the input, at most 1000 triangles were given, and it keeps the angle
//   bound all the same.
OracleReport check_enrichment(const RefinedMesh& mesh);

// Of the final mesh after repairs of rounding: no vertex is new, and each changed tetrahedron is at
// most 8 edges away from one that is not positive on the nearest doubles. A record without a
// refined mesh can be asked as well.
OracleReport check_repairs(const delmesher::ExactRecord& record, const ExactPoints& points,
                           const Promise& promise);

// Of an improved mesh (--improve): in the region, neither the smallest face angle nor the flattest
// dihedral angle, the one whose sine is the smallest, is worse than in the constrained Delaunay
// mesh that it was made from, as far as they are below what is promised: the bound on face angles,
// and kImprovedDihedral degrees. Measured on the nearest doubles, where the improvement weighs its
// steps, by doubles with a relative slack of 1e-6. Not decided, only counted, if the mesh before
// has tetrahedra that are not positive there: repairs of rounding may then have changed it once
// more.
inline constexpr double kImprovedDihedral = 17;
OracleReport check_improvement(const delmesher::ExactRecord& record, const ExactPoints& points,
                               const Promise& promise);

// Of a plain constrained Delaunay tetrahedrization: every vertex is an input vertex or exactly on
// the surface. No other step gives it points, and none may widen the hull.
OracleReport check_origins(const delmesher::ExactRecord& record, const ExactPoints& points,
                           const InputSurface& surface, Index input_vertices);

}  // namespace tetproof::oracles
