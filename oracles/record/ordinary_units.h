// Verification in other units than the input's, where squares and volumes of its lengths are no
// doubles. Signs are exact in any unit; distances, areas and volumes are measured in doubles.
#pragma once

#include <optional>

#include "oracles/files/mesh_file.h"
#include "oracles/surface/input_surface.h"
#include "oracles/verdict/promise.h"

namespace tetproof::oracles {

// All that a verification compares, in units of 2^exponent input units.
struct InOrdinaryUnits {
  Polyhedron input;
  MeshFile mesh;
  std::optional<delmesher::ExactRecord> record;
  Promise promise;
  int exponent = 0;
};

// Nothing if the largest coordinate of the input is between 2^-200 and 2^200, or if another number
// would lose digits in other units: then the input's units have to do. `record` may be null.
std::optional<InOrdinaryUnits> in_ordinary_units(const Polyhedron& input, const MeshFile& mesh,
                                                 const delmesher::ExactRecord* record,
                                                 const Promise& promise);

}  // namespace tetproof::oracles
