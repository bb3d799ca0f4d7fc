// Several inputs in one call: each is a run of its own, in a process of its own.
#pragma once

#include <functional>
#include <vector>

#include "mesher/cli/run.h"

namespace delmesher::cli {

// Runs the commands, `jobs` of them at a time. The messages of a run are printed together when it
// has ended, in the order of the ends. Then, unless quiet, a line for each run says how it ended,
// and a last line counts them. kDone if all are done, kInterrupted after a signal, which ends
// those that run and begins no other, else kFailed. A run that dies takes no other with it.
int run_batch(const std::vector<Command>& commands, unsigned jobs, const Library& library,
              const Streams& streams);

}  // namespace delmesher::cli
