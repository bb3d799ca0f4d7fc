// VTK's XML format, of meshes in space and in the plane.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

#include "mesher/io/binary.h"
#include "mesher/io/named_sets.h"
#include "mesher/io/text.h"
#include "mesher/io/write_formats.h"
#include "mesher/io/write_plane_formats.h"

namespace delmesher::io {
namespace {

template <class T>
constexpr const char* type_name() {
  return std::is_same_v<T, double>         ? "Float64"
         : std::is_same_v<T, std::int64_t> ? "Int64"
         : std::is_same_v<T, std::int32_t> ? "Int32"
         : std::is_same_v<T, std::uint8_t> ? "UInt8"
                                           : "Int8";
}

// A DataArray of numbers of one type: as text in rows, or in base 64, the bytes before their
// number.
template <class T>
class DataArray {
 public:
  DataArray(TextSink& out, bool ascii, const char* name, std::size_t count, int components = 1)
      : out_(out), ascii_(ascii), base64_(out) {
    out.text(std::string("<DataArray type=\"") + type_name<T>() + "\" Name=\"" + name + "\"");
    if (components > 1) out.text(" NumberOfComponents=\"" + std::to_string(components) + "\"");
    out.text(ascii ? " format=\"ascii\">\n" : " format=\"binary\">\n");
    if (!ascii) base64_.add(static_cast<std::uint64_t>(count * sizeof(T)));
  }
  DataArray(const DataArray&) = delete;

  void add(T value) {
    if (!ascii_) return base64_.add(value);
    if (!row_is_empty_) out_.text(" ");
    row_is_empty_ = false;
    if constexpr (std::is_same_v<T, double>) {
      out_.number(value);
    } else {
      out_.integer(static_cast<std::int64_t>(value));
    }
  }
  void end_row() {
    if (ascii_) out_.text("\n");
    row_is_empty_ = true;
  }
  void end() {
    if (!ascii_) {
      base64_.finish();
      out_.text("\n");
    }
    out_.text("</DataArray>\n");
  }

 private:
  TextSink& out_;
  bool ascii_, row_is_empty_ = true;
  Base64Writer base64_;
};

// The file up to its points, which are to be written next.
void begin_file(TextSink& out, const std::string& field_data, std::size_t points,
                std::size_t cells) {
  out.text(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n");
  out.text(field_data);
  out.text("<Piece NumberOfPoints=\"");
  out.integer(points);
  out.text("\" NumberOfCells=\"");
  out.integer(cells);
  out.text("\">\n<Points>\n");
}

void begin_cells(TextSink& out) {
  out.text("</Points>\n<Cells>\n");
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
  CellArrays(TextSink& out, bool ascii, std::size_t first, std::size_t second)
      : out_(out), ascii_(ascii), first_(first), second_(second) {}

  // `add_first(array, i)` adds what the i-th cell of the first kind has; `count` numbers in all.
  template <class T, class AddFirst, class AddSecond>
  void rows(const char* name, std::size_t count, AddFirst add_first, AddSecond add_second) {
    DataArray<T> array(out_, ascii_, name, count);
    for (std::size_t i = 0; i < first_; ++i) {
      add_first(array, i);
      array.end_row();
    }
    for (std::size_t i = 0; i < second_; ++i) {
      add_second(array, i);
      array.end_row();
    }
    array.end();
  }

  // One number for each cell.
  template <class T, class First, class Second>
  void numbers(const char* name, First first, Second second) {
    rows<T>(
        name, first_ + second_,
        [&](DataArray<T>& array, std::size_t i) { array.add(static_cast<T>(first(i))); },
        [&](DataArray<T>& array, std::size_t i) { array.add(static_cast<T>(second(i))); });
  }

 private:
  TextSink& out_;
  bool ascii_;
  std::size_t first_, second_;
};

// For each name an array with its label and 2, the dimension of triangles, or its region and 3. So
// meshio writes Gmsh's groups. Then TetMesh::planar_within.
std::string field_data(const NamedMesh& named) {
  std::string arrays;
  for (const GivenName& given : given_names(named)) {
    arrays += "<DataArray type=\"Int64\" Name=\"" + xml_escaped(given.name) +
              "\" NumberOfTuples=\"2\" format=\"ascii\">\n" + std::to_string(given.number) + " " +
              std::to_string(given.dimension) + "\n</DataArray>\n";
  }
  if (named.mesh.planar_within != 0) {
    arrays += "<DataArray type=\"Float64\" Name=\"PlanarWithin\" NumberOfTuples=\"1\" ";
    arrays += "format=\"ascii\">\n";
    append_double(arrays, named.mesh.planar_within);
    arrays += "\n</DataArray>\n";
  }
  return arrays.empty() ? arrays : "<FieldData>\n" + arrays + "</FieldData>\n";
}

// What the cells are; as integers of a type that holds them.
template <class T>
void write_cells(CellArrays& arrays, const NamedMesh& named) {
  const std::size_t tets = named.mesh.tetrahedra.size();
  const std::size_t size = named.nodes_of_tetrahedron(), small = named.nodes_of_triangle();
  const auto add = [](DataArray<T>& array, const CellNodes& nodes) {
    for (const std::uint32_t v : nodes) array.add(static_cast<T>(v));
  };
  arrays.rows<T>(
      "connectivity", size * tets + small * named.mesh.boundary.size(),
      [&](DataArray<T>& array, std::size_t i) { add(array, named.tetrahedron(i)); },
      [&](DataArray<T>& array, std::size_t i) { add(array, named.triangle(i)); });
  arrays.numbers<T>(
      "offsets", [&](std::size_t i) { return size * (i + 1); },
      [&](std::size_t i) { return size * tets + small * (i + 1); });
}

template <class T>
void write_facets(CellArrays& arrays, const TetMesh& mesh) {
  arrays.numbers<T>(
      "facet", [](std::size_t) { return -1; },
      [&](std::size_t i) { return mesh.boundary_facets[i]; });
}

// Four bytes are enough for most files in base 64; as text it makes no difference.
bool fits_four_bytes(std::uint64_t largest, bool ascii) {
  return !ascii && largest <= std::numeric_limits<std::int32_t>::max();
}

}  // namespace

void write_vtu(TextSink& out, const NamedMesh& named) {
  const TetMesh& mesh = named.mesh;
  const std::size_t tets = mesh.tetrahedra.size(), triangles = mesh.boundary.size();
  begin_file(out, field_data(named), named.nodes(), tets + triangles);
  DataArray<double> points(out, named.ascii, "Points", 3 * named.nodes(), 3);
  for (std::size_t i = 0; i < named.nodes(); ++i) {
    for (const double x : named.node(i)) points.add(x);
    points.end_row();
  }
  points.end();
  begin_cells(out);
  CellArrays arrays(out, named.ascii, tets, triangles);
  const std::size_t corners =
      named.nodes_of_tetrahedron() * tets + named.nodes_of_triangle() * triangles;
  fits_four_bytes(std::max(corners, named.nodes()), named.ascii)
      ? write_cells<std::int32_t>(arrays, named)
      : write_cells<std::int64_t>(arrays, named);
  arrays.numbers<std::uint8_t>(
      "types", [&](std::size_t) { return vtk_tetrahedron(named); },
      [&](std::size_t) { return vtk_triangle(named); });
  begin_cell_data(out);
  arrays.numbers<std::int8_t>(
      "inside", [&](std::size_t i) { return mesh.inside[i] != 0 ? 1 : 0; },
      [](std::size_t) { return -1; });
  if (!mesh.regions.empty()) {
    arrays.numbers<std::int32_t>(
        "region", [&](std::size_t i) { return mesh.regions[i]; }, [](std::size_t) { return 0; });
  }
  arrays.numbers<std::int32_t>(
      "label", [](std::size_t) { return 0; },
      [&](std::size_t i) { return mesh.boundary_labels[i]; });
  const auto largest = std::max_element(mesh.boundary_facets.begin(), mesh.boundary_facets.end());
  fits_four_bytes(largest == mesh.boundary_facets.end() ? 0 : *largest, named.ascii)
      ? write_facets<std::int32_t>(arrays, mesh)
      : write_facets<std::int64_t>(arrays, mesh);
  end_file(out);
}

namespace {

template <class T>
void write_plane_cells(CellArrays& arrays, const PlaneMesh& mesh) {
  const std::size_t triangles = mesh.triangles.size();
  const auto add = [](DataArray<T>& array, const auto& cell) {
    for (const std::uint32_t v : cell) array.add(static_cast<T>(v));
  };
  arrays.rows<T>(
      "connectivity", 3 * triangles + 2 * mesh.edges.size(),
      [&](DataArray<T>& array, std::size_t t) { add(array, mesh.triangles[t]); },
      [&](DataArray<T>& array, std::size_t e) { add(array, mesh.edges[e]); });
  arrays.numbers<T>(
      "offsets", [](std::size_t t) { return 3 * (t + 1); },
      [&](std::size_t e) { return 3 * triangles + 2 * (e + 1); });
}

}  // namespace

void write_plane_vtu(TextSink& out, const PlaneMesh& mesh, bool ascii) {
  const std::size_t triangles = mesh.triangles.size(), edges = mesh.edges.size();
  begin_file(out, {}, mesh.vertices.size(), triangles + edges);
  DataArray<double> points(out, ascii, "Points", 3 * mesh.vertices.size(), 3);
  for (const Point2& p : mesh.vertices) {
    for (const double x : {p[0], p[1], 0.0}) points.add(x);
    points.end_row();
  }
  points.end();
  begin_cells(out);
  CellArrays arrays(out, ascii, triangles, edges);
  fits_four_bytes(std::max(3 * triangles + 2 * edges, mesh.vertices.size()), ascii)
      ? write_plane_cells<std::int32_t>(arrays, mesh)
      : write_plane_cells<std::int64_t>(arrays, mesh);
  arrays.numbers<std::uint8_t>(
      "types", [](std::size_t) { return 5; }, [](std::size_t) { return 3; });
  begin_cell_data(out);
  arrays.numbers<std::int8_t>(
      "inside", [&](std::size_t t) { return mesh.inside[t] != 0 ? 1 : 0; },
      [](std::size_t) { return -1; });
  arrays.numbers<std::int32_t>(
      "marker", [](std::size_t) { return 0; }, [&](std::size_t e) { return mesh.edge_markers[e]; });
  arrays.numbers<std::int64_t>(
      "segment", [](std::size_t) { return -1; },
      [&](std::size_t e) { return mesh.edge_segments[e]; });
  if (!mesh.attributes.empty()) {
    arrays.numbers<double>(
        "attribute", [&](std::size_t t) { return mesh.attributes[t]; },
        [&](std::size_t) { return 0; });
  }
  end_file(out);
}

}  // namespace delmesher::io
