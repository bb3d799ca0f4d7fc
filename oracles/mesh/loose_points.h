// Points of the input that no triangle has: electrodes, sensors.
#pragma once

#include <vector>

#include "oracles/files/mesh_file.h"
#include "oracles/files/polyhedron.h"
#include "oracles/mesh/tet_complex.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

std::vector<Index> loose_points(const Polyhedron& input);

// Is each a vertex of the mesh, with the same doubles? One outside of all tetrahedra or of the
// box of the triangles need not be, nor one on a triangle of the input (exactly) or within `near`
// of one (input units, D), which are counted. `complex`: on the vertices of the input, then those
// of the file.
OracleReport check_loose_points(const Polyhedron& input, const MeshFile& mesh,
                                const TetComplex& complex, double near);

}  // namespace tetproof::oracles
