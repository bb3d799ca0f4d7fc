// The Delaunay property: for every face of the refined mesh, for every face of a constrained
// Delaunay tetrahedrization that is not on the input, and for a sample of tetrahedra by brute
// force.
#pragma once

#include "oracles/mesh/tet_complex.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {

// No face between two tetrahedra has the opposite corner strictly inside a circumsphere. Hence no
// vertex is inside any, as all tetrahedra are positively oriented and fill their hull (hull.h). A
// sample of tetrahedra is tried against all vertices. CGAL decides every face as well, and has to
// agree.
OracleReport check_delaunay(const TetComplex& complex, const Neighbours& neighbours);

struct ConstrainedDelaunayOptions {
  // After repairs of rounding the property cannot hold everywhere: then violations are only
  // counted.
  bool gate = true;
  // Per tetrahedron: is it known that no opposite corner is inside the circumsphere across a face
  // between two of these? Then such faces are not decided again.
  std::vector<std::uint8_t> known = {};
};

// The same for faces that are not among `constraints`. Then no tetrahedron sees a vertex inside its
// circumsphere past the constraints (Shewchuk 2008). This is tried on the sample, looking from the
// centroid, with the input surface as walls.
OracleReport check_constrained_delaunay(const TetComplex& complex, const Neighbours& neighbours,
                                        const InputSurface& surface,
                                        const std::vector<Face>& constraints,
                                        const ConstrainedDelaunayOptions& options = {});

// Which of these tetrahedra are in a complex on the same points. `compared`, if given, becomes the
// number of pairs that were compared.
std::vector<std::uint8_t> in_both(const std::vector<delmesher::ExactRecord::Tet>& tetrahedra,
                                  const TetComplex& other, std::uint64_t* compared = nullptr);

}  // namespace tetproof::oracles
