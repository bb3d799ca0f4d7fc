// Segments in doubles: lengths and distances for chamfering and the filter, which decide no
// topology.
#pragma once

#include <array>

namespace delmesher::plane {

using Point = std::array<double, 2>;

double distance(const Point& a, const Point& b);

// The closed segment ab.
struct Line {
  Point a, b;
  double length() const { return distance(a, b); }
  Point at(double t) const { return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])}; }
  // Parameter of the point nearest to p.
  double nearest(const Point& p) const;
  // Relative error below 2^-25 wherever the ends are, also if both are so far away that doubles at
  // their place are coarser than the distance: a feature size must not come out too large.
  double distance_to(const Point& p) const;
  // To another one that does not cross this one.
  double distance_to_line(const Line& other) const;
};

}  // namespace delmesher::plane
