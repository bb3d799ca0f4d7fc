// A triangle of a mesh that lies on the surface.
#pragma once

#include <array>

#include "mesher/base/ids.h"

namespace delmesher::surface {

struct SurfaceFace {
  std::array<VertexId, 3> vertices;  // counter-clockwise seen from outside the solid
  FacetId facet;
};

}  // namespace delmesher::surface
