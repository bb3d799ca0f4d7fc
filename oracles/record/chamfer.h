// The chamfered surface as the exact record describes it (section 4, appendix B).
#pragma once

#include "oracles/record/refinement.h"

namespace tetproof::oracles {

// The projection condition (section 4): between the straight segments and flat facets that the
// chamfering left, no angle is below the threshold in force there. This holds for two segments at a
// vertex, two facets at a segment, and a segment and a facet into which it projects. Angles of two
// facets and of two parts of input edges obey it exactly. The others may fall short by 0.001
// degrees, which placing a point within 2^-20 of the chamfer distance explains; the report says by
// how much they do.
OracleReport check_chamfer_angles(const RefinedMesh& mesh);

// Every point made by chamfering lies on the input, at a chamfered corner, and not beyond
// --chamfer-radius: cut points on edges no farther than the corner's distance, bridge points no
// farther than the distance times the factor that the widest sector (120 degrees; 180 where every
// triangle has a bridge) needs. New edges stay inside the facet that they were cut from, and the
// facet's faces cover no more than the facet.
OracleReport check_chamfer_extent(const RefinedMesh& mesh);

// On the surface that the filter kept, a corner was chamfered exactly if it is acute at the
// threshold in force there, and an edge was cut off exactly if it is acute. No distance is above a
// third of the local feature size (the distance, within the facets kept at the corner, to their
// edges that do not meet it; where that was promised, to the corner's link), nor above
// --chamfer-radius.
OracleReport check_chamfer_need(const RefinedMesh& mesh);

// A kept facet has lost only what was cut off at its chamfered corners and acute edges. The
// boundary of the rest follows the facet's own, side by side, except for detours around chamfered
// corners, over points made for that corner, and strips beside acute edges. The area inside that
// boundary is that of the faces.
OracleReport check_chamfer_cuts(const RefinedMesh& mesh);

}  // namespace tetproof::oracles
