// The final mesh of a record of the plane: that of the input, with the vertices of the refined one.
// Its triangles are a mesh (plane_complex.h).
#pragma once

#include "oracles/plane/complex.h"

namespace tetproof::oracles {

// Adds to the report:
// - exact-conformity: every segment is tiled by its edges, from end to end;
// - exact-sides: triangles are inside or outside as a flood from the border and the holes says,
//   that counts the separating segments it crosses, and, where the input is rings, as rays say;
// - enrichment: the vertices are those of the input and of the refined mesh, and no others; points
//   in faces may be missing, unless kept points are promised, if they are in the diametral disc of
//   an edge at an input vertex on a segment, which the refined mesh lacks (counted);
// - exact-area: the inside of a single ring has the ring's area.
void check_plane_final(RecordedPlane& recorded, VerifyReport& report);

}  // namespace tetproof::oracles
