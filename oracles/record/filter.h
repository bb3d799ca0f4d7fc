// The facets that the input filter kept and dropped (section 7).
#pragma once

#include "oracles/record/refinement.h"

namespace tetproof::oracles {

// No two vertices, edges or facets that the filter kept, and that do not touch, are closer than the
// tolerance; distances are rational.
//
// No facet was dropped without need, as far as that can be said of a greedy filter. There is an
// order in which every drop was forced. Read backwards, dropped facets can be put back one after
// the other, and a facet that never comes back was dropped for nothing:
// - Second step, put back first: facets of which chamfering of the surface as it then is makes a
//   feature that is too small, by the oracle's own construction of the chamfers. A feature is one
//   of the facets whose corners, edges or insides it separates.
// - First step: elements (vertex, edge or facet, none of whose facets is there), each closer than
//   the tolerance to a present one that it does not touch.
//
// Facets that could be put back alone after all are counted. The order of the drops matters, so a
// facet dropped early may have become harmless.
OracleReport check_filter(const RefinedMesh& mesh);

}  // namespace tetproof::oracles
