// Delaunay: of the refined mesh every face, of a constrained Delaunay tetrahedrization every face
// that is not on the input; and a sample by brute force.
#pragma once

#include "oracles/input_surface.h"
#include "oracles/tet_complex.h"

namespace tetproof::oracles {

// No face between two tetrahedra has the opposite corner strictly inside a circumsphere, hence (as
// all are positively oriented and fill their hull, see hull.h) no vertex is inside any; a sample of
// tetrahedra is tried against all vertices. CGAL decides every face as well, and has to agree.
OracleReport check_delaunay(const TetComplex& complex, const Neighbours& neighbours);

struct ConstrainedDelaunayOptions {
  // After repairs of rounding the property cannot hold everywhere: then it is only counted.
  bool gate = true;
};

// The same for faces that are not among `constraints`; then no vertex inside a circumsphere is seen
// from the tetrahedron past the constraints (Shewchuk 2008), which is tried on the sample from the
// centroid against the input surface.
OracleReport check_constrained_delaunay(const TetComplex& complex, const Neighbours& neighbours,
                                        const InputSurface& surface, std::vector<Face> constraints,
                                        const ConstrainedDelaunayOptions& options = {});

}  // namespace tetproof::oracles
