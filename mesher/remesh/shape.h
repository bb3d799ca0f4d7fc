// Shapes of triangles, and where vertices of few triangles should be. In doubles: it steers, and
// decides nothing that is promised.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "mesher/delmesher/surface.h"
#include "mesher/geometry/vector.h"
#include "mesher/remesh/triangle_mesh.h"

namespace delmesher::remesh {

using Corners = std::array<Vec3, 3>;

inline Vec3 normal_of(const Corners& t) {
  return cross(subtract(t[1], t[0]), subtract(t[2], t[0]));
}

// The sine of the smallest angle.
inline double least_sine(const Corners& t) {
  std::array<double, 3> side{};
  for (std::size_t i = 0; i < 3; ++i) {
    side[i] = squared_norm(subtract(t[(i + 1) % 3], t[i]));
  }
  std::ranges::sort(side);
  return side[1] > 0 ? norm(normal_of(t)) / std::sqrt(side[1] * side[2]) : 0;
}

// Above the longest side.
inline double least_height(const Corners& t) {
  const double longest =
      std::max({distance(t[0], t[1]), distance(t[1], t[2]), distance(t[2], t[0])});
  return longest > 0 ? norm(normal_of(t)) / longest : 0;
}

// The sum of squared distances from planes, weighted by areas (Garland and Heckbert 1997).
struct Quadric {
  std::array<double, 6> a{};  // xx, xy, xz, yy, yz, zz
  Vec3 b{};
  double c = 0, weight = 0;

  void add_plane(const Vec3& unit_normal, double offset, double area);
  void operator+=(const Quadric& other);
  double at(const Vec3& p) const;
  // Where it is least; where many places are about as good, the one near `middle`.
  Vec3 least(const Vec3& middle) const;
};

// Without the sign.
double largest_coordinate(const Surface& surface);

// An edge of a triangle, whose ends are in ascending order; turned: the triangle has them in the
// other one.
struct Side {
  VertexId a, b;
  std::uint32_t triangle;
  bool turned;

  bool is_beside(const Side& other) const { return a == other.a && b == other.b; }
};

// Of all triangles; those of an edge follow each other.
std::vector<Side> sides_of(std::span<const Triangle> triangles);

// The cosine of the bend between triangles with these normals that have a side in common.
inline double cosine_of_bend(const Vec3& m, bool m_is_turned, const Vec3& n, bool n_is_turned) {
  return (m_is_turned != n_is_turned ? 1 : -1) * dot(m, n) / (norm(m) * norm(n));
}

struct SurfaceLines {
  std::vector<Line> lines;
  // By line: it bends by more than the angle however its vertices move by half of the
  // tolerance. What low triangles bend by, whose direction says nothing, does not count.
  std::vector<std::uint8_t> counts;
};
// The edges that bend by more than `feature` degrees, borders of labels, and edges of other than
// two triangles.
SurfaceLines lines_of(const Surface& surface, double feature, double tolerance);

}  // namespace delmesher::remesh
