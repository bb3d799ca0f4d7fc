// Writes tetrahedral meshes and surfaces; the formats are described in formats.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesher/io/output.h"

namespace delmesher::io {

enum class MeshFormat : std::uint8_t { medit, gmsh, vtu, tetgen, tet };

// By the extension: .mesh, .msh, .vtu, .node, .tet (in any case).
std::optional<MeshFormat> mesh_format_of(const std::string& path);

// The files that writing to `path` makes: itself, and .ele and .face beside a .node.
std::vector<std::string> files_of(const std::string& path);

// Adds the mesh to a set of outputs; nothing is in place before its commit().
WriteStatus write_mesh(OutputSet& outputs, const std::string& path, const TetMesh& mesh);

// OFF; labels are not kept, as the format has none.
WriteStatus write_off(OutputSet& outputs, const std::string& path, const Surface& surface);

}  // namespace delmesher::io
