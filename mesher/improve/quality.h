// The quality of a tetrahedron, as the improvement sees it: sines of its dihedral and face angles,
// which are small for small and for large angles alike, and how round it is. In doubles: it steers,
// and nothing that has to be exact depends on it. Products, quotients and square roots only, so
// that all machines agree.
#pragma once

#include <algorithm>
#include <cmath>

#include "mesher/base/ids.h"
#include "mesher/geometry/vector.h"

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

namespace detail {

// Of a tetrahedron abcd: six times its volume, its squared edges from a (u, v, w to b, c, d) and
// between these (p bc, q bd, r cd), and the squares of twice the areas of its faces.
struct Sizes {
  double volume, uu, vv, ww, pp, qq, rr, abc, abd, acd, bcd;
};

// Of the dihedral angles, squared sine: |n_f| |n_g| sin = 6 V |edge| for the two faces at an edge.
inline double smallest_dihedral(const Sizes& s) {
  const double h_abc = s.volume / s.abc, h_abd = s.volume / s.abd, h_acd = s.volume / s.acd,
               h_bcd = s.volume / s.bcd;
  return std::min({s.uu * h_abc * h_abd, s.vv * h_abc * h_acd, s.ww * h_abd * h_acd,
                   s.pp * h_abc * h_bcd, s.qq * h_abd * h_bcd, s.rr * h_acd * h_bcd});
}

// `center_squared`: of the circumcentre from a, times twice the volume.
template <class CenterSquared>
inline Quality quality_of(const Sizes& s, const Quality& least, CenterSquared&& center_squared) {
  Quality result;
  result.dihedral = positive_or_zero(smallest_dihedral(s));
  if (result.dihedral < least.dihedral) return result;
  const double face =
      std::min({smallest_angle(s.abc, s.uu, s.vv, s.pp), smallest_angle(s.abd, s.uu, s.ww, s.qq),
                smallest_angle(s.acd, s.vv, s.ww, s.rr), smallest_angle(s.bcd, s.pp, s.qq, s.rr)});
  result.face = positive_or_zero(face);
  if (result.face < least.face) return result;
  const double surface = std::sqrt(s.abc) + std::sqrt(s.abd) + std::sqrt(s.acd) + std::sqrt(s.bcd);
  const double inverse = s.volume / surface;
  const double gamma = 36 * inverse * inverse * (s.volume * s.volume / center_squared());
  result.gamma = positive_or_zero(gamma);
  return result;
}

// As quality(), of a nearly flat tetrahedron, by pairs of doubles where doubles cannot tell.
Quality accurate_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                         const Quality& least);

}  // namespace detail

// As soon as one value is below `least`, the values after it stay 0; of a nearly flat tetrahedron
// all may be 0 then. All are good to about 1e-6 of themselves, however flat or thin the tetrahedron
// is: otherwise what has to be no worse than something flat could be flatter by as much as doubles
// round, or inverted ones.
inline Quality quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                       const Quality& least = {}) {
  // Below this, six times the volume over the product of three edges, doubles tell little.
  constexpr double kFlat = 1e-10;
  const Vec3 u = subtract(b, a), v = subtract(c, a), w = subtract(d, a);
  const Vec3 abc = cross(u, v);
  const double volume = dot(abc, w);
  const double uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
  if (volume * volume <= kFlat * kFlat * (uu * vv * ww)) {
    return detail::accurate_quality(a, b, c, d, least);
  }
  if (!(volume > 0)) return {};
  const Vec3 p = subtract(c, b), q = subtract(d, b), r = subtract(d, c);
  const Vec3 abd = cross(w, u), acd = cross(v, w), bcd = cross(p, q);
  const detail::Sizes sizes = {volume,
                               uu,
                               vv,
                               ww,
                               dot(p, p),
                               dot(q, q),
                               dot(r, r),
                               dot(abc, abc),
                               dot(abd, abd),
                               dot(acd, acd),
                               dot(bcd, bcd)};
  return detail::quality_of(sizes, least, [&] {
    Vec3 center;
    for (int i = 0; i < 3; ++i) center[i] = ww * abc[i] + vv * abd[i] + uu * acd[i];
    return dot(center, center);
  });
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
