// Policy: how much of the surface the filter drops, so that the mesh keeps to a budget.
#pragma once

#include "mesher/chamfer/filter.h"
#include "mesher/results/recorder.h"
#include "mesher/surface/session.h"

namespace delmesher {

// A surface ready for the refinement (sections 4 and 7).
struct ChamferedSurface {
  double tau = 0;  // filter tolerance, a fraction of the diagonal
  FilterResult filter;
  ChamferResult chamfer;
};

ChamferedSurface filter_and_chamfer_by(double tau, const ChamferOptions& options, Session& session);

// With the smallest of tau, 2 tau, 4 tau ... for which no more tetrahedra are predicted than
// Options::budget says (0: with tau). Throws Stopped if none of them does.
ChamferedSurface chamfer_within_budget(const ChamferOptions& options, Session& session,
                                       Recorder& recorder);

}  // namespace delmesher
