// The defects of a surface: in a line, with advice, and as a coloured surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesher/delmesher.h"

namespace delmesher::cli {

// "18 defects of 2 kinds (12 open edges, 6 self-intersections)"; with one kind "12 open edges".
std::string defects_line(const SurfaceReport& report);

// What bodies or walls that meet are, and what to do about it.
struct Contact {
  std::string what, advice;
};
std::vector<Contact> contacts(const Surface& surface, const SurfaceReport& report);

// Remedies or likely causes, a line each; empty if none is known.
std::vector<std::string> advice(const Surface& surface, const SurfaceReport& report);

// The surface as a PLY whose triangles are coloured: red self-intersections, orange open edges,
// violet edges and vertices that are not manifold, blue orientation, green without area or double,
// grey nothing. All triangles at wrong edges are coloured; of other kinds only the triangles that
// the report lists.
std::string coloured_ply(const Surface& surface, const SurfaceReport& report);
// The same as .vtu: a number for the kind of defect at each triangle, 0 where there is none. Then
// lines: open edges, those that are not manifold, and those where orientations disagree.
std::string defects_vtu(const Surface& surface, const SurfaceReport& report);
// By the extension of a path.
enum class DefectsFormat : std::uint8_t { none, ply, vtu };
DefectsFormat defects_format(const std::string& path);

}  // namespace delmesher::cli
