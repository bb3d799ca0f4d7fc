// The angles and the shape of one tetrahedron, as robustly as floating point allows (Shewchuk
// 2013).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "mesher/geometry/vector.h"

namespace delmesher::output {

// The vertices of its edges and faces. Face i is opposite vertex i, seen counter-clockwise from
// outside.
inline constexpr int kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
inline constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

struct Shape {
  std::array<Vec3, 6> edge;  // in the order of kEdges, from the first to the second vertex
  std::array<double, 6> squared_length;
  bool comparable;  // common scale, and products of four lengths are in range
};

// Edge vectors at a common power-of-two scale: half of what they are or, if the longest is extreme,
// with the longest around 1. If their lengths are not comparable, each at a scale of its own.
Shape make_shape(std::span<const Vec3> coordinates,
                 const std::array<std::uint32_t, 4>& tetrahedron);

// Six times the volume at the scale of the shape, negative if the tetrahedron is inverted.
double volume_term(const Shape& shape);

// In degrees, at the corners of a face in the order of kFaces; and at the edges.
std::array<double, 3> face_angles(const Shape& shape, int face);
std::array<double, 6> dihedral_angles(const Shape& shape);

// As in MeshStatistics.
struct Quality {
  double gamma = 0, sicn = 0;
};
Quality quality(const Shape& shape);

}  // namespace delmesher::output
