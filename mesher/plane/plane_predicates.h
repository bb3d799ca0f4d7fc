// Exact predicates in the plane on any mix of explicit and on-segment points (z = 0).
//
// Stages: a semi-static filter on nearest doubles that serves all mixes of kinds, then exact
// integers at a common scale (predicates/stages.h); ties of in_circle are broken symbolically.
// Signs are -1, 0, +1, valid for all finite coordinates.
//
// Laws (plane_predicates_test.cpp):
//  (1) orient and in_circle are antisymmetric: exchanging two arguments inverts the sign.
//  (2) orient is 0 iff the points are collinear, in_circle iff they lie on a circle or a line.
//  (3) in_circle_perturbed agrees with in_circle where that is not 0, is antisymmetric, and is 0
//      only if all four points are collinear or two are the same.
//  (4) A filter that is certain agrees with the exact stage.
//  (5) All are unchanged if every coordinate is multiplied by the same power of two.
#pragma once

#include <cmath>
#include <cstdint>

#include "mesher/base/ids.h"
#include "mesher/predicates/filter.h"
#include "mesher/predicates/points.h"
#include "mesher/predicates/polynomials.h"

namespace delmesher::plane {

namespace polynomials {

using predicates::polynomials::Triple;

// Degree 4: below 3 * (2 * 2^(2 B)) * (2 * 2^(2 B)) < 2^(4 B + 4).
struct InCircle {
  static constexpr int kPoints = 4;
  static constexpr bool kFixedSize = true;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    const T ax = p[0].x - p[3].x, ay = p[0].y - p[3].y;
    const T bx = p[1].x - p[3].x, by = p[1].y - p[3].y;
    const T cx = p[2].x - p[3].x, cy = p[2].y - p[3].y;
    return (ax * ax + ay * ay) * (bx * cy - by * cx) + (bx * bx + by * by) * (cx * ay - cy * ax) +
           (cx * cx + cy * cy) * (ax * by - ay * bx);
  }
};

// (p - q) . (r - q) in the plane.
struct Dot {
  static constexpr int kPoints = 3;
  static constexpr bool kFixedSize = true;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    return (p[0].x - p[1].x) * (p[2].x - p[1].x) + (p[0].y - p[1].y) * (p[2].y - p[1].y);
  }
};

}  // namespace polynomials

// Constants as in predicates/filter.h, whose comment explains the three parts of each bound. The
// rounding part here, as that of orient2d there, is relative to the sum of the absolute monomials,
// which costs little in the plane and is sharper.
namespace filters {

using predicates::filters::certain_sign;
using predicates::filters::kDifferenceError;
using predicates::filters::larger;
using predicates::filters::orient2d;

// 12 monomials of degree 4; roundings: 4 differences, 1 product and 1 sum in the squared length, 1
// and 1 in the minor, 1 product, 2 sums, k = 11, bound 11 u; 12 u makes up for the roundings of the
// sum itself. With N the largest difference before or after, each monomial changes by at most 4 D
// N^3 for inexact arguments.
inline int in_circle(const Approximation& a, const Approximation& b, const Approximation& c,
                     const Approximation& d) {
  const double ax = a.x - d.x, ay = a.y - d.y;
  const double bx = b.x - d.x, by = b.y - d.y;
  const double cx = c.x - d.x, cy = c.y - d.y;
  const double bxcy = bx * cy, bycx = by * cx;
  const double cxay = cx * ay, cyax = cy * ax;
  const double axby = ax * by, aybx = ay * bx;
  const double al = ax * ax + ay * ay;
  const double bl = bx * bx + by * by;
  const double cl = cx * cx + cy * cy;
  const double det = al * (bxcy - bycx) + bl * (cxay - cyax) + cl * (axby - aybx);
  const double sum = al * (std::fabs(bxcy) + std::fabs(bycx)) +
                     bl * (std::fabs(cxay) + std::fabs(cyax)) +
                     cl * (std::fabs(axby) + std::fabs(aybx));
  double bound = sum * 0x1.8001p-50 + (1 + al + bl + cl) * 0x1p-900;
  const double error = larger(larger(a.error, b.error), larger(c.error, d.error));
  if (error != 0) {
    const double e = kDifferenceError * error;
    const double n =
        larger(larger(larger(std::fabs(ax), std::fabs(ay)), larger(std::fabs(bx), std::fabs(by))),
               larger(std::fabs(cx), std::fabs(cy))) +
        e;
    bound += 48.01 * e * (n * n * n);
  }
  return certain_sign(det, bound);
}

// 2 monomials, as in orient2d.
inline int dot(const Approximation& p, const Approximation& q, const Approximation& r) {
  const double ux = p.x - q.x, uy = p.y - q.y;
  const double vx = r.x - q.x, vy = r.y - q.y;
  const double x = ux * vx, y = uy * vy;
  double bound = (std::fabs(x) + std::fabs(y)) * 0x1.0002p-51 + 0x1p-900;
  const double error = larger(larger(p.error, q.error), r.error);
  if (error != 0) {
    const double d = kDifferenceError * error;
    bound +=
        1.001 * d * (std::fabs(ux) + std::fabs(uy) + std::fabs(vx) + std::fabs(vy) + 2.001 * d);
  }
  return certain_sign(x + y, bound);
}

}  // namespace filters

struct PlaneCounters {
  std::uint64_t filter = 0, exact = 0, symbolic = 0;
};

// One object per thread; the points must outlive it and may grow at any time.
class PlanePredicates {
 public:
  explicit PlanePredicates(const PointStore& points) : points_(points) {}

  // +1 if abc is a counter-clockwise triangle.
  int orient(VertexId a, VertexId b, VertexId c) {
    const int s = filters::orient2d(points_.approximation(a), points_.approximation(b),
                                    points_.approximation(c));
    if (s == 0) return orient_exact(a, b, c);
    ++counters.filter;
    return s;
  }

  // +1 if d is strictly inside the circle of the counter-clockwise triangle abc, 0 if on it.
  int in_circle(VertexId a, VertexId b, VertexId c, VertexId d) {
    const int s = filters::in_circle(points_.approximation(a), points_.approximation(b),
                                     points_.approximation(c), points_.approximation(d));
    if (s == 0) return in_circle_exact(a, b, c, d);
    ++counters.filter;
    return s;
  }

  // in_circle with ties broken by raising the lifted heights |p|^2, infinitely more for smaller
  // ids.
  int in_circle_perturbed(VertexId a, VertexId b, VertexId c, VertexId d) {
    const int s = in_circle(a, b, c, d);
    return s != 0 ? s : perturbed_sign(a, b, c, d);
  }

  // Sign of (p - q) . (r - q). p is in the open disc with diameter ab iff dot(a, p, b) < 0.
  int dot(VertexId p, VertexId q, VertexId r) {
    const int s =
        filters::dot(points_.approximation(p), points_.approximation(q), points_.approximation(r));
    if (s == 0) return dot_exact(p, q, r);
    ++counters.filter;
    return s;
  }

  PlaneCounters counters;

 private:
  int orient_exact(VertexId a, VertexId b, VertexId c);
  int in_circle_exact(VertexId a, VertexId b, VertexId c, VertexId d);
  int dot_exact(VertexId p, VertexId q, VertexId r);
  int perturbed_sign(VertexId a, VertexId b, VertexId c, VertexId d);

  const PointStore& points_;
};

}  // namespace delmesher::plane
