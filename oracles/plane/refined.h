// The refined mesh of a record of the plane: which parts of the input it keeps, and what it
// promises. Its triangles are a mesh (plane_complex.h); what it lacks, the final mesh has
// (plane_final.h).
#pragma once

#include "oracles/plane/complex.h"

namespace tetproof::oracles {

// Adds to the report:
// - refined-segments: edges on segments are parts of them; one chain without a hole, or none, is
//   left of each piece;
// - refined-angles, refined-encroachment, refined-edges: in the region that was refined, no angle
//   is below the promised bound (or the record's, where that is larger), no corner is in the open
//   disc of a listed edge of its triangle, and no edge is above --max-edge;
// - refined-sides: triangles are on the side that they claim, and mixed exactly if a part of a
//   segment runs through them with the inside on one side of it alone. Where parity does not decide
//   what is inside, the faces of the input do (plane_faces.h);
// - the oracles of plane_chamfer.h, about what is left of each piece.
void check_plane_refined(RecordedPlane& recorded, VerifyReport& report);

}  // namespace tetproof::oracles
