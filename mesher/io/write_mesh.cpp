#include "mesher/io/write_mesh.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "mesher/io/text.h"
#include "mesher/io/write_formats.h"

namespace delmesher::io {
namespace {

// What the writers rely on; a violation is a bug of the caller, but no reason to crash.
const char* inconsistency(const TetMesh& mesh) {
  const auto in_range = [&](const auto& cells) {
    return std::all_of(cells.begin(), cells.end(), [&](const auto& cell) {
      return std::all_of(cell.begin(), cell.end(),
                         [&](std::uint32_t v) { return v < mesh.vertices.size(); });
    });
  };
  if (mesh.inside.size() != mesh.tetrahedra.size()) return "inside flags do not match";
  if (mesh.boundary_labels.size() != mesh.boundary.size()) return "labels do not match";
  if (mesh.boundary_facets.size() != mesh.boundary.size()) return "facets do not match";
  if (!in_range(mesh.tetrahedra) || !in_range(mesh.boundary)) return "a vertex is out of range";
  return nullptr;
}

std::string with_extension(const std::string& path, const char* extension) {
  return std::filesystem::path(path).replace_extension(extension).string();
}

}  // namespace

std::optional<MeshFormat> mesh_format_of(const std::string& path) {
  static constexpr std::string_view kExtensions[] = {".mesh", ".msh", ".vtu", ".node", ".tet"};
  const std::string extension = std::filesystem::path(path).extension().string();
  for (std::size_t i = 0; i < std::size(kExtensions); ++i) {
    if (equal_ignoring_case(extension, kExtensions[i])) return static_cast<MeshFormat>(i);
  }
  return std::nullopt;
}

std::vector<std::string> files_of(const std::string& path) {
  if (mesh_format_of(path) != MeshFormat::tetgen) return {path};
  return {path, with_extension(path, ".ele"), with_extension(path, ".face")};
}

WriteStatus write_mesh(OutputSet& outputs, const std::string& path, const TetMesh& mesh) {
  WriteStatus status;
  const auto format = mesh_format_of(path);
  if (!format) return {path + ": unknown mesh format (.mesh, .msh, .vtu, .node or .tet)"};
  if (const char* reason = inconsistency(mesh)) return {path + ": inconsistent mesh: " + reason};
  std::vector<TextSink*> sinks;
  for (const std::string& file : files_of(path)) {
    sinks.push_back(outputs.open(file, status));
    if (!status.ok()) return status;
  }
  switch (*format) {
    case MeshFormat::medit:
      write_medit(*sinks[0], mesh);
      break;
    case MeshFormat::gmsh:
      write_gmsh(*sinks[0], mesh);
      break;
    case MeshFormat::vtu:
      write_vtu(*sinks[0], mesh);
      break;
    case MeshFormat::tetgen:
      write_tetgen(*sinks[0], *sinks[1], *sinks[2], mesh);
      break;
    case MeshFormat::tet:
      write_tet(*sinks[0], mesh);
      break;
  }
  return status;
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
