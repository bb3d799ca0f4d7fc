// The defects of a surface: in a line, and what to do about them (surface_hints in
// mesher/delmesher/repair.h).
#pragma once

#include <string>
#include <vector>

#include "mesher/delmesher/repair.h"
#include "mesher/delmesher/surface_report.h"

namespace delmesher::surface {

// "18 defects of 2 kinds (12 open edges, 6 self-intersections)"; with one kind "12 open edges".
std::string defects_line(const SurfaceReport& report);

// What bodies or walls that meet are, and what to do about it.
struct Contact {
  std::string what, advice;
};
std::vector<Contact> contacts(const Surface& surface, const SurfaceReport& report);

}  // namespace delmesher::surface
