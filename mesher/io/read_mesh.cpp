#include "mesher/io/read_mesh.h"

#include <algorithm>

#include "mesher/io/file_formats.h"
#include "mesher/io/foreign_content.h"

namespace delmesher::io {
namespace {

// A format, which the extension of a path tells.
struct MeshFormat {
  std::array<std::string_view, 1> extensions;
  const char* name;
  // `beside` gives TetGen's other files.
  void (*read)(std::string_view bytes, const std::string& path, const FileBeside& beside,
               Polling& polling, MeshBuilder& builder);
};

// The reader of a format that has one file.
template <void (*read)(std::string_view, const std::string&, Polling&, MeshBuilder&)>
void alone(std::string_view bytes, const std::string& path, const FileBeside& /*beside*/,
           Polling& polling, MeshBuilder& builder) {
  read(bytes, path, polling, builder);
}

constexpr std::array<MeshFormat, 6> kFormats = {{{{".mesh"}, "MEDIT", alone<read_medit>},
                                                 {{".msh"}, "Gmsh", alone<read_gmsh>},
                                                 {{".vtu"}, "VTU", alone<read_vtu>},
                                                 {{".node"}, "TetGen", read_tetgen_mesh},
                                                 {{".ele"}, "TetGen", read_tetgen_mesh},
                                                 {{".tet"}, "tet", alone<read_tet>}}};

// The format of standard input, by its first bytes; null if it is none of these.
const MeshFormat* format_of_content(std::string_view bytes) {
  TextLines lines(bytes, Comments::at_token_start);
  std::string_view first, second;
  lines.next_token_anywhere(first);
  lines.next_token_anywhere(second);
  const char* const name = first == "MeshVersionFormatted" ? "MEDIT"
                           : first.starts_with("$")        ? "Gmsh"
                           : first.starts_with("<")        ? "VTU"
                           : second == "vertices"          ? "tet"
                                                           : "";
  const MeshFormat* const end = kFormats.data() + kFormats.size();
  const MeshFormat* const found = std::find_if(
      kFormats.data(), end, [&](const MeshFormat& f) { return f.name == std::string(name); });
  return found == end ? nullptr : found;
}

void parse(std::string_view bytes, const std::string& path, const FileBeside& beside,
           const std::function<bool()>& go_on, MeshReadResult& result) {
  const MeshFormat* format = format_of(kFormats, without_gz(path));
  if (format == nullptr && is_standard_stream(path)) format = format_of_content(bytes);
  if (format == nullptr) {
    throw FileError{path + ": not a known mesh format (" + read_mesh_extensions() + ")"};
  }
  if (bytes.empty()) throw FileError{path + ": the file is empty"};
  if (const std::string_view foreign = foreign_content(bytes); !foreign.empty()) {
    throw FileError{path + ": " + std::string(foreign)};
  }
  result.format = format->name;
  MeshBuilder builder;
  Polling polling(go_on);
  format->read(bytes, path, beside, polling, builder);
  if (builder.tetrahedra() == 0) throw FileError{path + ": no tetrahedra"};
  result.mesh = builder.finish();
  result.names = builder.names();
  if (!result.mesh.regions.empty()) result.region_names = builder.region_names();
  result.order = builder.order();
  result.warnings = builder.warnings();
}

}  // namespace

std::string read_mesh_extensions() {
  return extensions_of(kFormats);
}

std::vector<std::string> mesh_files_read(const std::string& path) {
  const MeshFormat* format = format_of(kFormats, without_gz(path));
  if (format == nullptr || format->read != read_tetgen_mesh) return {path};
  return {file_beside(path, ".node"), file_beside(path, ".ele"), file_beside(path, ".face")};
}

MeshReadResult parse_mesh(std::string_view bytes, const std::string& path, const FileBeside& beside,
                          const std::function<bool()>& go_on) {
  return caught<MeshReadResult>(
      path, [&](MeshReadResult& result) { parse(bytes, path, beside, go_on, result); });
}

MeshReadResult read_mesh(const std::string& path, const std::function<bool()>& go_on) {
  return caught<MeshReadResult>(path, [&](MeshReadResult& result) {
    // An .ele stands for the .node beside it.
    const MeshFormat* format = format_of(kFormats, without_gz(path));
    const bool is_ele = format != nullptr && format->extensions[0] == ".ele";
    const std::string first = is_ele ? file_beside(path, ".node") : path;
    const std::string bytes = read_file(first, go_on);
    const FileBeside beside = [&](const char* extension) {
      return read_beside(path, extension, go_on);
    };
    parse(bytes, first, beside, go_on, result);
  });
}

}  // namespace delmesher::io
