// Reading the sidecar that `delmesher mesh --exact FILE` writes. The oracles' own reader.
#pragma once

#include <string>

#include "mesher/delmesher.h"

namespace tetproof::oracles {

// Throws ReadError. Older versions are read as far as they go: what they lack is for the oracle of
// the promise to say, which is told the version.
delmesher::ExactRecord read_sidecar(const std::string& path, unsigned* version = nullptr);

}  // namespace tetproof::oracles
