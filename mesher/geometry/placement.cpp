#include "mesher/geometry/placement.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "mesher/arithmetic/dyadic.h"
#include "mesher/base/check.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/stages.h"

namespace delmesher::geometry {
namespace {

// The smallest number with at most `bits` significant bits that is not below x > 0.
double round_up(double x, int bits) {
  const DoubleParts parts = decompose(x);
  const int length = 64 - std::countl_zero(parts.magnitude);
  if (length <= bits) return x;
  const int drop = length - bits;
  const std::uint64_t mantissa = (parts.magnitude >> drop) + 1;  // odd magnitude: never exact
  return std::ldexp(static_cast<double>(mantissa), parts.exponent + drop);
}

// Corners and target relative to the anchor (the last corner), scaled by a power of two so that no
// product overflows and none that matters underflows. Returns the exponent of that power.
template <std::size_t N>
int localise(std::array<Vec3, N>& vectors, const Vec3& anchor, double& tolerance) {
  double size = largest_component(anchor);
  for (const Vec3& v : vectors) size = std::max(size, largest_component(v));
  // Twice: differences of the largest doubles would overflow, and may be much smaller.
  const int shift = size > 0 ? -std::ilogb(size) - 2 : 0;
  const Vec3 origin = times_power_of_two(anchor, shift);
  double extent = 0;
  for (Vec3& v : vectors) {
    v = subtract(times_power_of_two(v, shift), origin);
    extent = std::max(extent, largest_component(v));
  }
  tolerance = std::ldexp(tolerance, shift);
  const int more = extent > 0 ? -std::ilogb(extent) : 0;
  for (Vec3& v : vectors) v = times_power_of_two(v, more);
  tolerance = std::ldexp(tolerance, more);
  return shift + more;
}

// Numerators and denominator of the coordinates (u, v) of w in the basis e, f of a plane:
// u = (w x f) . n / |n|^2, v = (e x w) . n / |n|^2, n = e x f. In double-doubles, because n suffers
// from cancellation when the triangle is a needle.
struct PlaneCoordinates {
  double u, v;
};

PlaneCoordinates solve(const Vec3& e, const Vec3& f, const Vec3& w) {
  const auto e2 = stages::exact_pairs(e), f2 = stages::exact_pairs(f), w2 = stages::exact_pairs(w);
  const auto n = cross(e2, f2);
  const double nn = dot(n, n).high;
  if (!(nn > 0)) return {0, 0};
  return {dot(cross(w2, f2), n).high / nn, dot(cross(e2, w2), n).high / nn};
}

// What lies beyond the nearest doubles of points, relative to that of the anchor, in local
// coordinates: far from the origin, corners on planes are known by their doubles to fewer digits
// than small distances ask for. What the tolerance does not see is left out.
class Remainders {
 public:
  Remainders(const PointStore& points, VertexId anchor, double tolerance, int shift)
      : points_(points), seen_(tolerance / 16), shift_(shift), anchor_(of(anchor)) {}

  Vec3 relative(VertexId v) const { return subtract(of(v), anchor_); }
  Vec3 relative(const Vec3& rest) const {
    return subtract(times_power_of_two(rest, shift_), anchor_);
  }

 private:
  Vec3 of(VertexId v) const {
    if (points_.approximation(v).error <= seen_) return {0, 0, 0};
    const Approximation r = points_.remainder(v);
    return times_power_of_two(Vec3{r.x, r.y, r.z}, shift_);
  }

  const PointStore& points_;
  double seen_;
  int shift_;
  Vec3 anchor_;
};

}  // namespace

double shortest_dyadic(double lo, double hi) {
  DELMESHER_CHECK(lo <= hi, "the bounds of an interval are in the wrong order");
  if (lo <= 0 && hi >= 0) return 0;
  if (hi < 0) return -shortest_dyadic(-hi, -lo);
  constexpr std::uint64_t kFraction = (std::uint64_t{1} << 52) - 1;
  const auto low = std::bit_cast<std::uint64_t>(lo), high = std::bit_cast<std::uint64_t>(hi);
  if (low > kFraction) {  // not subnormal
    if ((low & kFraction) == 0) return lo;
    // The power of two between them, or their common bits down to the first difference.
    if (high >> 52 != low >> 52) return std::bit_cast<double>(((low >> 52) + 1) << 52);
    const int equal = std::countl_zero((low - 1) ^ high);
    return std::bit_cast<double>(high >> (63 - equal) << (63 - equal));
  }
  for (int bits = 1; bits <= 53; ++bits) {
    const double candidate = round_up(lo, bits);
    if (candidate <= hi) return candidate;
  }
  return lo;
}

PointDefinition place_on_segment(const PointStore& points, VertexId p, VertexId q,
                                 const Vec3& target, double tolerance, bool inside,
                                 const Vec3& rest) {
  Vec3 far = points.nearest(p);
  Vec3 near = points.nearest(q);
  // Compare at a scale where squares neither overflow nor vanish.
  std::array<Vec3, 2> ends = {far, near};
  double unused = 0;
  localise(ends, target, unused);
  if (dot(ends[0], ends[0]) < dot(ends[1], ends[1])) {
    std::swap(p, q);
    std::swap(far, near);
  }
  std::array<Vec3, 2> local = {far, target};
  const double asked = tolerance;
  const int shift = localise(local, near, tolerance);
  const Remainders remainders(points, q, asked, shift);
  local[0] = add(local[0], remainders.relative(p));
  local[1] = add(local[1], remainders.relative(rest));
  const Vec3& edge = local[0];
  const double length = norm(edge);
  DELMESHER_CHECK(length > 0, "a point is placed on a segment of no length");
  const double t = dot(local[1], edge) / length / length;
  const double slack = tolerance / length;
  double lo = t - slack;
  double hi = t + slack;
  if (inside) {
    // Never more than halfway from the target to an end, however large the tolerance; and if the
    // target lies beyond the anchor, as near to it as the tolerance resolves.
    const double nearest = slack > 0 ? std::min(slack, 0.25) : (t > 0 ? t : 0x1p-52);
    const double aim = std::min(std::max(t, nearest), 0.75);
    lo = std::max(lo, aim / 2);
    hi = std::min(std::max(hi, aim), (1 + aim) / 2);
    lo = std::min(lo, hi);
  }
  return {PointKind::on_segment, {p, q, kNone}, shortest_dyadic(lo, hi), 0};
}

PointDefinition place_on_triangle(const PointStore& points, VertexId p, VertexId q, VertexId r,
                                  const Vec3& target, double tolerance, const Vec3& rest) {
  std::array<VertexId, 3> corner = {p, q, r};
  std::array<Vec3, 3> ends = {points.nearest(p), points.nearest(q), points.nearest(r)};
  double unused = 0;
  localise(ends, target, unused);
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (dot(ends[i], ends[i]) < dot(ends[nearest], ends[nearest])) nearest = i;
  }
  std::rotate(corner.begin(), corner.begin() + static_cast<std::ptrdiff_t>((nearest + 1) % 3),
              corner.end());
  std::array<Vec3, 3> local = {points.nearest(corner[0]), points.nearest(corner[1]), target};
  const double asked = tolerance;
  const int shift = localise(local, points.nearest(corner[2]), tolerance);
  const Remainders remainders(points, corner[2], asked, shift);
  for (std::size_t i = 0; i < 2; ++i) local[i] = add(local[i], remainders.relative(corner[i]));
  local[2] = add(local[2], remainders.relative(rest));
  const auto [u, v] = solve(local[0], local[1], local[2]);
  const auto shortest = [&](double x, const Vec3& edge) {
    const double slack = tolerance / 2 / norm(edge);
    return shortest_dyadic(x - slack, x + slack);
  };
  return {PointKind::on_triangle, corner, shortest(u, local[0]), shortest(v, local[1])};
}

Vec3 snap_to_grid(const Vec3& point, double tolerance) {
  if (!(tolerance > 0) || std::isinf(tolerance)) return point;
  const double spacing = std::ldexp(1.0, std::ilogb(tolerance));
  Vec3 result = point;
  for (double& x : result) {
    // From 2^52 spacings on, doubles are multiples of the spacing anyway.
    if (std::fabs(x) < spacing * 0x1p52) x = std::round(x / spacing) * spacing;
  }
  return result;
}

}  // namespace delmesher::geometry
