// The job `improve`.
#pragma once

#include "mesher/cli/run.h"

namespace delmesher::cli {

// Like run(), for a command whose job is Job::improve.
int run_improve(const Command& command, const Library& library, const Streams& streams);

}  // namespace delmesher::cli
