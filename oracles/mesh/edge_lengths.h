// How long the edges of a mesh are, compared with what was promised.
#pragma once

#include <span>

#include "oracles/mesh/angles.h"
#include "oracles/mesh/tet_complex.h"
#include "oracles/verdict/promise.h"

namespace tetproof::oracles {

// What --max-edge and --size-field allow: no edge of a tetrahedron in the scope is longer, for a
// field at none of its points. One report for each of the two that was promised, "edges" and
// "sizes", with the figures of edge_sizes.h. `longest`: per tetrahedron, 0: any; empty: --max-edge.
std::vector<OracleReport> check_edge_lengths(const TetComplex& complex, const Promise& promise,
                                             std::span<const double> longest, AngleScope scope);

}  // namespace tetproof::oracles
