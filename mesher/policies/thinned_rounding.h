// Policy: fewer points where the doubles to be written are too coarse for all of them.
#pragma once

#include "mesher/results/recorder.h"
#include "mesher/run/session.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::policies {

// Rounds a final mesh and records it as written. If it is left with defects (output::defects),
// Steiner points are taken out (thin_out): of the tetrahedra that rounding made inverted or flat,
// then those up to one, two and three edges away. Of these
// meshes the one with the fewest defects is written. Where more than a thousand, or more than an
// eighth of the mesh, are left by plain rounding, points are taken out before anything is repaired,
// and where the first repairs leave more than a few, before others are tried. What is left then may
// be the mesh of the input's vertices alone (plain_without_points).
void round_and_record(ConformingMesh final, Session& session, Recorder& recorder);

}  // namespace delmesher::policies
