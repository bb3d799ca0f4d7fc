// Is the surface kept: is every triangle of the input one face of the mesh?
#pragma once

#include <span>

#include "oracles/files/mesh_file.h"
#include "oracles/files/polyhedron.h"
#include "oracles/verdict/promise.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// The figures of check_kept.
inline constexpr const char *kSplitTriangles = "triangles split",
                            *kAddedVertices = "vertices added",
                            *kLongTriangles = "triangles with edges too long";

// Compares the triangles of the input with the boundary faces of the solid, by the coordinates of
// their corners and nothing else: of each triangle there are as many faces as there are such
// triangles. A triangle of which there is no face is a violation, unless Promise::halves lets one
// of its edges be split. `faces` number the vertices of the file from `first` on. How they look is
// for other oracles.
OracleReport check_kept(const Polyhedron& input, const MeshFile& mesh, std::span<const Face> faces,
                        Index first, const Promise& promise = {});

}  // namespace tetproof::oracles
