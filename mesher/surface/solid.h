// Exact questions about the solid bounded by a valid surface: is a tetrahedron inside, outside or
// cut?
#pragma once

#include <array>
#include <memory>
#include <span>

#include "mesher/geometry/box_tree.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/topology.h"

namespace delmesher::surface {

enum class Side : std::uint8_t { outside, inside, straddling };

// Bounding-volume hierarchy over the input triangles with exact queries. One object per thread.
class Solid {
 public:
  // `open`: if not empty, only triangles that meet one of these boxes are looked at to tell whether
  // a tetrahedron is cut: the caller knows that no other triangle meets the interior of any that it
  // asks about.
  Solid(const SurfaceTopology& topology, Predicates& predicates, std::span<const Box> open = {});
  // The same solid for another thread, with its own predicates on the same points.
  Solid(const Solid& other, Predicates& predicates);
  Solid(const Solid&) = delete;
  Solid& operator=(const Solid&) = delete;
  ~Solid();

  // Side of the open tetrahedron abcd (orient3d > 0; any point kinds): outside or inside if no
  // input triangle meets its interior (touching is fine), else straddling. Exact.
  Side classify(const std::array<VertexId, 4>& tetrahedron);
  // The same in two parts, for those who know the side of a neighbour.
  struct Cut {
    bool straddles = false;
    unsigned faces = 0;  // bit i: the face opposite corner i may be part of a triangle looked at
  };
  Cut cut(const std::array<VertexId, 4>& tetrahedron);
  bool is_inside(const std::array<VertexId, 4>& tetrahedron);  // of one that does not straddle

 private:
  struct Shared;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace delmesher::surface
