// Where a vertex may go.
#pragma once

#include <cstdint>

namespace delmesher::tetmesh {

enum class Mobility : std::uint8_t {
  fixed,     // nowhere: a vertex of the input or of the hull, or on an edge with
             // two parameters
  on_line,   // along its edge of the input
  in_plane,  // within its facet
  free       // anywhere in its star
};

}  // namespace delmesher::tetmesh
