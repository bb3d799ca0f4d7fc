// Models of extreme size, or far from the origin. The stages work in doubles where they only steer;
// lengths of about 1e-80 have fourth powers that underflow. So such models are meshed in units of a
// power of two near their size, which is exact, and the result is given back in theirs. Surfaces
// that are far from the origin are meshed beside it (geometry/local_frame.h).
#pragma once

#include "mesher/delmesher.h"
#include "mesher/geometry/local_frame.h"

namespace delmesher::results {

// The frame is in the units of the surface.
using Task = Result(const Surface&, const Options&, const geometry::LocalFrame&);
using RemeshTask = RemeshResult(const Surface&, const RemeshOptions&);
using MeshTask = Result(const TetMesh&, const ImproveOptions&);

// Calls `task` with surface, or mesh, and options, in other units if the model's size calls for it
// and if that is exact for every coordinate; with surfaces moved if they are more than 2^26 times
// their size away and if that is exact, too.
Result in_ordinary_units(const Surface& surface, const Options& options, Task& task);
RemeshResult in_ordinary_units(const Surface& surface, const RemeshOptions& options,
                               RemeshTask& task);
Result in_ordinary_units(const TetMesh& mesh, const ImproveOptions& options, MeshTask& task);

}  // namespace delmesher::results
