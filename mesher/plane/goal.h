// Decides whether a triangle is bad, how bad, and how far from its shortest edge a new point goes.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesher/plane/shape.h"

namespace delmesher::plane {

class Goal {
 public:
  // Angles of at least so many degrees; no edge longer than `max_edge` unless that is 0.
  Goal(double degrees, double max_edge);

  // The badness of a bad triangle; none for a good one. Below 1 it is the squared sine of the
  // smallest angle, which is too small; 1 means that only an edge is too long. Judged in doubles;
  // in doubt about an angle a triangle is bad, which costs at most a point.
  std::optional<double> badness(const Shape& shape) const {
    if (angle_is_small(shape)) return shape.sine_squared;
    const double longest = max_edge_ * shape.scale;
    if (shape.longest_squared > longest * longest) return 1;
    return std::nullopt;
  }

  // Where to put a point: its height above the shortest edge, in lengths of that edge. For an
  // angle that is too small the off-centre, where it is nearer than the circumcentre.
  double reach(const Shape& shape) const {
    return angle_is_small(shape) ? std::min(shape.circumcentre, off_centre_) : shape.circumcentre;
  }

 private:
  bool angle_is_small(const Shape& shape) const { return shape.sine_squared < sine_squared_; }

  double sine_squared_, max_edge_, off_centre_;
};

}  // namespace delmesher::plane
