// Parts of the reader of tetrahedral meshes; see formats.md. read_mesh() is public.
#pragma once

#include <string>
#include <string_view>

#include "mesher/delmesher_files.h"
#include "mesher/io/mesh_reading.h"

namespace delmesher::io {

// ".mesh, .msh, ... or .tet".
std::string read_mesh_extensions();

// The files that reading `path` opens: itself, or .node, .ele and .face that stand together.
std::vector<std::string> mesh_files_read(const std::string& path);

// read_mesh() of a file's bytes; `path` gives the format, by its extension, and the name for
// messages. `beside`: gives TetGen's other files.
MeshReadResult parse_mesh(std::string_view bytes, const std::string& path,
                          const FileBeside& beside = nullptr,
                          const std::function<bool()>& go_on = {});

}  // namespace delmesher::io
