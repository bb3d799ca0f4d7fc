// The triangles of a surface file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "oracles/base/exact_points.h"
#include "oracles/files/set_names.h"

namespace tetproof::oracles {

// A point of the region that it tells of: TetGen's .poly and .smesh have them.
struct RegionPoint {
  Position point;
  std::string name = {};  // its attribute; empty: none
  double volume = 0;      // of the largest tetrahedron; 0: any
  bool is_hole = false;
};

// Faces of more corners are cut (polygon.h); those that cannot be are
// fans, each of one `polygon`.
struct Polyhedron {
  std::vector<Position> vertices;
  std::vector<std::array<Index, 3>> triangles;
  std::vector<std::int32_t> labels;  // per triangle; empty: all 0
  std::vector<Index> polygons;       // per triangle; empty: all different
  bool names_read = false;           // of a format whose names of labels are read: STL, OBJ
  SetNames names = {};
  std::vector<RegionPoint> region_points = {};
};

}  // namespace tetproof::oracles
