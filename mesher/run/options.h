// Options as the drivers see them.
#pragma once

#include <string>

#include "mesher/delmesher.h"

namespace delmesher::run {

// Names an option of the job whose value is not accepted; empty if all are.
template <class JobOptions>
std::string options_defect(const JobOptions& options);

// SurfaceChoice::automatic is SurfaceChoice::split if options need that.
SurfaceChoice surface_choice(const Options& options);

}  // namespace delmesher::run
