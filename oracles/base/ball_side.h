// Decides for many points on which side of one sphere they lie. Everything that does not depend on
// the point is computed once.
#pragma once

#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

// A sphere through a vertex a is s |p - a|^2 + (p - a) . w = 0, where s and w are polynomials of
// the other vertices. They are evaluated in doubles with a bound on the error. With it `side`
// certifies a sign and never guesses.
class BallSide {
 public:
  // The circumsphere of a tetrahedron, which should be positively oriented: else the sides are
  // exchanged.
  static BallSide circumscribed(const ExactPoints& points, const std::array<Index, 4>& tet);
  // The smallest sphere through the corners of a triangle, or through the ends of an edge.
  static BallSide diametral(const ExactPoints& points, const std::array<Index, 3>& triangle);
  static BallSide diametral(const ExactPoints& points, Index a, Index b);

  // 1: certainly outside, -1: certainly inside, 0: not known.
  int side(Index v) const {
    const Position& q = points_->nearest(v);
    const double x = q[0] - base_[0], y = q[1] - base_[1], z = q[2] - base_[2];
    const double sum = (x < 0 ? -x : x) + (y < 0 ? -y : y) + (z < 0 ? -z : z);
    const double value = s_ * (x * x + y * y + z * z) + (x * w_[0] + y * w_[1] + z * w_[2]);
    const double error = sum * sum * square_error_ + sum * linear_error_ + constant_error_;
    return value > error ? 1 : value < -error ? -1 : 0;
  }

 private:
  BallSide(const ExactPoints& points, Index base);
  Position from_base(Index v) const;
  // Sets w and the bounds of a point's error, given those of s and of the components of w. With
  // `length` out of the range where nothing can over- or underflow, nothing is ever certain.
  void finish(double length, double s, const Position& w, double s_error, double w_error);

  const ExactPoints* points_;
  Position base_;
  double s_ = 0;
  Position w_{};
  double square_error_ = 0, linear_error_ = 0, constant_error_ = 0;
};

}  // namespace tetproof::oracles
