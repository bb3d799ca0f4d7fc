// The chamfered surface as the exact record describes it (section 4, appendix B).
#pragma once

#include "oracles/refinement.h"

namespace tetproof::oracles {

// The projection condition (section 4): between the straight segments and flat facets that the
// chamfering left, no angle is below the threshold in force there: of two segments at a vertex, of
// two facets at a segment, of a segment and a facet into which it projects. Angles that involve no
// rounded point obey it exactly; the others may fall short by what placing a point within 2^-20 of
// the chamfer distance explains, and the report says by how much they do.
OracleReport check_chamfer_angles(const RefinedMesh& mesh);

// Every point made by chamfering lies on the input, at a chamfered corner, within its radius: cut
// points on edges at the radius, bridge points farther by at most the factor that the widest
// sector (120 degrees) needs. New edges stay inside the facet that they were cut from, and the
// facet's faces cover no more than the facet.
OracleReport check_chamfer_extent(const RefinedMesh& mesh);

// Exactly those corners were chamfered that are acute at the threshold in force at them, on the
// surface that the filter kept, and those edges cut off that are acute. No radius is above a third
// of the local feature size (the distance, within the facets kept at the corner, to their edges
// that do not meet it), nor above --chamfer-radius.
OracleReport check_chamfer_need(const RefinedMesh& mesh);

// What a kept facet has lost is what was cut off at its chamfered corners and acute edges, and
// nothing else: the boundary of what is left follows the facet's own, side by side, but for detours
// over points made for the corner passed; the area inside that boundary is that of the faces.
OracleReport check_chamfer_cuts(const RefinedMesh& mesh);

}  // namespace tetproof::oracles
