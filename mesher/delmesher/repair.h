// Repairs of a surface that need no guess.
#pragma once

#include <string>
#include <vector>

#include "options.h"
#include "surface.h"
#include "surface_report.h"

namespace delmesher {

struct RepairResult {
  Surface surface;
  std::vector<std::string> done;  // the changes, a line each: "12 vertices welded ..."
};

// Makes the repairs that need no guess: welds vertices, removes triangles without area (exactly)
// and duplicates, turns triangles round so that neighbours agree, fills holes if asked, and drops
// vertices of no triangle. Nothing else is moved or added. check_surface() decides whether the
// result is valid.
RepairResult repair_surface(const Surface& surface, const RepairOptions& options = {});

// What to do about the defects that check_surface() found, or likely causes, a line each; commands
// are in backticks. Empty if nothing is known.
std::vector<std::string> surface_hints(const Surface& surface, const SurfaceReport& report);

}  // namespace delmesher
