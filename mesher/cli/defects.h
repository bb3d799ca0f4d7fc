// What is wrong with a surface, and where.
#pragma once

#include <string>
#include <vector>

#include "mesher/delmesher.h"

namespace delmesher::cli {

// "18 defects of 2 kinds (12 open edges, 6 self-intersections)"; with one kind "12 open edges".
std::string defects_line(const SurfaceReport& report);

// What would mend it or may be the matter, a line each; empty if nothing is known.
std::vector<std::string> advice(const Surface& surface, const SurfaceReport& report);

// The surface as a PLY whose triangles are coloured: red self-intersections, orange open edges,
// violet edges and vertices that are not manifold, blue orientation, green without area or double,
// grey nothing. All triangles at edges that are open or not manifold; of other kinds those that the
// report lists.
std::string coloured_ply(const Surface& surface, const SurfaceReport& report);

}  // namespace delmesher::cli
