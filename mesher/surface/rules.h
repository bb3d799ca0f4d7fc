// What a set of triangles has to be.
#pragma once

#include <cstdint>

namespace delmesher::surface {

enum class Rules : std::uint8_t {
  solid,   // closed, 2-manifold, consistently oriented: it bounds a solid
  complex  // any set of triangles that meet in common vertices and edges alone
};

}  // namespace delmesher::surface
