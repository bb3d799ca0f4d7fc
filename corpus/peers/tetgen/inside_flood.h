// Finds the tetrahedra of a mesh that are inside the surface whose triangles it contains.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tetproof {

// Floods from the boundary of the mesh inwards and changes side at every wall. A boundary face that
// is a wall has the inside behind it. The result is per tetrahedron, and empty if the walls do not
// separate inside from outside consistently.
std::vector<std::uint8_t> flood_inside(const std::vector<std::array<std::uint32_t, 4>>& tetrahedra,
                                       const std::vector<std::array<std::uint32_t, 3>>& walls);

}  // namespace tetproof
