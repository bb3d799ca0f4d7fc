// The job `plane`, and the others that take planar graphs.
#pragma once

#include "mesher/cli/run.h"

namespace delmesher::cli {

// Like run(), for a command whose job is Job::plane.
int run_plane(const Command& command, const Library& library, const Streams& streams);

// Like run(), for `check` and `repair` of a planar graph.
int run_graph(const Command& command, const Library& library, const Streams& streams);

}  // namespace delmesher::cli
