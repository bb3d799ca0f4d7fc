// MEDIT, VTU, TetGen and .tet; Gmsh's format has a file of its own.
#include "mesher/io/write_formats.h"

#include <algorithm>

namespace delmesher::io {
namespace {

void begin_array(TextSink& out, const char* type, const char* name) {
  out.text("<DataArray type=\"");
  out.text(type);
  out.text("\" Name=\"");
  out.text(name);
  out.text("\" format=\"ascii\">\n");
}

// An array with one value for every tetrahedron, then one for every boundary triangle.
template <typename TetValue, typename TriangleValue>
void cell_array(TextSink& out, const TetMesh& mesh, const char* type, const char* name,
                TetValue tet_value, TriangleValue triangle_value) {
  begin_array(out, type, name);
  cell_lines(out, mesh, tet_value, triangle_value);
  out.text("</DataArray>\n");
}

// An array of the name, with the label and 2, the dimension of what bears it: as meshio has it of
// Gmsh's groups.
void write_field_data(TextSink& out, const NamedMesh& named) {
  std::string arrays;
  for (const auto& [label, triangles] : triangles_of_labels(named.mesh)) {
    if (!named.names.contains(label)) continue;
    arrays += "<DataArray type=\"Int64\" Name=\"" + xml_escaped(label_name(named.names, label)) +
              "\" NumberOfTuples=\"2\" format=\"ascii\">\n" + std::to_string(label) +
              " 2\n</DataArray>\n";
  }
  if (!arrays.empty()) out.text("<FieldData>\n" + arrays + "</FieldData>\n");
}

}  // namespace

void write_medit(TextSink& out, const TetMesh& mesh) {
  out.text("MeshVersionFormatted 2\nDimension 3\nVertices\n");
  out.integer(mesh.vertices.size());
  out.text("\n");
  for (const auto& v : mesh.vertices) {
    out.point(v);
    out.text(" 0\n");
  }
  out.text("Triangles\n");
  out.integer(mesh.boundary.size());
  out.text("\n");
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    for (std::uint32_t v : mesh.boundary[i]) out.integers(v + 1);
    out.integer(mesh.boundary_labels[i]);
    out.text("\n");
  }
  out.text("Tetrahedra\n");
  out.integer(mesh.tetrahedra.size());
  out.text("\n");
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    for (std::uint32_t v : mesh.tetrahedra[i]) out.integers(v + 1);
    out.integer(region(mesh, i));
    out.text("\n");
  }
  // No keyword of the format carries a second number per triangle, and some readers refuse unknown
  // keywords even after End; comments are skipped by all.
  out.text("End\n# TriangleFacets ");
  out.integer(mesh.boundary.size());
  out.text("\n");
  for (std::uint32_t facet : mesh.boundary_facets) {
    out.text("# ");
    out.integer(facet);
    out.text("\n");
  }
}

void write_vtu(TextSink& out, const NamedMesh& named) {
  const TetMesh& mesh = named.mesh;
  const std::size_t tets = mesh.tetrahedra.size(), triangles = mesh.boundary.size();
  out.text(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<UnstructuredGrid>\n");
  write_field_data(out, named);
  out.text("<Piece NumberOfPoints=\"");
  out.integer(mesh.vertices.size());
  out.text("\" NumberOfCells=\"");
  out.integer(tets + triangles);
  out.text("\">\n<Points>\n");
  out.text(
      "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n");
  for (const auto& v : mesh.vertices) {
    out.point(v);
    out.text("\n");
  }
  out.text("</DataArray>\n</Points>\n<Cells>\n");
  begin_array(out, "Int64", "connectivity");
  for (const auto& tet : mesh.tetrahedra) {
    for (std::uint32_t v : tet) out.integers(v);
    out.text("\n");
  }
  for (const auto& triangle : mesh.boundary) {
    for (std::uint32_t v : triangle) out.integers(v);
    out.text("\n");
  }
  out.text("</DataArray>\n");
  cell_array(
      out, mesh, "Int64", "offsets", [](std::size_t i) { return 4 * (i + 1); },
      [&](std::size_t i) { return 4 * tets + 3 * (i + 1); });
  cell_array(
      out, mesh, "UInt8", "types", [](std::size_t) { return 10; }, [](std::size_t) { return 5; });
  out.text("</Cells>\n<CellData>\n");
  cell_array(
      out, mesh, "Int8", "inside", [&](std::size_t i) { return mesh.inside[i] != 0 ? 1 : 0; },
      [](std::size_t) { return -1; });
  if (!mesh.regions.empty()) {
    cell_array(
        out, mesh, "Int32", "region", [&](std::size_t i) { return mesh.regions[i]; },
        [](std::size_t) { return 0; });
  }
  cell_array(
      out, mesh, "Int32", "label", [](std::size_t) { return 0; },
      [&](std::size_t i) { return mesh.boundary_labels[i]; });
  cell_array(
      out, mesh, "Int64", "facet", [](std::size_t) { return std::int64_t{-1}; },
      [&](std::size_t i) { return std::int64_t{mesh.boundary_facets[i]}; });
  out.text("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
}

void write_tetgen(TextSink& node, TextSink& ele, TextSink& face, const TetMesh& mesh) {
  node.integer(mesh.vertices.size());
  node.text(" 3 0 0\n");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    node.integers(i);
    node.point(mesh.vertices[i]);
    node.text("\n");
  }
  ele.integer(mesh.tetrahedra.size());
  ele.text(" 4 1\n");
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    ele.integers(i);
    for (std::uint32_t v : mesh.tetrahedra[i]) ele.integers(v);
    ele.integer(region(mesh, i));
    ele.text("\n");
  }
  face.integer(mesh.boundary.size());
  face.text(" 1\n");
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    face.integers(i);
    for (std::uint32_t v : mesh.boundary[i]) face.integers(v);
    face.integers(mesh.boundary_labels[i]);
    face.integer(mesh.boundary_facets[i]);
    face.text("\n");
  }
}

void write_tet(TextSink& out, const TetMesh& mesh) {
  const auto inner = static_cast<std::size_t>(
      std::count_if(mesh.inside.begin(), mesh.inside.end(), [](auto flag) { return flag != 0; }));
  const std::size_t outer = mesh.tetrahedra.size() - inner;
  out.integer(mesh.vertices.size());
  out.text(" vertices\n");
  out.integer(inner);
  out.text(outer == 0 ? " tets\n" : " inner tets\n");
  if (outer != 0) {
    out.integer(outer);
    out.text(" outer tets\n");
  }
  for (const auto& v : mesh.vertices) {
    out.point(v);
    out.text("\n");
  }
  for (const bool wanted : {true, false}) {
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
      if ((mesh.inside[i] != 0) != wanted) continue;
      const auto& [a, b, c, d] = mesh.tetrahedra[i];
      out.text("4 ");
      out.integers(a, b, c);
      out.integer(d);
      out.text("\n");
    }
  }
}

}  // namespace delmesher::io
