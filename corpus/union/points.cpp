#include "corpus/union/points.h"

namespace tetproof::unite {
namespace {

// The double closest to an exact number.
template <class Number>
double nearest(const Number& x) {
  const auto [low, high] = CGAL::to_interval(x);
  return x - Number(low) <= Number(high) - x ? low : high;
}

}  // namespace

Position Points::rounded(Index i) const {
  if (is_given(i)) return given_[i];
  const Exact::Point_3 p = (*this)[i];
  return {nearest(CGAL::exact(p.x())), nearest(CGAL::exact(p.y())), nearest(CGAL::exact(p.z()))};
}

Position Points::approximate(Index i) const {
  if (is_given(i)) return given_[i];
  const Exact::Point_3 p = (*this)[i];
  return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
}

int axis_across(const Points& points, const Triangle& triangle) {
  const Exact::Point_3 a = points[triangle[0]];
  const Exact::Vector_3 normal =
      CGAL::cross_product(points[triangle[1]] - a, points[triangle[2]] - a);
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (CGAL::abs(normal.cartesian(k)) > CGAL::abs(normal.cartesian(axis))) axis = k;
  }
  return axis;
}

Exact::Point_2 projected(const Exact::Point_3& p, int axis) {
  return {p.cartesian((axis + 1) % 3), p.cartesian((axis + 2) % 3)};
}

}  // namespace tetproof::unite
