#include "mesher/predicates/exact_point.h"

#include <cstdlib>

#include "mesher/predicates/common_denominator.h"

namespace delmesher::predicates {

RationalPoint exact_point(const PointStore& points, VertexId v) {
  const auto integer = [](const ExactCoordinate& x) {
    return BigInteger(x.limbs, static_cast<std::size_t>(std::abs(x.size)), x.size < 0);
  };
  ExactPosition position;
  points.exact(v, position);
  RationalPoint result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const ExactCoordinate& x = position.coordinate[axis];
    result.numerator[axis] = {integer(x), x.exponent};
  }
  if (position.denominator.size != 0) result.denominator = integer(position.denominator);
  return result;
}

std::vector<DyadicPoint> scaled_exact_points(const PointStore& points,
                                             std::span<const VertexId> vertices) {
  std::vector<RationalPoint> exact;
  exact.reserve(vertices.size());
  for (const VertexId v : vertices) exact.push_back(exact_point(points, v));
  to_common_denominator(exact);
  std::vector<DyadicPoint> result;
  result.reserve(exact.size());
  for (RationalPoint& p : exact) result.push_back(std::move(p.numerator));
  return result;
}

DyadicPoint dyadic_point(const PointStore& points, VertexId v) {
  RationalPoint exact = exact_point(points, v);
  if (exact.denominator == BigInteger(1)) return std::move(exact.numerator);
  // Long division by doubles, five rounds of some 50 bits.
  DyadicPoint result;
  const Dyadic denominator{exact.denominator, 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Dyadic rest = exact.numerator[axis];
    for (int round = 0; round < 5 && rest.sign() != 0; ++round) {
      const Dyadic digits = leading_digits_of_quotient(rest, denominator);
      result[axis] = result[axis] + digits;
      rest = rest - digits * denominator;
    }
  }
  return result;
}

}  // namespace delmesher::predicates
