// VTK's XML format, of meshes in space and in the plane.
#include <cstddef>
#include <cstdint>
#include <string>

#include "mesher/io/named_sets.h"
#include "mesher/io/write_formats.h"
#include "mesher/io/write_plane_formats.h"

namespace delmesher::io {
namespace {

void begin_array(TextSink& out, const char* type, const char* name) {
  out.text("<DataArray type=\"");
  out.text(type);
  out.text("\" Name=\"");
  out.text(name);
  out.text("\" format=\"ascii\">\n");
}

// The file up to its points, which are to be written next, each with a line end.
void begin_file(TextSink& out, const std::string& field_data, std::size_t points,
                std::size_t cells) {
  out.text(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<UnstructuredGrid>\n");
  out.text(field_data);
  out.text("<Piece NumberOfPoints=\"");
  out.integer(points);
  out.text("\" NumberOfCells=\"");
  out.integer(cells);
  out.text(
      "\">\n<Points>\n"
      "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n");
}

void begin_cells(TextSink& out) {
  out.text("</DataArray>\n</Points>\n<Cells>\n");
}

void begin_cell_data(TextSink& out) {
  out.text("</Cells>\n<CellData>\n");
}

void end_file(TextSink& out) {
  out.text("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
}

// Arrays over cells of two kinds, those of the first kind before those of the second.
class CellArrays {
 public:
  CellArrays(TextSink& out, std::size_t first, std::size_t second)
      : out_(out), first_(first), second_(second) {}

  // `write_first(i)` writes the entry of the i-th cell of the first kind.
  template <class WriteFirst, class WriteSecond>
  void write(const char* type, const char* name, WriteFirst write_first, WriteSecond write_second) {
    begin_array(out_, type, name);
    for (std::size_t i = 0; i < first_; ++i) {
      write_first(i);
      out_.text("\n");
    }
    for (std::size_t i = 0; i < second_; ++i) {
      write_second(i);
      out_.text("\n");
    }
    out_.text("</DataArray>\n");
  }

  // One number for each cell.
  template <class First, class Second>
  void numbers(const char* type, const char* name, First first, Second second) {
    write(
        type, name, [&](std::size_t i) { out_.integer(first(i)); },
        [&](std::size_t i) { out_.integer(second(i)); });
  }

 private:
  TextSink& out_;
  std::size_t first_, second_;
};

// For each name an array with its label and 2, the dimension of triangles. So meshio writes Gmsh's
// groups.
std::string field_data(const NamedMesh& named) {
  std::string arrays;
  for (const auto& [label, triangles] : triangles_of_labels(named.mesh)) {
    if (!named.names.contains(label)) continue;
    arrays += "<DataArray type=\"Int64\" Name=\"" + xml_escaped(label_name(named.names, label)) +
              "\" NumberOfTuples=\"2\" format=\"ascii\">\n" + std::to_string(label) +
              " 2\n</DataArray>\n";
  }
  return arrays.empty() ? arrays : "<FieldData>\n" + arrays + "</FieldData>\n";
}

}  // namespace

void write_vtu(TextSink& out, const NamedMesh& named) {
  const TetMesh& mesh = named.mesh;
  const std::size_t tets = mesh.tetrahedra.size(), triangles = mesh.boundary.size();
  begin_file(out, field_data(named), named.nodes(), tets + triangles);
  for (std::size_t i = 0; i < named.nodes(); ++i) {
    out.point(named.node(i));
    out.text("\n");
  }
  begin_cells(out);
  CellArrays arrays(out, tets, triangles);
  arrays.write(
      "Int64", "connectivity",
      [&](std::size_t i) {
        for (const std::uint32_t v : named.tetrahedron(i)) out.integers(v);
      },
      [&](std::size_t i) {
        for (const std::uint32_t v : named.triangle(i)) out.integers(v);
      });
  arrays.numbers(
      "Int64", "offsets", [&](std::size_t i) { return named.nodes_of_tetrahedron() * (i + 1); },
      [&](std::size_t i) {
        return named.nodes_of_tetrahedron() * tets + named.nodes_of_triangle() * (i + 1);
      });
  arrays.numbers(
      "UInt8", "types", [&](std::size_t) { return vtk_tetrahedron(named); },
      [&](std::size_t) { return vtk_triangle(named); });
  begin_cell_data(out);
  arrays.numbers(
      "Int8", "inside", [&](std::size_t i) { return mesh.inside[i] != 0 ? 1 : 0; },
      [](std::size_t) { return -1; });
  if (!mesh.regions.empty()) {
    arrays.numbers(
        "Int32", "region", [&](std::size_t i) { return mesh.regions[i]; },
        [](std::size_t) { return 0; });
  }
  arrays.numbers(
      "Int32", "label", [](std::size_t) { return 0; },
      [&](std::size_t i) { return mesh.boundary_labels[i]; });
  arrays.numbers(
      "Int64", "facet", [](std::size_t) { return std::int64_t{-1}; },
      [&](std::size_t i) { return std::int64_t{mesh.boundary_facets[i]}; });
  end_file(out);
}

void write_plane_vtu(TextSink& out, const PlaneMesh& mesh) {
  const std::size_t triangles = mesh.triangles.size();
  begin_file(out, {}, mesh.vertices.size(), triangles + mesh.edges.size());
  for (const Point2& p : mesh.vertices) {
    point(out, p);
    out.text(" 0\n");
  }
  begin_cells(out);
  CellArrays arrays(out, triangles, mesh.edges.size());
  arrays.write(
      "Int64", "connectivity",
      [&](std::size_t t) {
        for (const std::uint32_t v : mesh.triangles[t]) out.integers(v);
      },
      [&](std::size_t e) { out.integers(mesh.edges[e][0], mesh.edges[e][1]); });
  arrays.numbers(
      "Int64", "offsets", [](std::size_t t) { return 3 * (t + 1); },
      [&](std::size_t e) { return 3 * triangles + 2 * (e + 1); });
  arrays.numbers(
      "UInt8", "types", [](std::size_t) { return 5; }, [](std::size_t) { return 3; });
  begin_cell_data(out);
  arrays.numbers(
      "Int8", "inside", [&](std::size_t t) { return mesh.inside[t] != 0 ? 1 : 0; },
      [](std::size_t) { return -1; });
  arrays.numbers(
      "Int32", "marker", [](std::size_t) { return 0; },
      [&](std::size_t e) { return mesh.edge_markers[e]; });
  arrays.numbers(
      "Int64", "segment", [](std::size_t) { return -1; },
      [&](std::size_t e) { return mesh.edge_segments[e]; });
  if (!mesh.attributes.empty()) {
    arrays.write(
        "Float64", "attribute", [&](std::size_t t) { out.number(mesh.attributes[t]); },
        [&](std::size_t) { out.integer(0); });
  }
  end_file(out);
}

}  // namespace delmesher::io
