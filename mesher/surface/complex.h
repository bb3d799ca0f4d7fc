// Complexes of triangles: several closed surfaces that share walls, and open ones.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "mesher/delmesher/surface.h"

namespace delmesher::surface {

// A surface without repetitions of triangles. A wall between two bodies is often given twice, once
// for each.
struct MergedSurface {
  Surface surface;
  std::vector<std::uint32_t> given;  // per triangle: the first one given with these vertices
  // Labels of the other ones, with the triangle; ascending.
  std::vector<std::pair<std::uint32_t, std::int32_t>> further_labels;

  // All labels of a triangle, ascending.
  std::vector<std::int32_t> labels_of(std::uint32_t triangle) const;
};

// Triangles are the same if their vertices are, in any order. Every triangle has to have three
// different ones that exist; others are left as they are.
MergedSurface merge_repeated(const Surface& given);

}  // namespace delmesher::surface
