// Lengths and angles of triangles, in doubles: nothing here decides topology.
#pragma once

#include <array>

#include "mesher/predicates/points.h"

namespace delmesher::plane {

struct Shape {
  double sine_squared;  // of the smallest angle; 0 if it is flat or worse
  double shortest_squared, longest_squared;
  int apex;             // corner opposite the shortest edge: that of the smallest angle
  double circumcentre;  // its distance from the shortest edge, over the length of that edge

  // The point that far above the middle of the shortest edge, in those units, on a grid that is
  // fine for that edge.
  Vec3 place(const PointStore& points, const std::array<VertexId, 3>& corner, double height) const;
};

Shape shape_of(const PointStore& points, VertexId a, VertexId b, VertexId c);

}  // namespace delmesher::plane
