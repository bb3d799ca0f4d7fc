// Bridge simplification (section 4.4).
#pragma once

#include "mesher/chamfer/bridges.h"

namespace delmesher::chamfer {

// Replaces chains by a single edge, or drops some of their points, where that makes no angle below
// the threshold.
void simplify_bridges(const KeptSurface& surface, const Acuteness& acute, const Cuts& cuts,
                      const Thresholds& thresholds, Predicates& predicates, Bridges& bridges,
                      Control& control);

}  // namespace delmesher::chamfer
