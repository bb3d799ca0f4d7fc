#include "mesher/plane/line.h"

#include <algorithm>
#include <cmath>

#include "mesher/arithmetic/dyadic.h"
#include "mesher/plane/shape.h"

namespace delmesher::plane {
namespace {

// Divides a vector by the power of two of its size, and returns the exponent.
int to_size_one(double& x, double& y) {
  const double size = std::max(std::fabs(x), std::fabs(y));
  const int power = size > 0 ? std::ilogb(size) : 0;
  x = std::ldexp(x, -power);
  y = std::ldexp(y, -power);
  return power;
}

// From p to the line through a and b: the exact determinant over the length.
double distance_to_whole_line(const Point& a, const Point& b, const Point& p) {
  std::array<Dyadic, 2> ab, ap;
  for (std::size_t k = 0; k < 2; ++k) {
    const Dyadic origin = Dyadic::from_double(a[k]);
    ab[k] = Dyadic::from_double(b[k]) - origin;
    ap[k] = Dyadic::from_double(p[k]) - origin;
  }
  Dyadic determinant = ab[0] * ap[1] - ab[1] * ap[0];
  if (determinant.sign() == 0) return 0;
  double x = b[0] - a[0], y = b[1] - a[1];
  determinant.exponent -= to_size_one(x, y);  // of the size of the distance, which doubles can hold
  return std::fabs(round_to_double(determinant).value) / norm(x, y);
}

}  // namespace

double distance(const Point& a, const Point& b) {
  return norm(b[0] - a[0], b[1] - a[1]);
}

double Line::nearest(const Point& p) const {
  double x = b[0] - a[0], y = b[1] - a[1], u = p[0] - a[0], v = p[1] - a[1];
  int power = 0;
  if (!(x * x + y * y > 0x1p-500 && u * u + v * v > 0x1p-500)) {
    power = to_size_one(u, v) - to_size_one(x, y);  // so that products do not vanish
  }
  const double square = x * x + y * y;
  if (!(square > 0)) return 0;
  const double t = (u * x + v * y) / square;
  return std::clamp(power == 0 ? t : std::ldexp(t, power), 0.0, 1.0);
}

double Line::distance_to(const Point& p) const {
  // From the nearer end, so that one that is far away does not blur it.
  const double to_a = distance(a, p), to_b = distance(b, p);
  const Point &from = to_a <= to_b ? a : b, &to = to_a <= to_b ? b : a;
  const double t = Line{from, to}.nearest(p);
  const double result =
      norm(p[0] - from[0] - t * (to[0] - from[0]), p[1] - from[1] - t * (to[1] - from[1]));
  // It is wrong by some roundings of the distance from that end. If this is much, the foot is
  // strictly between the ends.
  return result > 0x1p-22 * std::min(to_a, to_b) ? result : distance_to_whole_line(from, to, p);
}

double Line::distance_to_line(const Line& other) const {
  return std::min(std::min(distance_to(other.a), distance_to(other.b)),
                  std::min(other.distance_to(a), other.distance_to(b)));
}

}  // namespace delmesher::plane
