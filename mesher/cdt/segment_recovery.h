// Segment recovery: splits constrained edges until all their parts are edges of the perturbed
// Delaunay tetrahedrization (Si and Gaertner 2005; Diazzi et al. 2023, section 4).
#pragma once

#include <vector>

#include "mesher/cdt/chains.h"

namespace delmesher::cdt {

// Inserts the points that make every subsegment an edge of `mesh`, which must be the Delaunay
// tetrahedrization of the input's vertices. Returns the new points, in the order of insertion.
std::vector<VertexId> recover_segments(Tetrahedrization& mesh, Chains& chains, PointStore& points,
                                       Control& control);

// Splits the subsegment in its middle without looking at any mesh; the new point is in no
// tetrahedrization yet.
VertexId split_in_the_middle(Chains& chains, std::uint32_t node, PointStore& points,
                             Predicates& predicates);

}  // namespace delmesher::cdt
