// The quality of a tetrahedron, as the improvement sees it: sines of its dihedral and face angles,
// which are small for small and for large angles alike, and how round it is. In doubles: it steers,
// and nothing that has to be exact depends on it. Products, quotients and square roots only, so
// that all machines agree.
#pragma once

#include <algorithm>
#include <cmath>

#include "mesher/base/ids.h"
#include "mesher/predicates/vector.h"

namespace delmesher::improve {

// Squares. All are 0 for a tetrahedron that is flat, inverted or beyond the range of doubles.
struct Quality {
  float dihedral = 0;  // the smallest of the six dihedral angles' sines
  float face = 0;      // the smallest of the twelve face angles' sines
  float gamma = 0;     // 3 x inradius / circumradius: 1 if it is regular
};

// Better than every tetrahedron: of one that does not count.
inline constexpr Quality kNotCounted{HUGE_VALF, HUGE_VALF, HUGE_VALF};

inline Quality worse(Quality a, Quality b) {
  return {std::min(a.dihedral, b.dihedral), std::min(a.face, b.face), std::min(a.gamma, b.gamma)};
}

namespace detail {

// Squared sine of the smallest angle of a triangle with these squared edge lengths, where `normal`
// is the square of twice its area: it is opposite the shortest edge.
inline double smallest_angle(double normal, double x, double y, double z) {
  return normal / std::max({x * y, y * z, z * x});
}

// 0 also for a NaN.
inline float positive_or_zero(double x) {
  return x > 0 ? static_cast<float>(x) : 0;
}

}  // namespace detail

// As soon as one value is below `least`, the values after it stay 0.
inline Quality quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                       const Quality& least = {}) {
  const Vec3 u = subtract(b, a), v = subtract(c, a), w = subtract(d, a);
  const Vec3 p = subtract(c, b), q = subtract(d, b), r = subtract(d, c);
  const Vec3 abc = cross(u, v), abd = cross(w, u), acd = cross(v, w), bcd = cross(p, q);
  const double volume = dot(abc, w);
  if (!(volume > 0)) return {};
  const double uu = dot(u, u), vv = dot(v, v), ww = dot(w, w), pp = dot(p, p), qq = dot(q, q),
               rr = dot(r, r);
  const double n_abc = dot(abc, abc), n_abd = dot(abd, abd), n_acd = dot(acd, acd),
               n_bcd = dot(bcd, bcd);
  // |n_f| |n_g| sin = 6 V |edge| for the two faces at an edge.
  const double h_abc = volume / n_abc, h_abd = volume / n_abd, h_acd = volume / n_acd,
               h_bcd = volume / n_bcd;
  const double dihedral = std::min({uu * h_abc * h_abd, vv * h_abc * h_acd, ww * h_abd * h_acd,
                                    pp * h_abc * h_bcd, qq * h_abd * h_bcd, rr * h_acd * h_bcd});
  Quality result;
  result.dihedral = detail::positive_or_zero(dihedral);
  if (result.dihedral < least.dihedral) return result;
  const double face = std::min(
      {detail::smallest_angle(n_abc, uu, vv, pp), detail::smallest_angle(n_abd, uu, ww, qq),
       detail::smallest_angle(n_acd, vv, ww, rr), detail::smallest_angle(n_bcd, pp, qq, rr)});
  result.face = detail::positive_or_zero(face);
  if (result.face < least.face) return result;
  const double surface = std::sqrt(n_abc) + std::sqrt(n_abd) + std::sqrt(n_acd) + std::sqrt(n_bcd);
  Vec3 center;  // the circumcentre from a, times twice the volume
  for (int i = 0; i < 3; ++i) center[i] = ww * abc[i] + vv * abd[i] + uu * acd[i];
  const double inverse = volume / surface;
  const double gamma = 36 * inverse * inverse * (volume * volume / dot(center, center));
  result.gamma = detail::positive_or_zero(gamma);
  return result;
}

// How far below a face the apex of a nearly regular tetrahedron is, in lengths of its normal, which
// is as long as twice its area.
inline double apex_height(double area) {
  constexpr double kHeight = 0.877;  // of a regular one, by the root of twice the area of a face
  return area > 0 ? kHeight / std::sqrt(area) : 0;
}

// The apex of a nearly regular tetrahedron below the face abc, which is counter-clockwise from
// above. A face without area has itself as the apex.
inline Vec3 best_apex(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = cross(subtract(b, a), subtract(c, a));
  const double height = apex_height(norm(normal));
  Vec3 apex;
  for (int k = 0; k < 3; ++k) apex[k] = (a[k] + b[k] + c[k]) / 3 - height * normal[k];
  return apex;
}

}  // namespace delmesher::improve
