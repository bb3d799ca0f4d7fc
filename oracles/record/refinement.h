// The refined mesh as the exact record describes it (sections 5.2 to 5.6): chains of segments,
// faces on facets, encroachment, and the places of volume Steiner points.
#pragma once

#include "oracles/mesh/tet_complex.h"
#include "oracles/record/refined_index.h"
#include "oracles/surface/input_surface.h"
#include "oracles/verdict/promise.h"

namespace tetproof::oracles {

// The arguments of the oracles of the refined mesh. `complex` holds record->refined.
struct RefinedMesh {
  const delmesher::ExactRecord* record = nullptr;
  const ExactPoints* points = nullptr;
  const InputSurface* surface = nullptr;
  const TetComplex* complex = nullptr;
  const Neighbours* neighbours = nullptr;
  const Promise* promise = nullptr;
  Index input_vertices = 0;
};

// Chains on input edges: straight, on their edge, made of mesh edges and disjoint. Nothing of an
// edge is missing but at chamfered corners, and the whole of acute edges. Artificial chains:
// simple, exactly in the plane of a kept facet, within 2^-20 of their length of the straight line.
OracleReport check_segments(const RefinedMesh& mesh);  // segments.cpp

// The faces on a facet are faces of the mesh, exactly in its plane, not folded, and bounded by
// exactly the chains of that facet.
OracleReport check_refined_facets(const RefinedMesh& mesh);  // refined_facets.cpp

// No vertex lies strictly inside the diametral ball of an edge of a chain or of a face on a facet.
// In a Delaunay mesh, an element whose ball holds any vertex has one in the ball that shares a
// tetrahedron with it. A sample is tried against all vertices none the less. Violations are
// counted, not failed, where the record does not promise empty balls.
OracleReport check_encroachment(const RefinedMesh& mesh);  // encroachment.cpp

// Every volume Steiner point has exactly one circumball for which it was made (section 5.6), and
// lies strictly inside it. If circumcentres are promised, the point is at the ball's centre, or at
// the centroid of its tetrahedron, which is counted: the centre of a flat one cannot be computed.
OracleReport check_balls(const RefinedMesh& mesh);  // steiner_balls.cpp

}  // namespace tetproof::oracles
