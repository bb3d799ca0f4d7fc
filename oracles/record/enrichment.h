// The refined mesh and the final one belong together (section 6).
#pragma once

#include <cstdint>
#include <vector>

#include "oracles/record/refinement.h"

namespace tetproof::oracles {

// Checks the final mesh before repairs of rounding:
// - Every vertex is an input vertex, a vertex of the refined mesh, or exactly on the surface.
// - A vertex of the refined mesh is missing only on an artificial segment, or where it coincides
//   with an input vertex, or, if it was put into the volume, strictly inside the sphere of a
//   chamfered corner or the cylinder of an acute edge, or nearer to a facet that the filter dropped
//   than 0.3 times its distance to the nearest neighbour in the refined mesh. The first and the
//   last are deviations from the paper. A mesh of the solid alone may do without any of them if it
//   has no vertex but those of the input, at most 1000 triangles were given, and it keeps the angle
//   bound all the same.
OracleReport check_enrichment(const RefinedMesh& mesh);

// Per point: is it a corner of some of these tetrahedra?
std::vector<std::uint8_t> used_in(const std::vector<delmesher::ExactRecord::Tet>& tets,
                                  std::size_t points);
std::vector<std::uint8_t> used_in(const TetComplex& complex);

// Checks a plain constrained Delaunay tetrahedrization: every vertex is an input vertex or exactly
// on the surface. No other step gives it points, and none may widen the hull.
OracleReport check_origins(const delmesher::ExactRecord& record, const ExactPoints& points,
                           const InputSurface& surface, Index input_vertices);

}  // namespace tetproof::oracles
