#include "mesher/improve/quality.h"

#include <array>

#include "mesher/arithmetic/bounded.h"

namespace delmesher::improve::detail {
namespace {

using Pair = arithmetic::BoundedPair;
using PairVec = std::array<Pair, 3>;

// Exact, unless the difference is far below the last place of the larger one.
PairVec difference(const Vec3& x, const Vec3& y) {
  PairVec result;
  for (std::size_t i = 0; i < 3; ++i) {
    arithmetic::two_sum(x[i], -y[i], result[i].high, result[i].low);
  }
  return result;
}

PairVec cross_of(const PairVec& x, const PairVec& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

Pair dot_of(const PairVec& x, const PairVec& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

double square(const PairVec& x) {
  return dot_of(x, x).high;
}

}  // namespace

Quality accurate_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                         const Quality& least) {
  const PairVec u = difference(b, a), v = difference(c, a), w = difference(d, a);
  const PairVec abc = cross_of(u, v);
  const Pair volume = dot_of(abc, w);
  if (volume.sign() != 1) return {};
  const PairVec p = difference(c, b), q = difference(d, b), r = difference(d, c);
  const PairVec abd = cross_of(w, u), acd = cross_of(v, w), bcd = cross_of(p, q);
  const Sizes sizes = {volume.high, square(u),   square(v),   square(w),   square(p),  square(q),
                       square(r),   square(abc), square(abd), square(acd), square(bcd)};
  return quality_of(sizes, least, [&] {
    const Pair uu = dot_of(u, u), vv = dot_of(v, v), ww = dot_of(w, w);
    PairVec center;
    for (std::size_t i = 0; i < 3; ++i) center[i] = ww * abc[i] + vv * abd[i] + uu * acd[i];
    return square(center);
  });
}

}  // namespace delmesher::improve::detail
