// Are the record and the file one mesh?
#pragma once

#include "oracles/files/mesh_file.h"
#include "oracles/mesh/tet_complex.h"
#include "oracles/verdict/promise.h"

namespace tetproof::oracles {

struct SameMeshOptions {
  double ulp = 0;            // of the largest coordinate of the surface, in input units
  double allowed = 0;        // a declared deviation, in input units
  Index input_vertices = 0;  // the first points
};

// The tetrahedra of the file are, through mesh_vertices and one to one, those of the last mesh of
// the record: of the solid, or all if the hull was promised. Region numbers tell inside from
// outside as the record does. A refined mesh is recorded as it was before it was rounded: where
// rounding made a tetrahedron of it flat or inverted, others that fill the same place are accepted.
// Listed boundary triangles are the record's faces on facets, one to
// one, with their facets and the labels of these (one per triangle of the input, or none), and seen
// from outside.
OracleReport check_same_mesh(const MeshFile& mesh, const delmesher::ExactRecord& record,
                             const Promise& promise, const std::vector<std::int32_t>& labels);

// No two vertices of the file are the same point of the record, and every one is within 4 ulp of
// its exact place in each coordinate, or within what was declared. Without that, vertices of the
// input are where they were given.
OracleReport check_rounding(const MeshFile& mesh, const delmesher::ExactRecord& record,
                            const ExactPoints& points, const SameMeshOptions& options);

// The largest distance of a vertex of the file from its exact place, in input units, rounded up: 0
// exactly if there is none.
double largest_rounding(const MeshFile& mesh, const delmesher::ExactRecord& record,
                        const ExactPoints& points);

}  // namespace tetproof::oracles
