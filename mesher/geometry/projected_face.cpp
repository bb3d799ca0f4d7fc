#include "mesher/geometry/projected_face.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/sort_unique.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::geometry {
namespace {

// Orientation of a simple projected loop: at its lexicographically smallest corner, an extreme
// point, it turns the way it runs. 0 if the loop is not simple there.
int loop_orientation(const std::vector<Point2>& points, const Loop& loop) {
  std::size_t lowest = 0;
  for (std::size_t i = 1; i < loop.size(); ++i) {
    if (points[loop[i]] < points[loop[lowest]]) lowest = i;
  }
  const std::size_t n = loop.size();
  return orient2d_sign(points[loop[(lowest + n - 1) % n]], points[loop[lowest]],
                       points[loop[(lowest + 1) % n]]);
}

}  // namespace

Point2 project(const Point3& p, int axis) {
  const auto i = static_cast<std::size_t>(axis);
  return {p[(i + 1) % 3], p[(i + 2) % 3]};
}

Point3 doubled_area(const std::vector<Point3>& vertices, std::span<const std::uint32_t> loop) {
  Point3 sum = {0, 0, 0};
  const Point3& origin = vertices[loop[0]];
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    sum = add(sum,
              cross(subtract(vertices[loop[i]], origin), subtract(vertices[loop[i + 1]], origin)));
  }
  return sum;
}

int dominating_axis(const std::vector<Point3>& vertices, std::span<const std::uint32_t> loop) {
  const Point3 normal = doubled_area(vertices, loop);
  int axis = 0;  // of equals the first
  for (int k = 1; k < 3; ++k) {
    if (std::fabs(normal[static_cast<std::size_t>(k)]) >
        std::fabs(normal[static_cast<std::size_t>(axis)])) {
      axis = k;
    }
  }
  return axis;
}

bool strictly_inside(const std::vector<Point3>& vertices, std::span<const std::uint32_t> loop,
                     int axis, const Point2& q) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    Point2 a = project(vertices[loop[i]], axis);
    Point2 b = project(vertices[loop[(i + 1) % loop.size()]], axis);
    if (b[1] < a[1]) std::swap(a, b);
    if (std::min(a[0], b[0]) <= q[0] && q[0] <= std::max(a[0], b[0]) && a[1] <= q[1] &&
        q[1] <= b[1] && orient2d_sign(a, b, q) == 0) {
      return false;
    }
    if (a[1] <= q[1] && q[1] < b[1] && orient2d_sign(a, b, q) > 0) inside = !inside;
  }
  return inside;
}

ProjectedFace project_face(const std::vector<Point3>& vertices, std::span<const Loop> loops,
                           int axis) {
  ProjectedFace out;
  std::vector<std::uint32_t>& distinct = out.vertex;
  for (const Loop& loop : loops) distinct.insert(distinct.end(), loop.begin(), loop.end());
  sort_unique(distinct);
  for (std::uint32_t v : distinct) out.points.push_back(project(vertices[v], axis));
  for (std::size_t i = 0; i < loops.size(); ++i) {
    Loop local;
    for (std::uint32_t v : loops[i]) {
      const auto found = std::lower_bound(distinct.begin(), distinct.end(), v);
      local.push_back(static_cast<std::uint32_t>(found - distinct.begin()));
    }
    const int orientation = loop_orientation(out.points, local);
    out.oriented = out.oriented && orientation != 0;
    if (orientation == (i == 0 ? -1 : 1)) {
      std::reverse(local.begin(), local.end());
      if (i == 0) out.mirrored = true;
    }
    out.loops.push_back(std::move(local));
  }
  return out;
}

double squared_distance(const Point2& a, const Point2& b) {
  const double x = a[0] - b[0], y = a[1] - b[1];
  return x * x + y * y;
}

}  // namespace delmesher::geometry
