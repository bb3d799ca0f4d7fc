// Writes tetrahedral meshes and surfaces; the formats are described in formats.md.
#pragma once

#include <string>
#include <vector>

#include "mesher/io/output.h"

namespace delmesher::io {

// The extensions that write_mesh() knows, in any case: ".mesh, .msh, ... or .tet".
std::string mesh_extensions();

// The files that writing to `path` makes: itself, and .ele and .face beside a .node. Empty if its
// extension means no format.
std::vector<std::string> mesh_files_of(const std::string& path);

// The extensions of the formats that hold the boundary alone, and so can hold a surface.
std::string boundary_extensions();
std::vector<std::string> boundary_files_of(const std::string& path);
// A surface in one of them, with its labels.
WriteStatus write_surface(OutputSet& outputs, const std::string& path, const Surface& surface,
                          const LabelNames& names = {});

// Adds the mesh to a set of outputs; nothing is in place before its commit().
WriteStatus write_mesh(OutputSet& outputs, const std::string& path, const TetMesh& mesh,
                       const LabelNames& names = {}, const WriteOptions& options = {});
// Why WriteOptions::order 2 cannot be written to the path; empty if it can.
std::string second_order_error(const std::string& path);

// OFF; labels are not kept, as the format has none.
WriteStatus write_off(OutputSet& outputs, const std::string& path, const Surface& surface);

}  // namespace delmesher::io
