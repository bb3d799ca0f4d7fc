// Policy: where the vertices as given do not go with planar facets.
#pragma once

#include <functional>

#include "mesher/delmesher.h"

namespace delmesher::policies {

// Runs `task`. Facets were made planar by moving vertices; the mesh is written with the vertices as
// given, which may turn over tetrahedra that are no thicker than the vertices moved. If some are
// left, the task is run again with a bound a 32nd as large, and then without planar facets; the
// best result is returned. The limits hold for all runs together.
Result with_finer_planes(const Surface& surface, const Options& options,
                         const std::function<Result(const Surface&, const Options&)>& task);

}  // namespace delmesher::policies
