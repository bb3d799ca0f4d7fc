#include "oracles/plane/points.h"

#include <algorithm>
#include <cmath>

#include "oracles/base/steps.h"

namespace tetproof {

void PlanePoints::add(Point point) {
  error_ = std::max(error_, 5e-16 * std::max(std::fabs(point.dx), std::fabs(point.dy)) + 1e-320);
  points_.push_back(std::move(point));
}

int PlanePoints::orient(const Point& a, const Point& b, const Point& c) {
  ++checks;
  ++oracles::steps;
  const double l = (b.dx - a.dx) * (c.dy - a.dy), r = (b.dy - a.dy) * (c.dx - a.dx);
  const double m = std::fabs(b.dx - a.dx) + std::fabs(b.dy - a.dy) + std::fabs(c.dx - a.dx) +
                   std::fabs(c.dy - a.dy);
  const double bound = 1e-14 * (std::fabs(l) + std::fabs(r)) + 8 * error_ * (m + error_);
  if (std::fabs(l - r) > bound && std::isfinite(bound)) return l > r ? 1 : -1;
  return sgn((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

bool PlanePoints::turns_before(const Point& o, const Point& a, const Point& b) {
  const auto lower = [&](const Point& p) { return p.y < o.y || (p.y == o.y && p.x < o.x); };
  if (lower(a) != lower(b)) return lower(b);
  return orient(o, a, b) > 0;
}

int PlanePoints::in_circle(Index ia, Index ib, Index ic, Index id) {
  ++checks;
  oracles::steps += 2;
  const Point &a = points_[ia], &b = points_[ib], &c = points_[ic], &d = points_[id];
  double sum = 0, scale = 0, largest = 0;
  const double ax = a.dx - d.dx, ay = a.dy - d.dy, bx = b.dx - d.dx, by = b.dy - d.dy,
               cx = c.dx - d.dx, cy = c.dy - d.dy;
  const auto term = [&](double px, double py, double qx, double qy, double rx, double ry) {
    sum += (px * px + py * py) * (qx * ry - qy * rx);
    scale += (px * px + py * py) * (std::fabs(qx * ry) + std::fabs(qy * rx));
    largest = std::max({largest, std::fabs(px), std::fabs(py)});
  };
  term(ax, ay, bx, by, cx, cy);
  term(bx, by, cx, cy, ax, ay);
  term(cx, cy, ax, ay, bx, by);
  const double n = largest + 2 * error_;
  const double bound = 1e-13 * scale + 200 * error_ * n * n * n;
  if (std::fabs(sum) > bound && std::isfinite(bound) && bound > 1e-290) return sum > 0 ? 1 : -1;
  const mpq_class px = a.x - d.x, py = a.y - d.y, qx = b.x - d.x, qy = b.y - d.y, rx = c.x - d.x,
                  ry = c.y - d.y;
  return sgn((px * px + py * py) * (qx * ry - qy * rx) + (qx * qx + qy * qy) * (rx * py - ry * px) +
             (rx * rx + ry * ry) * (px * qy - py * qx));
}

bool PlanePoints::encroaches(Index a, Index p, Index b) {
  ++checks;
  oracles::steps += 32;
  const Point &u = points_[a], &v = points_[p], &w = points_[b];
  return sgn((u.x - v.x) * (w.x - v.x) + (u.y - v.y) * (w.y - v.y)) < 0;
}

double PlanePoints::distance(Index a, Index b) const {
  return std::hypot(points_[a].dx - points_[b].dx, points_[a].dy - points_[b].dy);
}

// Exact except for the root: an end that is far away would blur doubles.
double PlanePoints::distance_to_segment(Index v, Index a, Index b) const {
  oracles::steps += 256;
  const Point &p = points_[v], &q = points_[a], &r = points_[b];
  const mpq_class x = r.x - q.x, y = r.y - q.y, u = p.x - q.x, w = p.y - q.y;
  const mpq_class square = x * x + y * y, along = u * x + w * y;
  mpq_class t = along / square;
  if (t < 0) t = 0;
  if (t > 1) t = 1;
  const mpq_class dx = u - t * x, dy = w - t * y;
  const mpf_class distance(dx * dx + dy * dy, 128);  // no square is too small for its exponent
  return mpf_class(sqrt(distance)).get_d();
}

mpq_class PlanePoints::parameter(Index v, Index a, Index b) const {
  oracles::steps += 32;
  const Point &p = points_[v], &q = points_[a], &r = points_[b];
  if (r.x != q.x) return (p.x - q.x) / (r.x - q.x);
  return (p.y - q.y) / (r.y - q.y);
}

}  // namespace tetproof
