// For viewers and converters: VTK's old format, and XDMF with the numbers in the file.
#include <string>

#include "mesher/io/named_sets.h"
#include "mesher/io/write_formats.h"

namespace delmesher::io {
namespace {

// Calls begin(name), writes the numbers and calls end() for the arrays that all of these formats
// have.
template <class Begin, class End>
void cell_arrays(TextSink& out, const TetMesh& mesh, Begin begin, End end) {
  begin("region");
  cell_lines(
      out, mesh, [&](std::size_t t) { return region(mesh, t); }, [](std::size_t) { return 0; });
  end();
  begin("label");
  cell_lines(
      out, mesh, [](std::size_t) { return 0; },
      [&](std::size_t i) { return mesh.boundary_labels[i]; });
  end();
  begin("facet");
  cell_lines(
      out, mesh, [](std::size_t) { return std::int64_t{-1}; },
      [&](std::size_t i) { return std::int64_t{mesh.boundary_facets[i]}; });
  end();
}

void cell(TextSink& out, std::size_t before, const CellNodes& nodes) {
  out.integer(before);
  for (const std::uint32_t v : nodes) {
    out.text(" ");
    out.integer(v);
  }
  out.text("\n");
}

// One line a cell: the number that the format puts before tetrahedra, or triangles, and the nodes.
void cells(TextSink& out, const NamedMesh& named, std::size_t before_tetrahedron,
           std::size_t before_triangle) {
  for (std::size_t i = 0; i < named.mesh.tetrahedra.size(); ++i) {
    cell(out, before_tetrahedron, named.tetrahedron(i));
  }
  for (std::size_t i = 0; i < named.mesh.boundary.size(); ++i) {
    cell(out, before_triangle, named.triangle(i));
  }
}

// How many numbers these are.
std::size_t numbers_of_cells(const NamedMesh& named) {
  return (1 + named.nodes_of_tetrahedron()) * named.mesh.tetrahedra.size() +
         (1 + named.nodes_of_triangle()) * named.mesh.boundary.size();
}

void points(TextSink& out, const NamedMesh& named) {
  for (std::size_t i = 0; i < named.nodes(); ++i) {
    out.point(named.node(i));
    out.text("\n");
  }
}

}  // namespace

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

void write_vtk(TextSink& out, const NamedMesh& named) {
  const TetMesh& mesh = named.mesh;
  const std::size_t tets = mesh.tetrahedra.size(), triangles = mesh.boundary.size();
  out.text("# vtk DataFile Version 3.0\ndelmesher\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS ");
  out.integer(named.nodes());
  out.text(" double\n");
  points(out, named);
  out.text("CELLS ");
  out.integers(tets + triangles);
  out.integer(numbers_of_cells(named));
  out.text("\n");
  cells(out, named, named.nodes_of_tetrahedron(), named.nodes_of_triangle());
  out.text("CELL_TYPES ");
  out.integer(tets + triangles);
  out.text("\n");
  cell_lines(
      out, mesh, [&](std::size_t) { return vtk_tetrahedron(named); },
      [&](std::size_t) { return vtk_triangle(named); });
  out.text("CELL_DATA ");
  out.integer(tets + triangles);
  out.text("\n");
  cell_arrays(
      out, mesh,
      [&](const char* name) {
        out.text(std::string("SCALARS ") + name + " int 1\nLOOKUP_TABLE default\n");
      },
      [] {});
}

void write_xdmf(TextSink& out, const NamedMesh& named) {
  const TetMesh& mesh = named.mesh;
  const std::size_t tets = mesh.tetrahedra.size(), triangles = mesh.boundary.size();
  const auto item = [&](const char* type, const char* precision, std::size_t rows, int columns) {
    out.text(std::string("<DataItem DataType=\"") + type + "\" Precision=\"" + precision +
             "\" Format=\"XML\" Dimensions=\"" + std::to_string(rows));
    if (columns > 1) out.text(" " + std::to_string(columns));
    out.text("\">\n");
  };
  out.text(
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n"
      "<Grid Name=\"delmesher\" GridType=\"Uniform\">\n<Geometry GeometryType=\"XYZ\">\n");
  item("Float", "8", named.nodes(), 3);
  points(out, named);
  out.text("</DataItem>\n</Geometry>\n<Topology TopologyType=\"Mixed\" NumberOfElements=\"");
  out.integer(tets + triangles);
  out.text("\">\n");
  item("Int", "8", numbers_of_cells(named), 1);
  cells(out, named, 6, 4);  // XDMF's numbers of a tetrahedron and a triangle
  out.text("</DataItem>\n</Topology>\n");
  cell_arrays(
      out, mesh,
      [&](const char* name) {
        out.text(std::string("<Attribute Name=\"") + name +
                 "\" AttributeType=\"Scalar\" Center=\"Cell\">\n");
        item("Int", "8", tets + triangles, 1);
      },
      [&] { out.text("</DataItem>\n</Attribute>\n"); });
  std::string maps;  // as meshio writes and reads them
  for (const GivenName& given : given_names(named)) {
    maps += "<map key=\"" + xml_escaped(given.name) + "\" dim=\"" +
            std::to_string(given.dimension) + "\">" + std::to_string(given.number) + "</map>";
  }
  if (!maps.empty()) {
    out.text("<Information Name=\"names\"><![CDATA[<main>" + maps + "</main>]]></Information>\n");
  }
  out.text("</Grid>\n</Domain>\n</Xdmf>\n");
}

}  // namespace delmesher::io
