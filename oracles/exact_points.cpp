#include "oracles/exact_points.h"

#include <bit>
#include <cmath>
#include <limits>

namespace tetproof::oracles {
namespace {

using delmesher::ExactPoint;
using Kind = ExactPoint::Kind;

// value = mantissa * 2^exponent with an odd mantissa; a zero has no exponent to speak of.
struct Dyadic {
  std::int64_t mantissa = 0;
  int exponent = 0;
};

Dyadic dyadic(double value) {
  if (value == 0) return {};
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  Dyadic result{static_cast<std::int64_t>(std::ldexp(fraction, 53)), exponent - 53};
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(std::abs(result.mantissa)));
  result.mantissa >>= zeros;
  result.exponent += zeros;
  return result;
}

mpz_class scaled(const Dyadic& value, long exponent) {
  mpz_class result = static_cast<long>(value.mantissa);
  if (result != 0) result <<= static_cast<unsigned long>(value.exponent - exponent);
  return result;
}

void lower(long& exponent, double value, long offset) {
  if (value == 0) return;
  exponent = std::min(exponent, dyadic(value).exponent + offset);
}

// What `nearest`, made of it by to_double(), leaves of value * 2^exponent: to 2^-52 of itself, and
// 0 only if nothing. NaN where neither can be had; that decides nothing.
double rest(const mpz_class& value, long exponent, double nearest) {
  constexpr double kTiny = 0x1p-900;  // below it bits of the rest could get lost
  if (nearest == 0 && value == 0) return 0;
  if (!(std::fabs(nearest) >= kTiny) || !std::isfinite(nearest)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return to_double(value - scaled(dyadic(nearest), exponent), exponent);
}

std::string check_point(std::span<const ExactPoint> points, std::size_t index) {
  const ExactPoint& p = points[index];
  const std::string name = "point " + std::to_string(index);
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
    return name + " is not finite";
  }
  if (p.kind == Kind::explicit_point) return {};
  const bool triangle = p.kind == Kind::on_triangle;
  for (const Index corner : {p.i, p.j, triangle ? p.k : p.j}) {
    if (corner >= points.size() || points[corner].kind != Kind::explicit_point) {
      return name + " refers to " + std::to_string(corner) + ", which is not an explicit point";
    }
  }
  return {};
}

// Exponent at which every coordinate of every point is an integer.
long common_exponent(std::span<const ExactPoint> points) {
  long coordinate = std::numeric_limits<int>::max();
  for (const ExactPoint& p : points) {
    if (p.kind != Kind::explicit_point) continue;
    for (const double x : {p.x, p.y, p.z}) lower(coordinate, x, 0);
  }
  if (coordinate == std::numeric_limits<int>::max()) return 0;
  long parameter = 0;
  for (const ExactPoint& p : points) {
    if (p.kind == Kind::explicit_point) continue;
    lower(parameter, p.x, 0);
    if (p.kind == Kind::on_triangle) lower(parameter, p.y, 0);
  }
  return coordinate + parameter;
}

// Adds parameter * (to - from); the product is an integer by the choice of the common exponent.
void add_multiple(mpz_class& sum, double parameter, const mpz_class& from, const mpz_class& to) {
  const Dyadic t = dyadic(parameter);
  mpz_class term = (to - from) * static_cast<long>(t.mantissa);
  if (t.exponent >= 0) {
    term <<= static_cast<unsigned long>(t.exponent);
  } else {
    term >>= static_cast<unsigned long>(-t.exponent);  // exact
  }
  sum += term;
}

}  // namespace

double to_double(const mpz_class& value, long exponent) {
  long shift = 0;
  const double fraction = mpz_get_d_2exp(&shift, value.get_mpz_t());
  const long e = shift + exponent;
  return std::ldexp(fraction, static_cast<int>(std::clamp(e, -5000L, 5000L)));
}

double length(const IntegerVector& vector, long exponent) {
  return std::hypot(to_double(vector[0], exponent), to_double(vector[1], exponent),
                    to_double(vector[2], exponent));
}

std::vector<ExactPoint> explicit_points(std::span<const Position> positions) {
  std::vector<ExactPoint> points(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    points[i].x = positions[i][0];
    points[i].y = positions[i][1];
    points[i].z = positions[i][2];
  }
  return points;
}

std::string ExactPoints::assign(std::span<const Position> positions) {
  return assign(explicit_points(positions));
}

std::string ExactPoints::assign(std::span<const ExactPoint> points) {
  integers_.clear();
  nearest_.clear();
  rest_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::string why = check_point(points, i); !why.empty()) return why;
  }
  exponent_ = common_exponent(points);
  integers_.resize(points.size());
  nearest_.resize(points.size());
  rest_.assign(points.size(), {0, 0, 0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ExactPoint& p = points[i];
    if (p.kind != Kind::explicit_point) continue;
    const Position position = {p.x, p.y, p.z};
    for (int axis = 0; axis < 3; ++axis) {
      integers_[i][axis] = scaled(dyadic(position[axis]), exponent_);
    }
    nearest_[i] = position;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ExactPoint& p = points[i];
    if (p.kind == Kind::explicit_point) continue;
    const Index base = p.kind == Kind::on_triangle ? p.k : p.j;
    for (int axis = 0; axis < 3; ++axis) {
      mpz_class& value = integers_[i][axis];
      value = integers_[base][axis];
      add_multiple(value, p.x, integers_[base][axis], integers_[p.i][axis]);
      if (p.kind == Kind::on_triangle) {
        add_multiple(value, p.y, integers_[base][axis], integers_[p.j][axis]);
      }
      nearest_[i][axis] = to_double(value, exponent_);
      rest_[i][axis] = rest(value, exponent_, nearest_[i][axis]);
    }
  }
  bool rounded = false;
  largest_coordinate_ = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    rounded = rounded || points[i].kind != Kind::explicit_point;
    for (const double x : nearest_[i]) {
      largest_coordinate_ = std::max(largest_coordinate_, std::fabs(x));
    }
  }
  difference_error_ = rounded ? largest_coordinate_ * 0x1p-50 : 0;
  return {};
}

namespace exact {
namespace {

IntervalVector rough_difference(const ExactPoints& points, Index from, Index to) {
  return points.rough_difference(from, to);
}

template <class Number>
Number determinant3(const std::array<Number, 3>& u, const std::array<Number, 3>& v,
                    const std::array<Number, 3>& w) {
  return Number(u[0] * Number(v[1] * w[2] - v[2] * w[1]) -
                u[1] * Number(v[0] * w[2] - v[2] * w[0]) +
                u[2] * Number(v[0] * w[1] - v[1] * w[0]));
}

template <class Number>
Number square(const std::array<Number, 3>& v) {
  return Number(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

template <class Number>
std::array<Number, 3> product(const std::array<Number, 3>& u, const std::array<Number, 3>& v) {
  return {Number(u[1] * v[2] - u[2] * v[1]), Number(u[2] * v[0] - u[0] * v[2]),
          Number(u[0] * v[1] - u[1] * v[0])};
}

// The circumcentre of 0, u, v is (|u|^2 (v x n) + |v|^2 (n x u)) / (2 |n|^2) with n = u x v; the
// value is |w - centre|^2 less the squared radius, times |n|^2.
template <class Number>
Number diametral(const std::array<Number, 3>& u, const std::array<Number, 3>& v,
                 const std::array<Number, 3>& w) {
  const std::array<Number, 3> n = product(u, v), p = product(v, n), q = product(n, u);
  const Number uu = square(u), vv = square(v);
  Number sum = Number(square(w) * square(n));
  for (int i = 0; i < 3; ++i) sum = Number(sum - w[i] * Number(uu * p[i] + vv * q[i]));
  return sum;
}

// Determinant of the four rows (x - e, |x - e|^2) with the sign turned so that inside is positive.
template <class Number>
Number insphere_determinant(const std::array<std::array<Number, 3>, 4>& r) {
  const Number bcd = determinant3(r[1], r[2], r[3]);
  const Number acd = determinant3(r[0], r[2], r[3]);
  const Number abd = determinant3(r[0], r[1], r[3]);
  const Number abc = determinant3(r[0], r[1], r[2]);
  return Number(Number(square(r[0]) * bcd - square(r[1]) * acd) +
                Number(square(r[2]) * abd - square(r[3]) * abc));
}

}  // namespace

IntegerVector difference(const ExactPoints& points, Index from, Index to) {
  const IntegerVector &p = points.integer(from), &q = points.integer(to);
  return {mpz_class(q[0] - p[0]), mpz_class(q[1] - p[1]), mpz_class(q[2] - p[2])};
}

mpz_class dot(const IntegerVector& u, const IntegerVector& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

IntegerVector cross(const IntegerVector& u, const IntegerVector& v) {
  return {mpz_class(u[1] * v[2] - u[2] * v[1]), mpz_class(u[2] * v[0] - u[0] * v[2]),
          mpz_class(u[0] * v[1] - u[1] * v[0])};
}

bool is_zero(const IntegerVector& v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

bool equal(const ExactPoints& points, Index a, Index b) {
  return points.integer(a) == points.integer(b);
}

double distance(const ExactPoints& points, Index a, Index b) {
  return length(difference(points, a, b), points.exponent());
}

mpz_class volume6(const ExactPoints& points, Index a, Index b, Index c, Index d) {
  thread_local Volume6 volume6;  // allocating takes longer than the arithmetic
  return volume6(points, {a, b, c, d});
}

const mpz_class& Volume6::operator()(const ExactPoints& points,
                                     const std::array<Index, 4>& tetrahedron) {
  const IntegerVector& origin = points.integer(tetrahedron[0]);
  IntegerVector* const to[3] = {&u_, &v_, &w_};
  for (int i = 0; i < 3; ++i) {
    const IntegerVector& p = points.integer(tetrahedron[i + 1]);
    for (int axis = 0; axis < 3; ++axis) {
      mpz_sub((*to[i])[axis].get_mpz_t(), p[axis].get_mpz_t(), origin[axis].get_mpz_t());
    }
  }
  return determinant(u_, v_, w_);
}

const mpz_class& Volume6::from_origin(const ExactPoints& points,
                                      const std::array<Index, 3>& triangle) {
  return determinant(points.integer(triangle[0]), points.integer(triangle[1]),
                     points.integer(triangle[2]));
}

const mpz_class& Volume6::determinant(const IntegerVector& u, const IntegerVector& v,
                                      const IntegerVector& w) {
  value_ = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    mpz_mul(minor_.get_mpz_t(), v[j].get_mpz_t(), w[k].get_mpz_t());
    mpz_submul(minor_.get_mpz_t(), v[k].get_mpz_t(), w[j].get_mpz_t());
    mpz_addmul(value_.get_mpz_t(), u[i].get_mpz_t(), minor_.get_mpz_t());
  }
  return value_;
}

Interval rough_volume6(const ExactPoints& points, const std::array<Index, 4>& tetrahedron) {
  const auto& [a, b, c, d] = tetrahedron;
  return determinant3(rough_difference(points, a, b), rough_difference(points, a, c),
                      rough_difference(points, a, d));
}

int orient3d(const ExactPoints& points, Index a, Index b, Index c, Index d) {
  const int sign = rough_volume6(points, {a, b, c, d}).sign();
  if (sign != 2) return sign;
  thread_local Volume6 volume6;
  return sgn(volume6(points, {a, b, c, d}));
}

int insphere(const ExactPoints& points, Index a, Index b, Index c, Index d, Index e) {
  const Interval rough = insphere_determinant<Interval>(
      {rough_difference(points, e, a), rough_difference(points, e, b),
       rough_difference(points, e, c), rough_difference(points, e, d)});
  const int sign = rough.sign();
  if (sign != 2) return sign;
  return sgn(insphere_determinant<mpz_class>({difference(points, e, a), difference(points, e, b),
                                              difference(points, e, c), difference(points, e, d)}));
}

mpz_class squared(const IntegerVector& v) {
  return dot(v, v);
}

int dot_sign(const ExactPoints& points, Index apex, Index p, Index q) {
  const IntervalVector u = rough_difference(points, apex, p), v = rough_difference(points, apex, q);
  const int sign = (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]).sign();
  if (sign != 2) return sign;
  return sgn(dot(difference(points, apex, p), difference(points, apex, q)));
}

bool in_diametral_ball(const ExactPoints& points, Index a, Index b, Index c, Index d) {
  const int sign =
      diametral<Interval>(rough_difference(points, a, b), rough_difference(points, a, c),
                          rough_difference(points, a, d))
          .sign();
  if (sign != 2) return sign < 0;
  return diametral<mpz_class>(difference(points, a, b), difference(points, a, c),
                              difference(points, a, d)) < 0;
}

IntegerVector area2(const ExactPoints& points, Index a, Index b, Index c) {
  return cross(difference(points, a, b), difference(points, a, c));
}

IntervalVector rough_area2(const ExactPoints& points, Index a, Index b, Index c) {
  return cross(rough_difference(points, a, b), rough_difference(points, a, c));
}

bool collinear(const ExactPoints& points, Index a, Index b, Index c) {
  const IntervalVector u = rough_difference(points, a, b), v = rough_difference(points, a, c);
  for (int axis = 0; axis < 3; ++axis) {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    const int sign = (u[i] * v[j] - u[j] * v[i]).sign();
    if (sign == 1 || sign == -1) return false;
  }
  return is_zero(area2(points, a, b, c));
}

}  // namespace exact
}  // namespace tetproof::oracles
