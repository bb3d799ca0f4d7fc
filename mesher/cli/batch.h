// Several inputs in one call: each is a run of its own, in a process of its own.
#pragma once

#include <functional>
#include <vector>

#include "mesher/cli/run.h"

namespace delmesher::cli {

// Runs the commands, `jobs` of them at a time. What each says is printed together when it has
// ended, in the order of their ends; then, unless quiet, a line for each says how it ended, and at
// the end there is one that counts. kDone if all are done, else kFailed. A run that dies takes no
// other with it.
int run_batch(const std::vector<Command>& commands, unsigned jobs, const Library& library,
              const Streams& streams);

}  // namespace delmesher::cli
