// Policy: fewer points where the doubles to be written are too coarse for all of them.
#pragma once

#include "mesher/cdt/cdt.h"
#include "mesher/results/recorder.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// Rounds a final mesh and records it as written. Where tetrahedra are left inverted or flat, points
// around them are taken out (thin_out), at first those alone, then up to three edges away, as long
// as that leaves fewer.
void round_and_record(cdt::CdtResult cdt, Session& session, Recorder& recorder);

}  // namespace delmesher::policies
