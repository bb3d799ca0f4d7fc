#include "mesher/predicates/exact_point.h"

#include <cstdlib>

namespace delmesher::predicates {

DyadicPoint exact_point(const PointStore& points, VertexId v) {
  ExactPosition position;
  points.exact(v, position);
  DyadicPoint result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const ExactCoordinate& x = position.coordinate[axis];
    const auto limbs = static_cast<std::size_t>(std::abs(x.size));
    result[axis] = {BigInteger(x.limbs, limbs, x.size < 0), x.exponent};
  }
  return result;
}

}  // namespace delmesher::predicates
