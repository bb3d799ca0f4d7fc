// The text of a Gmsh file (.msh, 4.1 and 2.2), of a mesh in space or in the plane.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "oracles/tet_complex.h"

namespace tetproof::oracles {

struct GmshElement {
  int type = 0;             // Gmsh's number: 15 a point, 1 a line, 2 a triangle, 4 a tetrahedron
  std::int64_t entity = 0;  // its tag
  std::int64_t group = 0;   // its first physical tag; of an entity without one, its own
  std::array<Index, 4> nodes{};  // as many as it has, in the order of the file's nodes
};

struct GmshText {
  double version = 0;
  std::vector<Position> nodes;
  // Of physical groups, by dimension and tag; without quotation marks.
  std::map<std::pair<int, std::int64_t>, std::string> names;
};

// Calls `take` with the elements in their order. The sections that matter are there once, with the
// numbers of things and the ends that they announce; sections of other names are skipped. Throws
// ReadError.
GmshText read_gmsh_text(const std::string& path,
                        const std::function<void(const GmshElement&)>& take);

}  // namespace tetproof::oracles
