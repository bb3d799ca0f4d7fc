// The contents of a Gmsh file (.msh, 4.1 as bytes or text, and 2.2 as text), of a mesh in space or
// in the plane.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "oracles/base/simplex.h"

namespace tetproof::oracles {

struct GmshElement {
  // Gmsh's number: 15 a point, 1 a line, 2 a triangle, 4 a tetrahedron; of second order 8 a line, 9
  // a triangle, 11 a tetrahedron.
  int type = 0;
  std::int64_t entity = 0;  // its tag
  std::int64_t group = 0;   // its first physical tag; of an entity without one, its own
  bool in_group = true;
  // As many as it has, by their place among the file's nodes; as Gmsh orders them: the corners,
  // then those on the edges 01 12 02, of a tetrahedron also 03 23 13.
  std::array<Index, 10> nodes{};
};

struct GmshText {
  double version = 0;
  std::vector<Position> nodes;
  // Names of physical groups, by dimension and tag; without quotation marks.
  std::map<std::pair<int, std::int64_t>, std::string> names;
  double planar_within = 0;  // the number of "PlanarWithin X" in $Comments
  // The box of some surface or volume is not the smallest one of its elements' corners. Delmesher
  // writes no such file of a mesh in space.
  bool boxes_differ = false;
  // An element's entity is in no physical group, so that programs leave the element out or take the
  // entity for a group, or in several. Delmesher writes no such file.
  bool groups_differ = false;
  // A tag is that of groups of two dimensions, which programs that number all groups together take
  // for one. Delmesher writes no such file.
  bool tags_shared = false;
};

// Calls `take` with the elements in their order. The sections that matter are there once, with the
// numbers of things and the ends that they announce; sections of other names are skipped. Throws
// ReadError.
GmshText read_gmsh_text(const std::string& path,
                        const std::function<void(const GmshElement&)>& take);

}  // namespace tetproof::oracles
