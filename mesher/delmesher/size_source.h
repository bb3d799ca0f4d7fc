// Sizes of elements from place to place.
#pragma once

#include <array>

namespace delmesher {

// Edges through this point are no longer than `size`, and with the distance they may grow.
struct SizeSource {
  std::array<double, 3> point;
  double size;
};

}  // namespace delmesher
