#include "mesher/improve/quality.h"

#include <array>

#include "mesher/arithmetic/bounded.h"
#include "mesher/predicates/polynomials.h"

namespace delmesher::improve::detail {
namespace {

using Pair = arithmetic::BoundedPair;
namespace polynomials = predicates::polynomials;
using polynomials::Triple;

// Exact, unless the difference is far below the last place of the larger one.
Triple<Pair> difference(const Vec3& x, const Vec3& y) {
  std::array<Pair, 3> d;
  for (std::size_t i = 0; i < 3; ++i) arithmetic::two_sum(x[i], -y[i], d[i].high, d[i].low);
  return {d[0], d[1], d[2]};
}

double square(const Triple<Pair>& x) {
  return polynomials::dot(x, x).high;
}

// Is a nearly flat tetrahedron certainly inverted, or one of its values below `least`? In doubles,
// whose errors are all in the volume where no face is thin; thin faces have thin angles.
bool is_worse(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Quality& least) {
  constexpr double kVolumeError = 0x1p-48, kThin = 0x1p-40, kTiny = 0x1p-800, kSlack = 1.001;
  const Vec3 u = subtract(b, a), v = subtract(c, a), w = subtract(d, a);
  const Vec3 p = subtract(c, b), q = subtract(d, b), r = subtract(d, c);
  const Vec3 abc = cross(u, v), abd = cross(w, u), acd = cross(v, w), bcd = cross(p, q);
  Sizes s = {dot(abc, w), dot(u, u),     dot(v, v),     dot(w, w),     dot(p, p),    dot(q, q),
             dot(r, r),   dot(abc, abc), dot(abd, abd), dot(acd, acd), dot(bcd, bcd)};
  const double error = kVolumeError * std::sqrt(s.uu * s.vv) * std::sqrt(s.ww);
  if (!(error > kTiny && error < 1 / kTiny && s.pp * s.qq > kTiny)) return false;
  if (s.volume < -error) return true;
  if (s.abc > kThin * (s.uu * s.vv) && s.abd > kThin * (s.uu * s.ww) &&
      s.acd > kThin * (s.vv * s.ww) && s.bcd > kThin * (s.pp * s.qq)) {
    s.volume = kSlack * (std::fabs(s.volume) + error);
    return smallest_dihedral(s) < double{least.dihedral};
  }
  // Above 1 it is no bound: who asks wants the dihedral angles alone.
  return least.face > kSlack * kThin && least.face <= 1;
}

}  // namespace

Quality accurate_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                         const Quality& least) {
  if (is_worse(a, b, c, d, least)) return {};
  const Triple<Pair> u = difference(b, a), v = difference(c, a), w = difference(d, a);
  const Triple<Pair> abc = polynomials::cross(u, v);
  const Pair volume = polynomials::dot(abc, w);
  if (volume.sign() != 1) return {};
  const Triple<Pair> p = difference(c, b), q = difference(d, b), r = difference(d, c);
  const Triple<Pair> abd = polynomials::cross(w, u), acd = polynomials::cross(v, w),
                     bcd = polynomials::cross(p, q);
  const Sizes sizes = {volume.high, square(u),   square(v),   square(w),   square(p),  square(q),
                       square(r),   square(abc), square(abd), square(acd), square(bcd)};
  return quality_of(sizes, least, [&] {
    const Pair uu = polynomials::dot(u, u), vv = polynomials::dot(v, v),
               ww = polynomials::dot(w, w);
    const auto along = [&](Pair Triple<Pair>::*axis) {
      return ww * abc.*axis + vv * abd.*axis + uu * acd.*axis;
    };
    const Triple<Pair> center = {along(&Triple<Pair>::x), along(&Triple<Pair>::y),
                                 along(&Triple<Pair>::z)};
    return square(center);
  });
}

}  // namespace delmesher::improve::detail
