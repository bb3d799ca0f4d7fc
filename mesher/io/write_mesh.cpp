#include "mesher/io/write_mesh.h"

#include <algorithm>

#include "mesher/io/file_formats.h"
#include "mesher/io/write_formats.h"

namespace delmesher::io {
namespace {

// Checks the assumptions of the writers. A violation is a bug of the caller, but must not crash.
const char* inconsistency(const TetMesh& mesh) {
  const auto in_range = [&](const auto& cells) {
    return std::all_of(cells.begin(), cells.end(), [&](const auto& cell) {
      return std::all_of(cell.begin(), cell.end(),
                         [&](std::uint32_t v) { return v < mesh.vertices.size(); });
    });
  };
  if (mesh.inside.size() != mesh.tetrahedra.size()) return "inside flags do not match";
  if (!mesh.regions.empty() && mesh.regions.size() != mesh.tetrahedra.size()) {
    return "regions do not match";
  }
  if (mesh.boundary_labels.size() != mesh.boundary.size()) return "labels do not match";
  if (mesh.boundary_facets.size() != mesh.boundary.size()) return "facets do not match";
  if (!in_range(mesh.tetrahedra) || !in_range(mesh.boundary)) return "a vertex is out of range";
  return nullptr;
}

// Bits of Lacks. One label or region tells nothing, whatever it is called.
unsigned contents(const NamedMesh& named) {
  unsigned there = several(named.mesh.regions) ? kLacksRegions : kLacksNothing;
  if (several(named.mesh.boundary_labels)) there |= kLacksLabels;
  if (given_names(named).size() > 1) there |= kLacksNames;
  return there;
}

constexpr std::size_t kMostNodes = 0xfffffff0U;

constexpr std::array<FileFormat<NamedMesh>, 3> kBoundaryFormats = {
    {{{".stl"}, [](Sinks f, const NamedMesh& m) { write_boundary_stl(*f[0], m); }},
     {{".ply"}, [](Sinks f, const NamedMesh& m) { write_boundary_ply(*f[0], m); }},
     {{".off"}, [](Sinks f, const NamedMesh& m) { write_boundary_off(*f[0], m); }, kLacksLabels}}};

// The extension of the path first, then the extensions of the files beside it.
constexpr std::array<FileFormat<NamedMesh>, 12> kFormats = {
    {{{".mesh"}, [](Sinks f, const NamedMesh& m) { write_medit(*f[0], m); }, kLacksNames},
     {{".msh"}, [](Sinks f, const NamedMesh& m) { write_gmsh(*f[0], m); }},
     {{".vtu"}, [](Sinks f, const NamedMesh& m) { write_vtu(*f[0], m); }},
     {{".vtk"}, [](Sinks f, const NamedMesh& m) { write_vtk(*f[0], m); }, kLacksNames},
     {{".xdmf"}, [](Sinks f, const NamedMesh& m) { write_xdmf(*f[0], m); }},
     {{".inp"}, [](Sinks f, const NamedMesh& m) { write_abaqus(*f[0], m); }},
     {{".bdf"}, [](Sinks f, const NamedMesh& m) { write_nastran(*f[0], m); }},
     {{".node", ".ele", ".face"},
      [](Sinks f, const NamedMesh& m) { write_tetgen(*f[0], *f[1], *f[2], m.mesh); },
      kLacksNames},
     {{".tet"},
      [](Sinks f, const NamedMesh& m) { write_tet(*f[0], m.mesh); },
      kLacksRegions | kLacksLabels},
     kBoundaryFormats[0],
     kBoundaryFormats[1],
     kBoundaryFormats[2]}};

// Those of kFormats that hold elements of second order.
constexpr std::array<std::string_view, 6> kSecondOrder = {".mesh", ".msh", ".vtu",
                                                          ".vtk",  ".inp", ".bdf"};

WriteStatus write_second_order(OutputSet& outputs, const std::string& path, NamedMesh named) {
  if (const std::string error = second_order_error(path); !error.empty()) return {error};
  const EdgeNodes edge_nodes(named.mesh);
  named.edge_nodes = &edge_nodes;
  if (named.nodes() > kMostNodes) return {path + ": too many nodes for --order 2"};
  return write_by_extension(kFormats, outputs, path, named, contents(named));
}

}  // namespace

std::string second_order_error(const std::string& path) {
  const FileFormat<NamedMesh>* format = format_of(kFormats, path);
  if (format == nullptr ||
      std::count(kSecondOrder.begin(), kSecondOrder.end(), format->extensions[0]) > 0) {
    return {};
  }
  std::string known;
  for (const std::string_view extension : kSecondOrder) known += " " + std::string(extension);
  return path + ": no elements of second order are written in this format, but in" + known;
}

std::string mesh_extensions() {
  return extensions_of(kFormats);
}

std::string boundary_extensions() {
  return extensions_of(kBoundaryFormats);
}

std::vector<std::string> boundary_files_of(const std::string& path) {
  return files_made(kBoundaryFormats, path);
}

std::vector<std::string> mesh_files_of(const std::string& path) {
  return files_made(kFormats, path);
}

WriteStatus write_mesh(OutputSet& outputs, const std::string& path, const TetMesh& mesh,
                       const LabelNames& names, const WriteOptions& options) {
  const char* reason = mesh_files_of(path).empty() ? nullptr : inconsistency(mesh);
  if (reason != nullptr) return {path + ": inconsistent mesh: " + reason};
  if (options.order != 1 && options.order != 2) return {path + ": the order is neither 1 nor 2"};
  const LabelNames distinct = distinct_names(names);
  const NamedMesh named{
      mesh, distinct, nullptr, options.ascii, distinct_names(options.region_names), options.msh};
  return options.order == 2 ? write_second_order(outputs, path, named)
                            : write_by_extension(kFormats, outputs, path, named, contents(named));
}

WriteStatus write_surface(OutputSet& outputs, const std::string& path, const Surface& surface,
                          const LabelNames& names) {
  TetMesh boundary;
  boundary.vertices = surface.vertices;
  boundary.boundary = surface.triangles;
  boundary.boundary_labels = surface.labels;
  boundary.boundary_labels.resize(surface.triangles.size());
  boundary.boundary_facets.resize(surface.triangles.size());
  if (const char* reason = inconsistency(boundary)) return {path + ": " + reason};
  const LabelNames distinct = distinct_names(names);
  const NamedMesh named{boundary, distinct};
  return write_by_extension(kBoundaryFormats, outputs, path, named, contents(named));
}

WriteStatus write_off(OutputSet& outputs, const std::string& path, const Surface& surface) {
  WriteStatus status;
  TextSink* out = outputs.open(path, status);
  if (out == nullptr) return status;
  out->text("OFF\n");
  out->integers(surface.vertices.size(), surface.triangles.size());
  out->text("0\n");
  for (const auto& v : surface.vertices) {
    out->point(v);
    out->text("\n");
  }
  for (const auto& [a, b, c] : surface.triangles) {
    out->text("3 ");
    out->integers(a, b);
    out->integer(c);
    out->text("\n");
  }
  return status;
}

}  // namespace delmesher::io
