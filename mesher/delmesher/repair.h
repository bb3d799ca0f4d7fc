// Repairs of a surface that need no guess.
#pragma once

#include <string>
#include <vector>

#include "surface.h"

namespace delmesher {

struct RepairOptions {
  // Vertices no farther apart than this become one, the first of them (input units). Equal ones do
  // in any case.
  double weld = 0;
  // Fill the holes that are planar within 1e-6 of the diagonal, or no wider than a twentieth of it.
  bool fill = false;
};

struct RepairResult {
  Surface surface;
  std::vector<std::string> done;  // the changes, a line each: "12 vertices welded ..."
};

// Makes the repairs that need no guess: welds vertices, removes triangles without area (exactly)
// and duplicates, turns triangles round so that neighbours agree, fills holes if asked, and drops
// vertices of no triangle. Nothing else is moved or added. check_surface() decides whether the
// result is valid.
RepairResult repair_surface(const Surface& surface, const RepairOptions& options = {});

}  // namespace delmesher
