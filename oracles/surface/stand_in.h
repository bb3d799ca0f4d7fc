// The stand-in, the surface that was meshed instead of the input: is it as near to the input as the
// record says?
#pragma once

#include "mesher/delmesher.h"
#include "oracles/surface/input_surface.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// `surface` is that of the record, on `points`; `input` has the vertices and triangles as given.
// - Every vertex as given is within parameters.planar (input units) of the planes of all its facets
//   of more than one triangle, exactly.
// - A vertex was moved by no more than a quarter of its shortest edge as given.
// - A facet has the triangles, the corners and the outline that it has as given.
OracleReport check_stand_in(const Polyhedron& input, const delmesher::ExactRecord& record,
                            const InputSurface& surface);

}  // namespace tetproof::oracles
