// Orientation of the components of a closed surface: exact signs of their volumes, and how deep
// they are nested.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/geometry/box_tree.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/half_edges.h"

namespace delmesher::surface {

struct ComponentNesting {
  int volume_sign = 0;      // +1: its triangles are oriented away from the bounded side
  double volume = 0;        // absolute value, rounded
  std::uint32_t depth = 0;  // number of other components around it
};

// For a valid surface: closed, manifold, consistently oriented, not self-intersecting.
// component_of numbers the components of the triangles from 0; tree holds the triangles' boxes.
std::vector<ComponentNesting> analyze_nesting(const Triangles& triangles,
                                              const std::vector<std::uint32_t>& component_of,
                                              std::size_t components, Predicates& predicates,
                                              const BoxTree& tree, Control& control);

}  // namespace delmesher::surface
