#include "oracles/base/distances.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tetproof::oracles {

mpq_class squared_distance_to_segment(const ExactPoints& points, Index v, Index a, Index b) {
  const ExactVector d = exact::difference(points, a, b), w = exact::difference(points, a, v);
  if (exact::dot(d, w) <= 0) return exact::squared(w).rational();
  const ExactVector u = exact::difference(points, b, v);
  if (exact::dot(d, u) >= 0) return exact::squared(u).rational();
  return ratio(exact::squared(exact::cross(d, w)), exact::squared(d));
}

namespace {

// Is a share certainly not between 0 and 1, for it and 1 times something positive?
bool surely_outside(const Interval& share, const Interval& whole) {
  return share.sign() == -1 || (share - whole).sign() == 1;
}

// As in squared_distance_inside.
bool surely_not_inside(const ExactPoints& points, Index a, Index b, Index c, Index d) {
  const IntervalVector u = points.rough_difference(a, b), v = points.rough_difference(c, d),
                       w = points.rough_difference(a, c), n = exact::cross(u, v);
  const Interval nn = exact::dot(n, n);
  return surely_outside(exact::dot(exact::cross(w, v), n), nn) ||
         surely_outside(exact::dot(exact::cross(w, u), n), nn);
}

}  // namespace

mpq_class squared_distance_inside(const ExactPoints& points, Index a, Index b, Index c, Index d) {
  if (surely_not_inside(points, a, b, c, d)) return -1;
  const ExactVector u = exact::difference(points, a, b), v = exact::difference(points, c, d),
                    w = exact::difference(points, a, c), n = exact::cross(u, v);
  const ExactNumber nn = exact::squared(n);
  if (nn == 0) return -1;
  // a + s u and c + t v are closest at s = det(w, v, n) / |n|^2, t = det(w, u, n) / |n|^2.
  const ExactNumber s = exact::dot(exact::cross(w, v), n), t = exact::dot(exact::cross(w, u), n);
  if (s <= 0 || s >= nn || t <= 0 || t >= nn) return -1;
  const ExactNumber height = exact::dot(w, n);
  return ratio(height * height, nn);
}

mpq_class squared_distance_to_face(const ExactPoints& points, Index v,
                                   const std::array<Index, 3>& triangle) {
  const IntervalVector rough = exact::rough_area2(points, triangle[0], triangle[1], triangle[2]);
  for (int i = 0; i < 3; ++i) {
    const Index p = triangle[i], q = triangle[(i + 1) % 3];
    if (exact::dot(rough, exact::rough_area2(points, p, q, v)).sign() == -1) return -1;
  }
  const ExactVector n = exact::area2(points, triangle[0], triangle[1], triangle[2]);
  if (exact::is_zero(n)) return -1;
  for (int i = 0; i < 3; ++i) {
    const Index p = triangle[i], q = triangle[(i + 1) % 3];
    if (exact::dot(n, exact::area2(points, p, q, v)) < 0) return -1;
  }
  const ExactNumber height = exact::dot(n, exact::difference(points, triangle[0], v));
  return ratio(height * height, exact::squared(n));
}

bool lies_on_face(const ExactPoints& points, Index v, const std::array<Index, 3>& triangle) {
  const Index a = triangle[0], b = triangle[1], c = triangle[2];
  if (exact::orient3d(points, a, b, c, v) != 0) return false;
  const IntervalVector rough = exact::rough_area2(points, a, b, c);
  if (exact::dot(rough, rough).sign() != 1 && exact::is_zero(exact::area2(points, a, b, c))) {
    return false;
  }
  const auto left = [&](Index p, Index q) {
    if (v == p || v == q || points.is_combination(v, {p, q, q})) return true;
    const int sign = exact::dot(rough, exact::rough_area2(points, p, q, v)).sign();
    if (sign != 2) return sign >= 0;
    return exact::dot(exact::area2(points, a, b, c), exact::area2(points, p, q, v)) >= 0;
  };
  return left(a, b) && left(b, c) && left(c, a);
}

mpq_class squared_distance_to_triangle(const ExactPoints& points, Index v,
                                       const std::array<Index, 3>& triangle) {
  const mpq_class face = squared_distance_to_face(points, v, triangle);
  if (face >= 0) return face;
  const auto& [a, b, c] = triangle;
  return std::min({squared_distance_to_segment(points, v, a, b),
                   squared_distance_to_segment(points, v, b, c),
                   squared_distance_to_segment(points, v, c, a)});
}

double square_root(const mpq_class& squared, long exponent) {
  long above = 0, below = 0;
  double ratio = mpz_get_d_2exp(&above, squared.get_num_mpz_t()) /
                 mpz_get_d_2exp(&below, squared.get_den_mpz_t());
  long power = above - below;
  if (power % 2 != 0) {
    ratio *= 2;
    --power;
  }
  return std::ldexp(std::sqrt(ratio), static_cast<int>(power / 2 + exponent));
}

namespace {

// The exponent of about the largest component.
long size_of(const ExactVector& vector) {
  const auto bits = [](const mpz_class& n) {
    return static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 2));
  };
  long largest = std::numeric_limits<int>::min();
  for (const ExactNumber& x : vector) {
    if (x != 0) largest = std::max(largest, bits(x.numerator()) - bits(x.denominator()));
  }
  return largest;
}

}  // namespace

double component(const ExactNumber& product, const ExactVector& along, long exponent) {
  if (product == 0) return 0;
  const long size = size_of(along);
  const double value = to_double(product, exponent - size) / length(along, -size);
  return value != 0 ? value : std::copysign(0x1p-1074, product > 0 ? 1 : -1);
}

double length_over(const ExactVector& vector, const ExactVector& along, long exponent) {
  if (exact::is_zero(vector)) return 0;
  const long size = size_of(along);
  const double value = length(vector, exponent - size) / length(along, -size);
  return std::max(value, 0x1p-1074);
}

mpq_class times_power_of_two(mpq_class value, long exponent) {
  if (exponent >= 0) {
    mpq_mul_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<unsigned long>(exponent));
  } else {
    mpq_div_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<unsigned long>(-exponent));
  }
  return value;
}

}  // namespace tetproof::oracles
