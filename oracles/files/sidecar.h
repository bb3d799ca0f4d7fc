// Reads the sidecar that `delmesher mesh --exact FILE` writes. The oracles' own reader.
#pragma once

#include <string>

#include "mesher/delmesher.h"

namespace tetproof::oracles {

// Throws ReadError. Older versions are read as far as they go. The oracle of the promise is told
// the version and says what they lack.
delmesher::ExactRecord read_sidecar(const std::string& path, unsigned* version = nullptr);

}  // namespace tetproof::oracles
