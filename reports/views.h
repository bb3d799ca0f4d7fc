// The contents of the 3D view of a report: input surfaces, chamfered surfaces and meshes of some
// models, packed for the page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/selection.h"

namespace tetproof {

struct ViewOptions {
  std::size_t models = 10;           // at most this many models have pictures
  std::uint64_t tetrahedra = 60000;  // larger meshes are left out
  std::uint64_t bytes = 16u << 20;   // of all parts together, as text
  std::vector<std::string> wanted;   // names of models to begin with
};

// One object of the view. Coordinates are relative to the model's box and fit into [-1, 1].
struct ViewPart {
  std::size_t model = 0;  // index into Selection::models
  std::string label;      // "input", "chamfered, MESHER", or the mesher
  bool mesh = false;      // tetrahedra; else triangles
  bool hull = false;      // meshes the outside too
  bool ours = false;      // by delmesher, whatever the mesher is called here
  std::vector<float> vertices;
  std::vector<std::uint32_t> cells;   // 4 or 3 corners each
  std::vector<std::uint8_t> quality;  // per tetrahedron: 4 times its smallest face angle, degrees
  std::vector<std::uint8_t> inside;   // per tetrahedron; empty if the file does not tell
};

// For every model first the input and the mesh that the page opens on, which is ours if one was
// kept; then the other meshes as far as there is room. Reads kept meshes (RunRow::mesh_path), the
// chamfered surfaces beside them and the models. Files that are gone or cannot be read are left
// out, and named in `notes`.
std::vector<ViewPart> collect_views(const Selection& selection, const ViewOptions& options,
                                    std::vector<std::string>& notes);

// As page/view.js unpacks it: little-endian arrays in base64.
std::string to_json(const ViewPart& part);

std::string base64(const void* data, std::size_t size);

}  // namespace tetproof
