// Points of the plane as rationals, and the signs that decide the checks. Rationals decide; a plain
// floating-point bound only skips the obvious cases.
#pragma once

#include <gmpxx.h>

#include <cstdint>
#include <vector>

namespace tetproof {

class PlanePoints {
 public:
  using Index = std::uint32_t;
  struct Point {
    mpq_class x, y;
    double dx, dy;  // rounded, in one way for all
    // Is it no higher than the other one?
    bool below(const Point& other) const { return dy != other.dy ? dy < other.dy : y <= other.y; }
  };

  void add(Point point);
  const std::vector<Point>& all() const { return points_; }
  // Largest error of the rounded coordinates.
  double error() const { return error_; }

  int orient(const Point& a, const Point& b, const Point& c);
  int orient(Index a, Index b, Index c) { return orient(points_[a], points_[b], points_[c]); }
  // Does the direction from o to a come before that to b, counter-clockwise from the positive
  // x-axis?
  bool turns_before(const Point& o, const Point& a, const Point& b);
  // Positive if d is inside the circle of the counter-clockwise abc.
  int in_circle(Index a, Index b, Index c, Index d);
  // Is p strictly inside the disc with diameter ab?
  bool encroaches(Index a, Index p, Index b);
  // The parameter of a point on the line through a and b: 0 at a, 1 at b.
  mpq_class parameter(Index v, Index a, Index b) const;

  // Distances in input units, rounded.
  double distance(Index a, Index b) const;
  double distance_to_segment(Index v, Index a, Index b) const;

  std::uint64_t checks = 0;  // number of signs decided so far

 private:
  std::vector<Point> points_;
  double error_ = 1e-320;
};

}  // namespace tetproof
