// The points and planes of a record, read from its text by code that the oracles' own reader has no
// part in (sidecar.h).
#pragma once

#include <string>
#include <vector>

#include "mesher/delmesher.h"

namespace tetproof::oracles {

struct Definitions {
  std::vector<delmesher::ExactPoint> points;
  std::vector<delmesher::ExactRecord::Plane> planes;
};

// As written. False if the text is not in the format.
bool read_definitions(const std::string& path, Definitions& definitions);

}  // namespace tetproof::oracles
