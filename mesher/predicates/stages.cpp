#include "mesher/predicates/stages.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace delmesher::predicates::stages {

ExactArguments::ExactArguments(const PointStore& points, const VertexId* ids, int n) : count(n) {
  bool whole = true;
  for (int i = 0; i < n; ++i) {
    points.exact(ids[i], point[i]);
    whole = whole && point[i].denominator.size == 0;
  }
  find_scale();
  if (!whole) find_factors();
}

ExactArguments::ExactArguments(std::span<const Vec3> points)
    : count(static_cast<int>(points.size())) {
  for (std::size_t i = 0; i < points.size(); ++i) set_exact(points[i], point[i]);
  find_scale();
}

void ExactArguments::find_factors() {
  std::vector<BigInteger> denominator, distinct;
  for (int i = 0; i < count; ++i) {
    const ExactCoordinate& d = point[i].denominator;
    denominator.emplace_back(d.limbs, static_cast<std::size_t>(d.size), false);
    if (d.size != 0 && std::ranges::find(distinct, denominator.back()) == distinct.end()) {
      distinct.push_back(denominator.back());
    }
  }
  for (const BigInteger& own : denominator) {
    factor.emplace_back(1);
    for (const BigInteger& d : distinct) {
      if (d != own) factor.back() = factor.back() * d;
    }
  }
}

void ExactArguments::find_scale() {
  std::int32_t low = std::numeric_limits<std::int32_t>::max();
  std::int32_t high = std::numeric_limits<std::int32_t>::min();
  for (int i = 0; i < count; ++i) {
    for (const ExactCoordinate& x : point[i].coordinate) {
      const std::int32_t limbs = x.size < 0 ? -x.size : x.size;
      if (limbs == 0) continue;
      low = std::min(low, x.exponent);
      high = std::max(
          high, x.exponent + 64 * limbs - std::countl_zero(std::uint64_t{x.limbs[limbs - 1]}));
    }
  }
  if (low > high) return;  // all zero
  exponent = low;
  bits = high - low;
}

}  // namespace delmesher::predicates::stages
