// Options as the driver sees them.
#pragma once

#include <string>

#include "mesher/delmesher.h"

namespace delmesher::run {

// Names the option whose value makes no sense; empty if all do.
std::string options_defect(const Options& options, const OptionBounds& bounds);

}  // namespace delmesher::run
