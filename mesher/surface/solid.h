// Exact questions about the solid bounded by a valid surface: is a tetrahedron inside, outside or
// cut?
#pragma once

#include <array>
#include <memory>
#include <span>

#include "mesher/predicates/predicates.h"
#include "mesher/surface/topology.h"

namespace delmesher {

enum class Side : std::uint8_t { outside, inside, straddling };

// Bounding-volume hierarchy over the input triangles with exact queries. Not thread-safe.
class Solid {
 public:
  Solid(const SurfaceTopology& topology, Predicates& predicates);
  ~Solid();

  // Side of the open tetrahedron abcd (orient3d > 0; any point kinds): outside or inside if no
  // input triangle meets its interior (touching is fine), else straddling. Exact.
  Side classify(const std::array<VertexId, 4>& tetrahedron);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace delmesher
