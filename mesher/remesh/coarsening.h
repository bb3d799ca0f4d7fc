// Fewer triangles: edges collapse, those first that are least off and shortest.
#pragma once

#include "mesher/remesh/state.h"

namespace delmesher::remesh {

// Until no edge collapses.
void coarsen(State& state, Control& control);

}  // namespace delmesher::remesh
