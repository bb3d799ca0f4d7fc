#include "mesher/io/read_mesh.h"

#include <filesystem>
#include <new>
#include <stdexcept>

#include "mesher/io/foreign_content.h"
#include "mesher/io/parse_surface.h"

namespace delmesher::io {
namespace {

struct MeshFormat {
  const char* extension;
  const char* name;
};
constexpr MeshFormat kFormats[] = {{".mesh", "MEDIT"},  {".msh", "Gmsh"},   {".vtu", "VTU"},
                                   {".node", "TetGen"}, {".ele", "TetGen"}, {".tet", "tet"}};

const MeshFormat* format_of(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  for (const MeshFormat& format : kFormats) {
    if (equal_ignoring_case(extension, format.extension)) return &format;
  }
  return nullptr;
}

void read(std::string_view bytes, const std::string& path, const std::string& format,
          const FileBeside& beside, Polling& polling, MeshBuilder& builder) {
  if (format == "MEDIT") return read_medit(bytes, path, polling, builder);
  if (format == "Gmsh") return read_gmsh(bytes, path, polling, builder);
  if (format == "VTU") return read_vtu(bytes, path, polling, builder);
  if (format == "TetGen") return read_tetgen_mesh(bytes, path, beside, polling, builder);
  read_tet(bytes, path, polling, builder);
}

// Calls `body`, which may throw whatever readers do.
template <class Body>
MeshReadResult caught(const std::string& path, const Body& body) {
  MeshReadResult result;
  const auto end = [&](ReadCode code, std::string error) {
    result = {};
    result.code = code;
    result.error = std::move(error);
  };
  try {
    body(result);
  } catch (const MeshError& error) {
    end(ReadCode::unreadable, error.text);
  } catch (const std::bad_alloc&) {
    end(ReadCode::out_of_memory, path + ": out of memory while reading");
  } catch (const std::length_error&) {
    end(ReadCode::out_of_memory, path + ": out of memory while reading");
  } catch (const ReadingStopped&) {
    end(ReadCode::stopped, path + ": stopped while reading");
  } catch (const std::exception& error) {
    end(ReadCode::unreadable, path + ": " + error.what());
  }
  return result;
}

void parse_into(MeshReadResult& result, std::string_view bytes, const std::string& path,
                const FileBeside& beside, const std::function<bool()>& go_on) {
  const MeshFormat* format = format_of(path);
  if (format == nullptr) {
    throw MeshError{path + ": not a known mesh format (" + read_mesh_extensions() + ")"};
  }
  if (const std::string_view foreign = foreign_content(bytes); !foreign.empty()) {
    throw MeshError{path + ": " + std::string(foreign)};
  }
  result.format = format->name;
  MeshBuilder builder;
  Polling polling(go_on);
  read(bytes, path, format->name, beside, polling, builder);
  if (builder.tetrahedra() == 0) throw MeshError{path + ": no tetrahedra"};
  result.mesh = builder.finish();
  result.names = builder.names();
}

}  // namespace

std::string read_mesh_extensions() {
  return ".mesh, .msh, .vtu, .node, .ele or .tet";
}

std::vector<std::string> mesh_files_read(const std::string& path) {
  const MeshFormat* format = format_of(path);
  if (format == nullptr || std::string_view(format->name) != "TetGen") return {path};
  return {name_beside(path, ".node"), name_beside(path, ".ele"), name_beside(path, ".face")};
}

MeshReadResult parse_mesh(std::string_view bytes, const std::string& path, const FileBeside& beside,
                          const std::function<bool()>& go_on) {
  return caught(path,
                [&](MeshReadResult& result) { parse_into(result, bytes, path, beside, go_on); });
}

MeshReadResult read_mesh(const std::string& path, const std::function<bool()>& go_on) {
  return caught(path, [&](MeshReadResult& result) {
    const bool is_ele =
        equal_ignoring_case(std::filesystem::path(path).extension().string(), ".ele");
    const std::string first = is_ele ? name_beside(path, ".node") : path;
    std::string error;
    const auto bytes = read_file(first, error, go_on);
    if (!bytes) throw MeshError{first + ": " + error};
    const FileBeside beside = [&](const char* extension) -> std::optional<std::string> {
      std::string reason;
      const std::string file = name_beside(path, extension);
      std::optional<std::string> text = read_file(file, reason, go_on);
      if (!text && std::filesystem::exists(file)) throw MeshError{file + ": " + reason};
      return text;
    };
    parse_into(result, *bytes, first, beside, go_on);
  });
}

}  // namespace delmesher::io
