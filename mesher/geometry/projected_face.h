// A face with several corners, seen along a coordinate axis.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace delmesher::geometry {

using Point2 = std::array<double, 2>;
using Point3 = std::array<double, 3>;
using Loop = std::vector<std::uint32_t>;  // corners, by their numbers

// Twice the polygon's area vector, in doubles, summed from its first corner.
Point3 doubled_area(const std::vector<Point3>& vertices, std::span<const std::uint32_t> loop);

// The coordinate axis along which the polygon's area vector, in doubles, has its largest component.
// formats.md promises this axis: which solid a face that is not planar means depends on it.
int dominating_axis(const std::vector<Point3>& vertices, std::span<const std::uint32_t> loop);

// The point without its coordinate along `axis`, the other two in cyclic order.
Point2 project(const Point3& p, int axis);

// Whether q is strictly inside the projected loop; exact (points on the boundary count as outside).
bool strictly_inside(const std::vector<Point3>& vertices, std::span<const std::uint32_t> loop,
                     int axis, const Point2& q);

// A face projected along one axis. Invariants, if `oriented`: the outer loop is counter-clockwise
// and every hole clockwise, by exact signs at their lexicographically smallest corners. Coordinates
// are those of the vertices, not rounded.
struct ProjectedFace {
  std::vector<std::uint32_t> vertex;  // of the surface, ascending, each once
  std::vector<Point2> points;         // of these
  std::vector<Loop> loops;            // indices of points; the outer one first
  bool mirrored = false;              // the outer loop was turned round
  bool oriented = true;               // every loop has an orientation
};

// loops[0] is the outer one.
ProjectedFace project_face(const std::vector<Point3>& vertices, std::span<const Loop> loops,
                           int axis);

// In doubles.
double squared_distance(const Point2& a, const Point2& b);

}  // namespace delmesher::geometry
