// The defects of a surface, as a coloured surface.
#pragma once

#include <cstdint>
#include <string>

#include "mesher/delmesher_plane.h"

namespace delmesher::cli {

// The surface as a PLY whose triangles are coloured: red self-intersections, orange open edges,
// violet edges and vertices that are not manifold, blue orientation, green without area or double,
// grey nothing. All triangles at wrong edges are coloured; of other kinds only the triangles that
// the report lists.
std::string coloured_ply(const Surface& surface, const SurfaceReport& report);
// The same as .vtu: a number for the kind of defect at each triangle, 0 where there is none, and
// the labels of the surface. Then lines: open edges, those that are not manifold, and those where
// orientations disagree.
std::string defects_vtu(const Surface& surface, const SurfaceReport& report);
// The segments of a graph as .vtu, with a number for the kind of defect, 0 where there is none.
std::string graph_defects_vtu(const PlanarGraph& graph, const GraphReport& report);
// By the extension of a path.
enum class DefectsFormat : std::uint8_t { none, ply, vtu };
DefectsFormat defects_format(const std::string& path);

}  // namespace delmesher::cli
