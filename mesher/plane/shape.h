// Lengths and angles of triangles, in doubles: nothing here decides topology.
#pragma once

#include <array>
#include <cmath>

#include "mesher/predicates/points.h"

namespace delmesher::plane {

// Length of a vector between points of the store, also where its square vanishes.
inline double norm(double x, double y) {
  const double square = x * x + y * y;
  if (square > 0x1p-900) return std::sqrt(square);
  x *= 0x1p600;
  y *= 0x1p600;
  return std::sqrt(x * x + y * y) * 0x1p-600;
}

struct Shape {
  double sine_squared;  // of the smallest angle; 0 if it is flat or worse
  // Squared lengths of edges times `scale`, a power of two: 1 unless squares would vanish.
  double shortest_squared, longest_squared, scale;
  int sharpest;         // corner opposite the shortest edge: that of the smallest angle
  double circumcentre;  // its distance from the shortest edge, over the length of that edge

  // The point that far above the middle of the shortest edge, in those units, on a grid that is
  // fine for that edge.
  Vec3 place(const PointStore& points, const std::array<VertexId, 3>& corner, double height) const;
};

Shape shape_of(const PointStore& points, VertexId a, VertexId b, VertexId c);

}  // namespace delmesher::plane
