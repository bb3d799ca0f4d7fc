// The writers of the single formats, for meshes that write_mesh has checked.
#pragma once

#include <string>

#include "mesher/io/named_sets.h"
#include "mesher/io/output.h"

namespace delmesher::io {

void write_medit(TextSink& out, const NamedMesh& named);
void write_gmsh(TextSink& out, const NamedMesh& named);
void write_vtu(TextSink& out, const NamedMesh& named);
void write_tetgen(TextSink& node, TextSink& ele, TextSink& face, const TetMesh& mesh);
void write_tet(TextSink& out, const TetMesh& mesh);
void write_abaqus(TextSink& out, const NamedMesh& named);
void write_nastran(TextSink& out, const NamedMesh& named);
void write_vtk(TextSink& out, const NamedMesh& named);
void write_xdmf(TextSink& out, const NamedMesh& named);
// The boundary alone, with the vertices that it has.
void write_boundary_stl(TextSink& out, const NamedMesh& named);
void write_boundary_ply(TextSink& out, const NamedMesh& named);
void write_boundary_off(TextSink& out, const NamedMesh& named);

// A value for every tetrahedron, then one for every boundary triangle; a line each.
template <typename TetValue, typename TriangleValue>
void cell_lines(TextSink& out, const TetMesh& mesh, TetValue tet_value,
                TriangleValue triangle_value) {
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    out.integer(tet_value(i));
    out.text("\n");
  }
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    out.integer(triangle_value(i));
    out.text("\n");
  }
}

// VTK's numbers of the types of cells.
inline int vtk_tetrahedron(const NamedMesh& named) {
  return named.second_order() ? 24 : 10;
}
inline int vtk_triangle(const NamedMesh& named) {
  return named.second_order() ? 22 : 5;
}

// Text for an attribute or an element of XML.
std::string xml_escaped(const std::string& text);

}  // namespace delmesher::io
