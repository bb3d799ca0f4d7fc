// The writers of the single formats, for meshes that write_mesh has checked.
#pragma once

#include "mesher/delmesher.h"
#include "mesher/io/output.h"

namespace delmesher::io {

// Region number of a tetrahedron in the formats that have one.
inline constexpr int kRegionInside = 1, kRegionOutside = 2;
std::int32_t region(const TetMesh& mesh, std::size_t tet);

void write_medit(TextSink& out, const TetMesh& mesh);
void write_gmsh(TextSink& out, const TetMesh& mesh);
void write_vtu(TextSink& out, const TetMesh& mesh);
void write_tetgen(TextSink& node, TextSink& ele, TextSink& face, const TetMesh& mesh);
void write_tet(TextSink& out, const TetMesh& mesh);

}  // namespace delmesher::io
