#include "oracles/base/ball_side.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "oracles/base/vectors.h"

namespace tetproof::oracles {
namespace {

constexpr double kUnit = 0x1p-53;

double largest(const Position& v) {
  return std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
}

}  // namespace

// The bounds below are for components of at most h with an error of at most e = h u + E, where E is
// the error of a difference of rounded points. For a polynomial of degree d whose monomials add up
// to m h^d, rounding costs less than 16 m h^d u, and the error of the arguments less than d m
// h^(d-1) e (1 + a little, because e is far smaller than h or nothing is certain). All bounds are
// taken twice or more.

BallSide::BallSide(const ExactPoints& points, Index base)
    : points_(&points), base_(points.nearest(base)) {}

Position BallSide::from_base(Index v) const {
  const Position& p = points_->nearest(v);
  return {p[0] - base_[0], p[1] - base_[1], p[2] - base_[2]};
}

void BallSide::finish(double length, double s, const Position& w, double s_error, double w_error) {
  const double error = points_->difference_error();
  s_ = s;
  w_ = w;
  const double steepness = largest(w) + w_error, size = std::fabs(s) + s_error;
  square_error_ = 2 * (s_error + 32 * kUnit * size);
  linear_error_ = 2 * (w_error + 32 * kUnit * steepness + 4 * error * size);
  constant_error_ = 8 * error * (steepness + error * size);
  const bool safe = length > 0x1p-90 && length < 0x1p90 && error * 0x1p10 < length &&
                    points_->largest_coordinate() < 0x1p90;
  if (!safe) constant_error_ = std::numeric_limits<double>::infinity();
}

// With b, c, d relative to a: s = det(b, c, d), w = -|d|^2 b x c + |c|^2 b x d - |b|^2 c x d.
BallSide BallSide::circumscribed(const ExactPoints& points, const std::array<Index, 4>& tet) {
  BallSide ball(points, tet[0]);
  const Position b = ball.from_base(tet[1]), c = ball.from_base(tet[2]), d = ball.from_base(tet[3]);
  const Position bc = cross(b, c), bd = cross(b, d), cd = cross(c, d);
  const double bb = dot(b, b), cc = dot(c, c), dd = dot(d, d);
  Position w;
  for (int i = 0; i < 3; ++i) w[i] = -dd * bc[i] + cc * bd[i] - bb * cd[i];
  const double h = std::max({largest(b), largest(c), largest(d)});
  const double e = h * kUnit + points.difference_error();
  // Monomials: 6 of degree 3, 18 of degree 4.
  ball.finish(h, dot(b, cd), w, 2 * (16 * 6 + 3 * 6) * h * h * e,
              2 * (16 * 18 + 4 * 18) * h * h * h * e);
  return ball;
}

// With u, v relative to a and n = u x v: the centre is (|u|^2 v x n + |v|^2 n x u) / (2 |n|^2).
BallSide BallSide::diametral(const ExactPoints& points, const std::array<Index, 3>& triangle) {
  BallSide ball(points, triangle[0]);
  const Position u = ball.from_base(triangle[1]), v = ball.from_base(triangle[2]);
  const Position n = cross(u, v), p = cross(v, n), q = cross(n, u);
  const double uu = dot(u, u), vv = dot(v, v);
  Position w;
  for (int i = 0; i < 3; ++i) w[i] = -(uu * p[i] + vv * q[i]);
  const double h = std::max(largest(u), largest(v));
  const double e = h * kUnit + points.difference_error();
  // Monomials: 12 of degree 4, 24 of degree 5.
  ball.finish(h, dot(n, n), w, 2 * (16 * 12 + 4 * 12) * h * h * h * e,
              2 * (16 * 24 + 5 * 24) * h * h * h * h * e);
  return ball;
}

// (p - a) . (p - b) = |p - a|^2 - (p - a) . (b - a).
BallSide BallSide::diametral(const ExactPoints& points, Index a, Index b) {
  BallSide ball(points, a);
  const Position u = ball.from_base(b);
  const double h = largest(u), e = h * kUnit + points.difference_error();
  ball.finish(h, 1, {-u[0], -u[1], -u[2]}, 0, 2 * e);
  return ball;
}

}  // namespace tetproof::oracles
