// Writes triangulations of the plane; the formats are described in formats.md.
#pragma once

#include <string>
#include <vector>

#include "mesher/io/output.h"

namespace delmesher::io {

// The extensions that write_plane() knows, in any case: ".node, .vtu, ... or .svg".
std::string plane_extensions();

// The files that writing to `path` makes: itself, and .ele and .poly beside a .node. Empty if its
// extension means no format.
std::vector<std::string> plane_files_of(const std::string& path);

// Adds the mesh to a set of outputs; nothing is in place before its commit(). The holes and regions
// of `graph`, if any, go into a .poly, so that it means the same as the input. The elements are of
// first order whatever the options say.
WriteStatus write_plane(OutputSet& outputs, const std::string& path, const PlaneMesh& mesh,
                        const PlanarGraph* graph = nullptr, const WriteOptions& options = {});

// A .poly file (Shewchuk's Triangle).
WriteStatus write_poly(OutputSet& outputs, const std::string& path, const PlanarGraph& graph);

// The extensions that write_graph() knows.
inline constexpr const char* kGraphExtensions = ".poly or .txt";
bool is_graph_file(const std::string& path);
// A graph as it was read: .poly, or of rings .txt, where each segment is a ring of two points, and
// one that only divides is there twice.
WriteStatus write_graph(OutputSet& outputs, const std::string& path, const PlanarGraph& graph);

// The sidecar of --exact in the plane; exact_format.md has the grammar.
WriteStatus write_plane_exact(OutputSet& outputs, const std::string& path,
                              const PlaneRecord& record);

}  // namespace delmesher::io
