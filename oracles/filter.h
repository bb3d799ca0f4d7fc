// What the input filter kept and dropped (section 7).
#pragma once

#include "oracles/refinement.h"

namespace tetproof::oracles {

// No two vertices, edges or facets that the filter kept, and that do not touch, are closer than the
// tolerance; distances are rational. A facet that was dropped has an element closer than that in
// the input; or else (the filter's second step) chamfering made something smaller of it, which the
// report counts. It counts as well what could be put back after all, because the filter is greedy.
OracleReport check_filter(const RefinedMesh& mesh);

// Squared distances, exact, in integer units.
mpq_class squared_distance_to_segment(const ExactPoints& points, Index v, Index a, Index b);
// Of the insides of two segments: at most that of their lines where that is reached inside both;
// negative if it is not (then an end is involved).
mpq_class squared_distance_inside(const ExactPoints& points, Index a, Index b, Index c, Index d);
// Of a vertex to the closed triangle where its foot lies on it; negative if it does not.
mpq_class squared_distance_to_face(const ExactPoints& points, Index v,
                                   const std::array<Index, 3>& triangle);

}  // namespace tetproof::oracles
