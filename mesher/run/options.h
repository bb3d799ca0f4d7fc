// Options as the driver sees them.
#pragma once

#include <string>

#include "mesher/delmesher.h"

namespace delmesher::run {

// Names an option whose value is not accepted; empty if all are.
std::string options_defect(const Options& options, const OptionBounds& bounds);

}  // namespace delmesher::run
