// What a closed surface encloses whose edges may belong to more than two triangles.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mesher/delmesher/surface.h"

namespace delmesher::surface {

struct Enclosed {
  // Parts of space that triangles keep from the outside; not those that only fronts of triangles
  // look into: they are cavities.
  std::uint64_t parts = 0;
  std::vector<std::uint32_t> walls;  // triangles that have such parts on both sides
  bool closes = true;                // every edge belongs to an even number of triangles
  std::uint64_t sheets = 0;          // of the walls, what is connected without going round a corner
};

// Around each edge the triangles are put in the order of their angles, in doubles: for a hint, no
// more. Nullopt if an edge belongs to one triangle alone: it has no two sides. Triangles have to
// refer to vertices, and to three different ones.
std::optional<Enclosed> enclosed_by(const Surface& surface);

}  // namespace delmesher::surface
