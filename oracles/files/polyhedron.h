// The triangles of a surface file.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "oracles/base/exact_points.h"
#include "oracles/files/set_names.h"

namespace tetproof::oracles {

// Faces of more corners are cut (polygon.h); those that cannot be are
// fans, each of one `polygon`.
struct Polyhedron {
  std::vector<Position> vertices;
  std::vector<std::array<Index, 3>> triangles;
  std::vector<std::int32_t> labels;  // per triangle; empty: all 0
  std::vector<Index> polygons;       // per triangle; empty: all different
  bool names_read = false;           // of a format whose names of labels are read: STL, OBJ
  SetNames names = {};
};

}  // namespace tetproof::oracles
