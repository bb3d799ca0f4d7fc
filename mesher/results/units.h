// Models of extreme size. The stages work in doubles where they only steer; lengths of about 1e-80
// have fourth powers that underflow. So such models are meshed in units of a power of two near
// their size, which is exact, and the result is given back in theirs.
#pragma once

#include "mesher/delmesher.h"

namespace delmesher::results {

using Task = Result(const Surface&, const Options&);
using MeshTask = Result(const TetMesh&, const Options&);

// Calls `task` with surface, or mesh, and options, in other units if the model's size calls for it
// and if that is exact for every coordinate.
Result in_ordinary_units(const Surface& surface, const Options& options, Task& task);
Result in_ordinary_units(const TetMesh& mesh, const Options& options, MeshTask& task);

}  // namespace delmesher::results
