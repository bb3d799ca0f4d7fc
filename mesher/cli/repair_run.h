// The job `repair`.
#pragma once

#include "mesher/cli/run.h"

namespace delmesher::cli {

int run_repair(const Command& command, const Library& library, const Streams& streams);

}  // namespace delmesher::cli
