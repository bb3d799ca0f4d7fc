// Records of surfaces far from the origin, whose points are relative to one beside them.
#pragma once

#include "oracles/files/mesh_file.h"
#include "oracles/surface/input_surface.h"
#include "oracles/verdict/promise.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// All that a verification compares, relative to the origin that the record names. Only oracles that
// ask what rounding did look at that of `record` again.
struct BesideOrigin {
  Polyhedron input;
  MeshFile mesh;
  delmesher::ExactRecord record;
  Promise promise;
  double largest = 0;  // absolute value of a coordinate of the input as given
};

bool names_origin(const delmesher::ExactRecord& record);

// Moves everything there. Fails unless that is exact for every number: else the record cannot be of
// this input and file. Fails as well if that is not a place for an origin: the input must be far
// from 0 for its size, and the origin beside it.
OracleReport move_to_origin(BesideOrigin& task);

}  // namespace tetproof::oracles
