// Reading the sidecar that `delmesher mesh --exact FILE` writes. The oracles' own reader.
#pragma once

#include <string>

#include "mesher/delmesher.h"

namespace tetproof::oracles {

// Throws ReadError.
delmesher::ExactRecord read_sidecar(const std::string& path);

}  // namespace tetproof::oracles
