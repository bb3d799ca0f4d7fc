// Sizes of elements from place to place.
#pragma once

#include <array>

namespace delmesher {

// Edges through this point are at most `size` long, and may grow with the distance from it.
struct SizeSource {
  std::array<double, 3> point;
  double size;
};

}  // namespace delmesher
