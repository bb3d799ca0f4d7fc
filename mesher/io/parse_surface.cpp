#include "mesher/io/parse_surface.h"

#include <filesystem>

#include "mesher/io/foreign_content.h"
#include "mesher/io/readers.h"

namespace delmesher::io {
namespace {

enum class Format : std::uint8_t { off, obj, stl, ply, smesh, poly, three_mf, unknown, foreign };

constexpr const char* kNames[] = {"OFF", "OBJ", "STL", "PLY", "smesh", "poly", "3MF", "", ""};

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

// Does the file begin like a mesh of Gmsh, MEDIT or VTK?
bool looks_like_mesh(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, 256);
  return head.starts_with("$MeshFormat") || head.starts_with("MeshVersionFormatted") ||
         head.starts_with("# vtk DataFile") || head.find("<VTKFile") != std::string_view::npos;
}

// Formats with a signature are known by it whatever the file is called; the others by name.
Format detect(std::string_view bytes, const std::string& path) {
  if (looks_like_ply(bytes)) return Format::ply;
  if (looks_like_off(bytes)) return Format::off;
  const std::string extension = lower_extension(path);
  if (looks_like_stl(bytes)) return Format::stl;
  if (looks_like_3mf(bytes) || extension == ".3mf") return Format::three_mf;
  if (!foreign_content(bytes).empty()) return Format::foreign;
  if (extension == ".off") return Format::off;
  if (extension == ".obj") return Format::obj;
  if (extension == ".stl") return Format::stl;
  if (extension == ".ply") return Format::ply;
  if (extension == ".smesh") return Format::smesh;
  if (extension == ".poly") return Format::poly;
  return looks_like_obj(bytes) ? Format::obj : Format::unknown;
}

void read(std::string_view bytes, Format format, const NodeFile& node_file,
          const ReadOptions& options, SurfaceBuilder& builder) {
  switch (format) {
    case Format::off:
      return read_off(bytes, builder);
    case Format::obj:
      builder.weld_seams();
      return read_obj(bytes, options.planar, builder);
    case Format::stl:
      return read_stl(bytes, builder);
    case Format::ply:
      builder.weld_seams();
      return read_ply(bytes, builder);
    case Format::smesh:
      return read_tetgen(bytes, TetgenKind::smesh, node_file, builder);
    case Format::poly:
      return read_tetgen(bytes, TetgenKind::poly, node_file, builder);
    case Format::three_mf: {
      Polling polling(options.go_on);
      return read_3mf(bytes, polling, builder);
    }
    case Format::foreign:
      fail({}, std::string(foreign_content(bytes)));
    case Format::unknown:
      break;
  }
  if (looks_like_mesh(bytes)) {
    fail({}, "a mesh, not a surface: if it is of tetrahedra, delmesher improve reads it");
  }
  fail({}, "not a known format (OFF, OBJ, STL, PLY, 3MF, .smesh, .poly)");
}

void parse(std::string_view bytes, const std::string& path, const NodeFile& node_file,
           const ReadOptions& options, ReadResult& result) {
  if (bytes.empty()) fail({}, "the file is empty");
  SurfaceBuilder builder(options.go_on);
  const Format format = detect(bytes, path);
  result.format = kNames[static_cast<std::size_t>(format)];
  read(bytes, format, node_file, options, builder);
  result.surface = builder.finish();
  result.lines = builder.lines();
  result.region_points = builder.region_points();
  result.warnings = builder.warnings();
  result.notes = builder.notes();
  result.names = builder.names();
}

}  // namespace

ReadResult parse_surface(std::string_view bytes, const std::string& path,
                         const ReadOptions& options) {
  return caught<ReadResult>(
      path, [&](ReadResult& result) { parse(bytes, path, nullptr, options, result); });
}

ReadResult read_surface(const std::string& path, const ReadOptions& options) {
  return caught<ReadResult>(path, [&](ReadResult& result) {
    const std::string bytes = read_file(path, options.go_on);
    parse(
        bytes, without_gz(path), [&] { return read_beside(path, ".node", options.go_on); }, options,
        result);
  });
}

}  // namespace delmesher::io
