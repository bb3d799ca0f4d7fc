#include "mesher/chamfer/closest.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace delmesher::chamfer {

ClosestOnSegment closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 direction = subtract(b, a);
  const double along = dot(subtract(p, a), direction);
  const double length = squared_norm(direction);
  if (!(along > 0)) return {squared_norm(subtract(p, a)), 0};
  if (!(along < length)) return {squared_norm(subtract(p, b)), 1};
  // The cross product keeps its relative accuracy where subtracting the foot point would not.
  const Vec3 normal = cross(direction, subtract(p, a));
  return {squared_norm(normal) / length, along / length};
}

ClosestOfSegments closest_of_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  ClosestOfSegments best{std::numeric_limits<double>::infinity(), 0, 0};
  const auto offer = [&best](double squared_distance, double s, double t) {
    if (squared_distance < best.squared_distance) best = {squared_distance, s, t};
  };
  ClosestOnSegment end = closest_on_segment(a, c, d);
  offer(end.squared_distance, 0, end.s);
  end = closest_on_segment(b, c, d);
  offer(end.squared_distance, 1, end.s);
  end = closest_on_segment(c, a, b);
  offer(end.squared_distance, end.s, 0);
  end = closest_on_segment(d, a, b);
  offer(end.squared_distance, end.s, 1);
  // Closest points inside both: only if the lines are not parallel.
  const Vec3 u = subtract(b, a), v = subtract(d, c), w = subtract(c, a);
  const Vec3 normal = cross(u, v);
  const double area = squared_norm(normal);
  if (area > 0) {
    const double s = dot(cross(w, v), normal) / area;
    const double t = dot(cross(w, u), normal) / area;
    if (s > 0 && s < 1 && t > 0 && t < 1) {
      const double height = dot(w, normal);
      offer(height * height / area, s, t);
    }
  }
  return best;
}

// From the narrowest place to both ends, in steps of half the gap there.
double length_of_gap(const Vec3& a, const Vec3& b, double s, const Vec3& c, const Vec3& d,
                     double most) {
  const Vec3 direction = subtract(b, a);
  const double length = norm(direction);
  double sum = 0;
  for (const bool forward : {false, true}) {
    const double end = length * (forward ? 1 - s : s);
    for (double gone = 0; gone < end && sum < most;) {
      const Vec3 p = add_scaled(a, s + (forward ? gone : -gone) / length, direction);
      const double gap = std::sqrt(closest_on_segment(p, c, d).squared_distance);
      const double step = std::min(gap / 2, end - gone);
      sum += step / gap;
      gone += step;
    }
  }
  return sum;
}

ClosestOnTriangle closest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 normal = cross(subtract(t[1], t[0]), subtract(t[2], t[0]));
  const double area = squared_norm(normal);
  bool inside = area > 0;
  for (int k = 0; k < 3 && inside; ++k) {
    const Vec3 inward = cross(normal, subtract(t[(k + 1) % 3], t[k]));
    inside = dot(inward, subtract(p, t[k])) > 0;
  }
  if (inside) {
    const double height = dot(normal, subtract(p, t[0]));
    return {height * height / area, 6};
  }
  ClosestOnTriangle best{std::numeric_limits<double>::infinity(), 0};
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const ClosestOnSegment side = closest_on_segment(p, t[k], t[next]);
    if (side.squared_distance >= best.squared_distance) continue;
    best = {side.squared_distance, side.s == 0 ? k : side.s == 1 ? next : 3 + k};
  }
  return best;
}

}  // namespace delmesher::chamfer
