// The job `plane`.
#pragma once

#include <string>

#include "mesher/cli/reports.h"
#include "mesher/cli/run.h"

namespace delmesher::cli {

// Like run(), for a command whose job is Job::plane.
int run_plane(const Command& command, const Library& library, const Streams& streams);

// The JSON of --stats in the plane; its keys are stable. `facts.input_triangles` counts segments.
std::string plane_stats_json(const Command& command, const PlaneResult& result,
                             const RunFacts& facts);

}  // namespace delmesher::cli
