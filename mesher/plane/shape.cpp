#include "mesher/plane/shape.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "mesher/geometry/vector.h"

namespace delmesher::plane {
namespace {

// b - a. Where the points are known to few digits compared with their distance, with the digits
// that the nearest doubles leave over.
Vec2 difference(const PointStore& points, VertexId a, VertexId b) {
  const Approximation& p = points.approximation(a);
  const Approximation& q = points.approximation(b);
  Vec2 d = {q.x - p.x, q.y - p.y};
  const double error = p.error > q.error ? p.error : q.error;
  if (error == 0 || error < 0x1p-40 * (std::fabs(d.x) + std::fabs(d.y))) return d;
  const Approximation r = points.remainder(a), s = points.remainder(b);
  d.x += s.x - r.x;
  d.y += s.y - r.y;
  return d;
}

// The power of two that is at most x > 0, unless x is subnormal.
double power_below(double x) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & (std::uint64_t{0x7ff} << 52));
}

// To the nearest multiple of a power of two; from 2^51 of them on, doubles are coarser or as fine.
double to_grid(double x, double spacing) {
  const double bias = spacing * 0x1.8p52;
  return std::fabs(x) < spacing * 0x1p51 ? (x + bias) - bias : x;
}

double larger_coordinate(const Vec2& v) {
  return std::max(std::fabs(v.x), std::fabs(v.y));
}

// The fourth powers of sides have to stay finite. A side that is 2^200 times as long as the
// shortest one makes a triangle with an angle that counts as zero, and one more so changes nothing.
Vec2 shortened(const Vec2& v) {
  constexpr double kLongest = 0x1p200;
  const double size = larger_coordinate(v);
  if (size < 2 * kLongest) return v;
  const double factor = kLongest / power_below(size);
  return {v.x * factor, v.y * factor};
}

// The sides times `scale`.
Shape measure(const Vec2& ab, const Vec2& bc, const Vec2& ca, double scale) {
  // Squared lengths opposite the corners.
  const double squared[3] = {dot(bc, bc), dot(ca, ca), dot(ab, ab)};
  const double area = ab.y * ca.x - ab.x * ca.y;  // ab x ac, twice the area
  Shape shape;
  shape.scale = scale;
  shape.sharpest = squared[0] <= squared[1] ? (squared[0] <= squared[2] ? 0 : 2)
                                            : (squared[1] <= squared[2] ? 1 : 2);
  shape.shortest_squared = squared[shape.sharpest];
  shape.longest_squared = std::max({squared[0], squared[1], squared[2]});
  const double product = squared[(shape.sharpest + 1) % 3] * squared[(shape.sharpest + 2) % 3];
  shape.sine_squared = area > 0 && product > 0 ? area * area / product : 0;
  // Cotangent of the sharpest angle: cosine over sine, times the same product.
  const double cosine = shape.sharpest == 0   ? -dot(ab, ca)
                        : shape.sharpest == 1 ? -dot(ab, bc)
                                              : -dot(bc, ca);
  shape.circumcentre = area > 0 ? cosine / (2 * area) : HUGE_VAL;
  return shape;
}

}  // namespace

Shape shape_of(const PointStore& points, VertexId a, VertexId b, VertexId c) {
  Vec2 ab = difference(points, a, b), bc = difference(points, b, c), ca = difference(points, c, a);
  const Shape shape = measure(ab, bc, ca, 1);
  if (shape.shortest_squared > 0x1p-500) return shape;
  const double sizes[3] = {larger_coordinate(ab), larger_coordinate(bc), larger_coordinate(ca)};
  const double smallest = std::min({sizes[0], sizes[1], sizes[2]});
  if (!(smallest > 0)) return shape;
  const double scale = std::min(0x1p900, 1 / power_below(smallest));
  if (!(scale > 1)) return shape;
  for (Vec2* v : {&ab, &bc, &ca}) *v = shortened({v->x * scale, v->y * scale});
  return measure(ab, bc, ca, scale);
}

Vec3 Shape::place(const PointStore& points, const std::array<VertexId, 3>& corner,
                  double height) const {
  const VertexId a = corner[static_cast<std::size_t>((sharpest + 1) % 3)];
  const VertexId b = corner[static_cast<std::size_t>((sharpest + 2) % 3)];
  const Approximation& p = points.approximation(a);
  const Vec2 d = difference(points, a, b);
  const double x = p.x + (d.x / 2 - height * d.y);
  const double y = p.y + (d.y / 2 + height * d.x);
  const double spacing = power_below(std::sqrt(shortest_squared) / scale) * 0x1p-20;
  return {to_grid(x, spacing), to_grid(y, spacing), 0};
}

}  // namespace delmesher::plane
