// The job `plane`.
#pragma once

#include "mesher/cli/run.h"

namespace delmesher::cli {

// Like run(), for a command whose job is Job::plane.
int run_plane(const Command& command, const Library& library, const Streams& streams);

}  // namespace delmesher::cli
