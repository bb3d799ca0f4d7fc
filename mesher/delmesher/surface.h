// The input of the mesher: a triangulated surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace delmesher {

// A triangulated surface. Coordinates are taken as exact numbers.
struct Surface {
  std::vector<std::array<double, 3>> vertices;  // those of no triangle are vertices of its mesh
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
  std::vector<std::int32_t> labels;  // one per triangle; empty means that all are 0
};

}  // namespace delmesher
