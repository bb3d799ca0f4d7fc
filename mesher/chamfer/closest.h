// Closest points of points, segments and triangles, in doubles, with the feature they lie on.
#pragma once

#include <array>

#include "mesher/geometry/vector.h"

namespace delmesher::chamfer {

struct ClosestOnSegment {
  double squared_distance;
  double s;  // the closest point is a + s (b - a); exactly 0 or 1 at the ends
};

ClosestOnSegment closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b);

struct ClosestOfSegments {
  double squared_distance;
  double s, t;  // a + s (b - a) and c + t (d - c); exactly 0 or 1 at the ends
};

ClosestOfSegments closest_of_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// How many times the gap between the segments ab and cd fits along ab: the integral of ds /
// distance over ab. `s` is where ab is closest to cd; not more than about `most`. The segments do
// not touch.
double length_of_gap(const Vec3& a, const Vec3& b, double s, const Vec3& c, const Vec3& d,
                     double most);

struct ClosestOnTriangle {
  double squared_distance;
  // 0..2: corner k; 3..5: inside edge k - 3 (from corner k - 3 to the next); 6: inside.
  int feature;
};

ClosestOnTriangle closest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& t);

}  // namespace delmesher::chamfer
