#include "oracles/base/exact_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "oracles/base/distances.h"
#include "oracles/base/steps.h"

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

void set_scaled(const Dyadic& value, long exponent, mpz_class& x) {
  x = static_cast<double>(value.mantissa);  // a long may have 32 bits
  if (value.mantissa == 0) return;
  mpz_mul_2exp(x.get_mpz_t(), x.get_mpz_t(), static_cast<unsigned long>(value.exponent - exponent));
}

mpz_class scaled(const Dyadic& value, long exponent) {
  mpz_class result;
  set_scaled(value, exponent, result);
  return result;
}

void lower(long& exponent, double value, long offset) {
  if (value == 0) return;
  exponent = std::min(exponent, dyadic(value).exponent + offset);
}

// numerator / denominator * 2^exponent, rounded towards zero, to 64 bits and then to an ulp;
// without a denominator, it is 1. Allocating takes longer than the arithmetic.
double quotient(const mpz_class& numerator, const mpz_class* denominator, long exponent) {
  thread_local mpz_class scaled;
  const mpz_class* value = &numerator;
  if (denominator != nullptr) {
    const auto bits = [](const mpz_class& n) {
      return static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 2));
    };
    const long missing = std::max(0L, 64 + bits(*denominator) - bits(numerator));
    mpz_mul_2exp(scaled.get_mpz_t(), numerator.get_mpz_t(), static_cast<unsigned long>(missing));
    mpz_tdiv_q(scaled.get_mpz_t(), scaled.get_mpz_t(), denominator->get_mpz_t());
    value = &scaled;
    exponent -= missing;
  }
  long shift = 0;
  const double fraction = mpz_get_d_2exp(&shift, value->get_mpz_t());
  const long e = shift + exponent;
  return std::ldexp(fraction, static_cast<int>(std::clamp(e, -5000L, 5000L)));
}

const mpz_class* denominator_of(const ExactNumber& value) {
  return value.is_integer() ? nullptr : &*value.shared_denominator();
}

// The rest of value * 2^exponent beyond its double `nearest`, to 2^-52 of itself. The rest is 0
// only if the double is exact, and NaN, which decides nothing, where the rest cannot be had.
double rest(const ExactNumber& value, long exponent, double nearest) {
  constexpr double kTiny = 0x1p-900;  // below it bits of the rest could get lost
  if (nearest == 0 && value == 0) return 0;
  if (!(std::fabs(nearest) >= kTiny) || !std::isfinite(nearest)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  // The double of a rational need not be a multiple of the unit.
  const Dyadic d = dyadic(nearest);
  const long lowest = std::min<long>(exponent, d.exponent);
  thread_local mpz_class exact, rounded;
  mpz_mul_2exp(exact.get_mpz_t(), value.numerator().get_mpz_t(),
               static_cast<unsigned long>(exponent - lowest));
  set_scaled(d, lowest, rounded);
  const mpz_class* denominator = denominator_of(value);
  if (denominator != nullptr) rounded *= *denominator;
  exact -= rounded;
  return quotient(exact, denominator, lowest);
}

bool is_corner(const ExactPoint& p) {
  return p.kind == Kind::explicit_point || p.kind == Kind::on_planes;
}

std::string check_point(std::span<const ExactPoint> points, std::size_t planes, std::size_t index) {
  const ExactPoint& p = points[index];
  const std::string name = "point " + std::to_string(index);
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
    return name + " is not finite";
  }
  if (p.kind == Kind::explicit_point) return {};
  if (p.kind == Kind::on_planes) {
    for (const Index plane : {p.i, p.j, p.k}) {
      if (plane < planes) continue;
      return name + " refers to plane " + std::to_string(plane) + ", which does not exist";
    }
    return {};
  }
  const bool triangle = p.kind == Kind::on_triangle;
  for (const Index corner : {p.i, p.j, triangle ? p.k : p.j}) {
    if (corner >= points.size() || !is_corner(points[corner])) {
      return name + " refers to " + std::to_string(corner) + ", which is not a corner";
    }
  }
  return {};
}

using Integers = std::array<mpz_class, 3>;

// normal . x = offset * 2^exponent, of any length. Integers, because the fractions that rational
// numbers reduce again and again take most of the time that points on planes take.
struct Equation {
  Integers normal;
  mpz_class offset;
  long exponent;
};

Integers cross(const Integers& u, const Integers& v) {
  Integers n;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    n[i] = u[j] * v[k] - u[k] * v[j];
  }
  return n;
}

mpz_class dot(const Integers& u, const Integers& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

// The exponent at which all numbers are integers.
long common_exponent(std::span<const std::array<double, 3>> vectors) {
  long exponent = std::numeric_limits<int>::max();
  for (const auto& x : vectors) {
    for (const double value : x) lower(exponent, value, 0);
  }
  return exponent == std::numeric_limits<int>::max() ? 0 : exponent;
}

Integers scaled(const std::array<double, 3>& x, long exponent) {
  return {scaled(dyadic(x[0]), exponent), scaled(dyadic(x[1]), exponent),
          scaled(dyadic(x[2]), exponent)};
}

Equation equation(const delmesher::ExactRecord::Plane& plane) {
  const std::span through(plane.through);
  Equation result;
  result.exponent = common_exponent(plane.spanned ? through : through.first(1));
  const Integers a = scaled(through[0], result.exponent);
  if (plane.spanned) {
    Integers u = scaled(through[1], result.exponent), v = scaled(through[2], result.exponent);
    for (int i = 0; i < 3; ++i) {
      u[i] -= a[i];
      v[i] -= a[i];
    }
    result.normal = cross(u, v);
  } else {
    result.normal = scaled(plane.normal, common_exponent({&plane.normal, 1}));
  }
  result.offset = dot(result.normal, a);
  return result;
}

bool is_finite_plane(const delmesher::ExactRecord::Plane& plane) {
  for (const double x : plane.normal) {
    if (!std::isfinite(x)) return false;
  }
  for (const auto& p : plane.through) {
    for (const double x : p) {
      if (!std::isfinite(x)) return false;
    }
  }
  return true;
}

mpz_class shifted(const mpz_class& value, long exponent) {
  return value << static_cast<unsigned long>(exponent);
}

// numerators * 2^exponent / denominator, which is odd, positive, and in lowest terms with all three
// together.
struct Meeting {
  Integers numerators;
  mpz_class denominator;
  long exponent;
};

long zeros(const mpz_class& n) {
  return static_cast<long>(mpz_scan1(n.get_mpz_t(), 0));
}

// The point where three planes meet (Cramer's rule); nothing if they do not meet in one point.
std::optional<Meeting> meeting_point(const Equation& p, const Equation& q, const Equation& r) {
  const Integers qr = cross(q.normal, r.normal), rp = cross(r.normal, p.normal),
                 pq = cross(p.normal, q.normal);
  const mpz_class determinant = dot(p.normal, qr);
  if (determinant == 0) return std::nullopt;
  const long exponent = std::min({p.exponent, q.exponent, r.exponent});
  const Integers offsets = {shifted(p.offset, p.exponent - exponent),
                            shifted(q.offset, q.exponent - exponent),
                            shifted(r.offset, r.exponent - exponent)};
  const long even = zeros(determinant);
  Meeting x{.numerators = {}, .denominator = determinant >> even, .exponent = exponent - even};
  mpz_class common = x.denominator;
  for (std::size_t i = 0; i < 3; ++i) {
    x.numerators[i] = offsets[0] * qr[i] + offsets[1] * rp[i] + offsets[2] * pq[i];
    common = gcd(common, x.numerators[i]);
  }
  if (determinant < 0) common = -common;
  x.denominator /= common;
  for (mpz_class& n : x.numerators) n /= common;
  return x;
}

// For coordinates times 2^-exponent.
ExactPoints::IntegerPlane integer_plane(const Equation& plane, long exponent) {
  const long larger = plane.exponent - exponent, shift = std::max(0L, -larger);
  return {{shifted(plane.normal[0], shift), shifted(plane.normal[1], shift),
           shifted(plane.normal[2], shift)},
          shifted(plane.offset, std::max(0L, larger))};
}

constexpr long kNoExponent = std::numeric_limits<int>::max();

// The exponent at which every coordinate of every corner is an integer, over an odd denominator for
// the corners in `moved`; kNoExponent if all are 0.
long corner_exponent(std::span<const ExactPoint> points,
                     const std::vector<std::pair<Index, Meeting>>& moved) {
  long exponent = kNoExponent;
  for (const ExactPoint& p : points) {
    if (p.kind != Kind::explicit_point) continue;
    for (const double x : {p.x, p.y, p.z}) lower(exponent, x, 0);
  }
  for (const auto& [index, place] : moved) {
    for (const mpz_class& n : place.numerators) {
      if (n != 0) exponent = std::min(exponent, place.exponent + zeros(n));
    }
  }
  return exponent;
}

// The amount by which the parameters of points on segments and triangles lower the exponent.
long parameter_exponent(std::span<const ExactPoint> points) {
  long parameter = 0;
  for (const ExactPoint& p : points) {
    if (is_corner(p)) continue;
    lower(parameter, p.x, 0);
    if (p.kind == Kind::on_triangle) lower(parameter, p.y, 0);
  }
  return parameter;
}

// Adds parameter * (to - from); the product is an integer by the choice of the common exponent.
void add_multiple(mpz_class& sum, double parameter, const mpz_class& from, const mpz_class& to) {
  thread_local mpz_class step, mantissa;
  const Dyadic t = dyadic(parameter);
  mantissa = static_cast<double>(t.mantissa);  // a long may have 32 bits
  mpz_sub(step.get_mpz_t(), to.get_mpz_t(), from.get_mpz_t());
  mpz_mul(step.get_mpz_t(), step.get_mpz_t(), mantissa.get_mpz_t());
  if (t.exponent >= 0) {
    mpz_mul_2exp(step.get_mpz_t(), step.get_mpz_t(), static_cast<unsigned long>(t.exponent));
  } else {
    mpz_tdiv_q_2exp(step.get_mpz_t(), step.get_mpz_t(), static_cast<unsigned long>(-t.exponent));
  }
  mpz_add(sum.get_mpz_t(), sum.get_mpz_t(), step.get_mpz_t());
}

}  // namespace

double to_double(const ExactNumber& value, long exponent) {
  return quotient(value.numerator(), denominator_of(value), exponent);
}

double length(const ExactVector& vector, long exponent) {
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

std::span<const Index> ExactPoints::corners_of(const Index& v) const {
  if (is_double(v)) return {&v, 1};
  const Defined& p = defined_[implicit_[v]];
  if (p.corners[0] == kNone) return {&v, 1};
  return {p.corners.data(), p.corners[2] == kNone ? 2U : 3U};
}

Index ExactPoints::corner_of_segment(Index a, Index b) const {
  for (const auto& [given, other] : {std::pair(a, b), std::pair(b, a)}) {
    if (is_double(given)) continue;
    const auto [i, j, k] = defined_[implicit_[given]].corners;
    if (i == kNone || k != kNone) continue;
    if (other == i || other == j || is_combination(other, {i, j, j})) return std::min(i, j);
  }
  return kNone;
}

Index ExactPoints::common_plane(std::span<const Index> vertices) const {
  if (planes_.empty() || vertices.empty()) return kNone;
  const Index first = corners_of(vertices[0])[0];
  if (is_double(first)) return kNone;
  for (const Index plane : planes_of_[defined_[implicit_[first]].placed]) {
    if (plane != kNone && std::all_of(vertices.begin(), vertices.end(),
                                      [&](Index v) { return is_defined_on(v, plane); })) {
      return plane;
    }
  }
  return kNone;
}

bool ExactPoints::surely_coplanar(std::span<const Index> vertices) const {
  std::array<Index, 3> all;
  std::size_t count = 0;
  for (const Index& v : vertices) {
    for (const Index corner : corners_of(v)) {
      if (std::find(all.begin(), all.begin() + count, corner) != all.begin() + count) continue;
      if (count == 3) return common_plane(vertices) != kNone;
      all[count++] = corner;
    }
  }
  return true;
}

bool ExactPoints::is_defined_on(Index v, Index plane) const {
  const std::span<const Index> corners = corners_of(v);
  return std::all_of(corners.begin(), corners.end(), [&](Index corner) {
    if (is_double(corner)) return false;
    const auto& planes = planes_of_[defined_[implicit_[corner]].placed];
    return std::find(planes.begin(), planes.end(), plane) != planes.end();
  });
}

int ExactPoints::side_of(Index plane, Index v) const {
  return cmp(exact::dot(normal_of(plane), exact(v)), ExactNumber(planes_[plane].offset));
}

ExactVector ExactPoints::normal_of(Index plane) const {
  const auto& normal = planes_[plane].normal;
  return {ExactNumber(normal[0]), ExactNumber(normal[1]), ExactNumber(normal[2])};
}

// Those of at least three points: a plane of fewer has no facet.
void ExactPoints::keep_planes(std::span<const ExactPoint> points, std::size_t planes,
                              const std::function<IntegerPlane(std::size_t)>& plane) {
  std::vector<Index> uses(planes), number(planes, kNone);
  for (const ExactPoint& p : points) {
    if (p.kind != Kind::on_planes) continue;
    for (const Index n : {p.i, p.j, p.k}) ++uses[n];
  }
  for (std::size_t n = 0; n < planes; ++n) {
    if (uses[n] < 3) continue;
    number[n] = static_cast<Index>(planes_.size());
    planes_.push_back(plane(n));
  }
  for (const ExactPoint& p : points) {
    if (p.kind == Kind::on_planes) planes_of_.push_back({number[p.i], number[p.j], number[p.k]});
  }
}

std::string ExactPoints::place_on_planes(std::span<const ExactPoint> points, Planes planes) {
  std::vector<Equation> equations;
  for (std::size_t n = 0; n < planes.size(); ++n) {
    if (!is_finite_plane(planes[n])) return "plane " + std::to_string(n) + " is not finite";
    equations.push_back(equation(planes[n]));
  }
  std::vector<std::pair<Index, Meeting>> moved;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ExactPoint& p = points[i];
    if (p.kind != Kind::on_planes) continue;
    auto place = meeting_point(equations[p.i], equations[p.j], equations[p.k]);
    if (!place) return "point " + std::to_string(i) + " is on planes that do not meet in one point";
    moved.emplace_back(static_cast<Index>(i), std::move(*place));
  }
  exponent_ = corner_exponent(points, moved);
  exponent_ = exponent_ == kNoExponent ? 0 : exponent_ + parameter_exponent(points);
  for (auto& [i, place] : moved) {
    // Over one denominator, as sums of products of these coordinates need none then. What is
    // shifted out are zeros.
    const long shift = place.exponent - exponent_;
    for (mpz_class& n : place.numerators) {
      n = shift >= 0 ? shifted(n, shift) : mpz_class(n >> static_cast<unsigned long>(-shift));
    }
    all_integers_ = all_integers_ && place.denominator == 1;
    implicit_[i] = static_cast<Index>(defined_.size());
    defined_.emplace_back().placed = static_cast<Index>(placed_.size());
    placed_.push_back(place.numerators, ExactNumber::Denominator(std::move(place.denominator)));
  }
  keep_planes(points, planes.size(),
              [&](std::size_t n) { return integer_plane(equations[n], exponent_); });
  return {};
}

void ExactPoints::define(Index i, const ExactPoint& p, Denominators& known) {
  Defined point{};
  point.corners = {p.i, p.j, p.kind == Kind::on_triangle ? p.k : kNone};
  point.u = p.x;
  point.v = p.y;
  const bool integers = is_integer(p.i) && is_integer(p.j) &&
                        (point.corners[2] == kNone || is_integer(point.corners[2]));
  if (!integers) place_combined(point, known);
  implicit_[i] = static_cast<Index>(defined_.size());
  defined_.push_back(point);
}

void ExactPoints::combine_integers(const Defined& point, std::array<mpz_class, 3>& x) const {
  thread_local std::array<mpz_class, 3> other, base;
  const auto [i, j, k] = point.corners;
  integers(k == kNone ? j : k, base);
  integers(i, other);
  x = base;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add_multiple(x[axis], point.u, base[axis], other[axis]);
  }
  if (k == kNone) return;
  integers(j, other);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add_multiple(x[axis], point.v, base[axis], other[axis]);
  }
}

// A point is the sum of its corners, each times its share. All points of a segment or triangle have
// one denominator, the product of those of the corners, so that their differences need none.
void ExactPoints::place_combined(Defined& point, Denominators& known) {
  const bool segment = point.corners[2] == kNone;
  const Dyadic u = dyadic(point.u), v = segment ? Dyadic{} : dyadic(point.v);
  const auto shift = static_cast<unsigned long>(std::max({0, -u.exponent, -v.exponent}));
  const long unit = -static_cast<long>(shift);
  std::array<mpz_class, 3> shares = {scaled(u, unit), scaled(v, unit), mpz_class(1) << shift};
  shares[2] -= shares[0] + shares[1];
  if (segment) shares[1] = shares[2];
  const std::size_t count = segment ? 2 : 3;
  std::array<ExactVector, 3> corners;
  std::array<mpz_class, 3> denominator;
  mpz_class common = 1;
  for (std::size_t c = 0; c < count; ++c) {
    corners[c] = exact(point.corners[c]);
    denominator[c] = corners[c][0].denominator();
    common *= denominator[c];
  }
  std::array<mpz_class, 3> sum;
  for (std::size_t c = 0; c < count; ++c) {
    mpz_class factor = shares[c];
    for (std::size_t other = 0; other < count; ++other) {
      if (other != c) factor *= denominator[other];
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      mpz_addmul(sum[axis].get_mpz_t(), corners[c][axis].numerator().get_mpz_t(),
                 factor.get_mpz_t());
    }
  }
  for (mpz_class& x : sum) mpz_tdiv_q_2exp(x.get_mpz_t(), x.get_mpz_t(), shift);  // no rest
  const auto [at, fresh] = known.try_emplace(point.corners);
  if (fresh) at->second = ExactNumber::Denominator(std::move(common));
  point.placed = static_cast<Index>(placed_.size());
  placed_.push_back(sum, at->second);
}

void ExactPoints::integers(Index i, std::array<mpz_class, 3>& x) const {
  if (implicit_[i] != kNone) {
    const Defined& point = defined_[implicit_[i]];
    if (point.placed == kNone) return combine_integers(point, x);
    return placed_.numerators(point.placed, x);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    set_scaled(dyadic(nearest_[i][axis]), exponent_, x[axis]);
  }
}

ExactVector ExactPoints::exact(Index i) const {
  if (!is_integer(i)) return placed_[defined_[implicit_[i]].placed];
  std::array<mpz_class, 3> x;
  integers(i, x);
  return {ExactNumber(std::move(x[0])), ExactNumber(std::move(x[1])), ExactNumber(std::move(x[2]))};
}

std::string ExactPoints::assign(std::span<const ExactPoint> points, Planes planes) {
  *this = {};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::string why = check_point(points, planes.size(), i); !why.empty()) return why;
  }
  implicit_.assign(points.size(), kNone);
  defined_.reserve(std::count_if(points.begin(), points.end(), [](const ExactPoint& p) {
    return p.kind != Kind::explicit_point;
  }));
  if (std::string why = place_on_planes(points, planes); !why.empty()) {
    *this = {};
    return why;
  }
  // Corners first: the others are given by them.
  nearest_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].kind == Kind::explicit_point)
      nearest_[i] = {points[i].x, points[i].y, points[i].z};
  }
  Denominators known;
  for (Index i = 0; i < points.size(); ++i) {
    if (!is_corner(points[i])) define(i, points[i], known);
  }
  for (Index i = 0; i < points.size(); ++i) {
    if (implicit_[i] == kNone) continue;
    const ExactVector x = exact(i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      nearest_[i][axis] = to_double(x[axis], exponent_);
      defined_[implicit_[i]].rest[axis] = oracles::rest(x[axis], exponent_, nearest_[i][axis]);
    }
  }
  for (const Position& p : nearest_) {
    for (const double x : p) largest_coordinate_ = std::max(largest_coordinate_, std::fabs(x));
  }
  difference_error_ = defined_.empty() ? 0 : largest_coordinate_ * 0x1p-50;
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

// Encloses (b - a) . (q - p) by rounded values and a bound, explained in ball_side.cpp: 3 monomials
// of degree 2.
Interval quick_dot(const ExactPoints& points, Index a, Index b, Index p, Index q) {
  double value = 0, size = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double u = points.nearest(b)[axis] - points.nearest(a)[axis];
    const double v = points.nearest(q)[axis] - points.nearest(p)[axis];
    value += u * v;
    size = std::max({size, std::fabs(u), std::fabs(v)});
  }
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (!(size > 0x1p-100 && size < 0x1p100)) return {-kInfinite, kInfinite};
  const double error = 2 * (16 * 3 + 2 * 3) * size * (size * 0x1p-53 + points.difference_error());
  return {value - error, value + error};
}

bool uniform(const ExactVector& u, const ExactVector& v) {
  return ExactNumber::uniform(u) && ExactNumber::uniform(v);
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

ExactVector difference(const ExactPoints& points, Index from, Index to) {
  steps += 8;
  if (points.is_integer(from) && points.is_integer(to)) {
    thread_local std::array<mpz_class, 3> origin;
    std::array<mpz_class, 3> x;
    points.integers(from, origin);
    points.integers(to, x);
    for (std::size_t axis = 0; axis < 3; ++axis) x[axis] -= origin[axis];
    return {ExactNumber(std::move(x[0])), ExactNumber(std::move(x[1])),
            ExactNumber(std::move(x[2]))};
  }
  const ExactVector p = points.exact(from), q = points.exact(to);
  if (uniform(p, q)) return ExactNumber::difference(p, q);
  return {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
}

ExactNumber dot(const ExactVector& u, const ExactVector& v) {
  if (uniform(u, v)) return ExactNumber::dot(u, v);
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

ExactVector cross(const ExactVector& u, const ExactVector& v) {
  steps += 16;
  return uniform(u, v) ? ExactNumber::cross(u, v) : product(u, v);
}

bool is_zero(const ExactVector& v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

bool equal(const ExactPoints& points, Index a, Index b) {
  if (points.is_double(a) && points.is_double(b)) return points.nearest(a) == points.nearest(b);
  const IntervalVector off = points.rough_difference(a, b);
  for (const Interval& x : off) {
    if (x.low > 0 || x.high < 0) return false;
  }
  return a == b || points.exact(a) == points.exact(b);
}

// By intervals where these are narrow.
double distance(const ExactPoints& points, Index a, Index b) {
  const IntervalVector rough = points.rough_difference(a, b);
  double width = 0;
  Position middle;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    width = std::max(width, rough[axis].high - rough[axis].low);
    middle[axis] = rough[axis].middle();
  }
  const double length_of_middle = std::hypot(middle[0], middle[1], middle[2]);
  if (length_of_middle > 0x1p-900 && width < 0x1p-48 * length_of_middle) return length_of_middle;
  return length(difference(points, a, b), points.exponent());
}

ExactNumber volume6(const ExactPoints& points, Index a, Index b, Index c, Index d) {
  thread_local Volume6 volume6;  // allocating takes longer than the arithmetic
  return volume6(points, {a, b, c, d});
}

const ExactNumber& Volume6::operator()(const ExactPoints& points,
                                       const std::array<Index, 4>& tetrahedron) {
  if (!points.all_integers()) {
    return value_ = dot(difference(points, tetrahedron[0], tetrahedron[1]),
                        cross(difference(points, tetrahedron[0], tetrahedron[2]),
                              difference(points, tetrahedron[0], tetrahedron[3])));
  }
  points.integers(tetrahedron[0], origin_);
  for (std::size_t i = 0; i < 3; ++i) {
    points.integers(tetrahedron[i + 1], rows_[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) rows_[i][axis] -= origin_[axis];
  }
  return determinant();
}

const ExactNumber& Volume6::from_origin(const ExactPoints& points,
                                        const std::array<Index, 3>& triangle) {
  if (!points.all_integers()) {
    return value_ = dot(points.exact(triangle[0]),
                        cross(points.exact(triangle[1]), points.exact(triangle[2])));
  }
  for (std::size_t i = 0; i < 3; ++i) points.integers(triangle[i], rows_[i]);
  return determinant();
}

const ExactNumber& Volume6::determinant() {
  const auto& [p, q, r] = rows_;
  sum_ = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    mpz_mul(minor_.get_mpz_t(), q[j].get_mpz_t(), r[k].get_mpz_t());
    mpz_submul(minor_.get_mpz_t(), q[k].get_mpz_t(), r[j].get_mpz_t());
    mpz_addmul(sum_.get_mpz_t(), p[i].get_mpz_t(), minor_.get_mpz_t());
  }
  value_.assign(sum_);
  return value_;
}

Interval rough_volume6(const ExactPoints& points, const std::array<Index, 4>& tetrahedron) {
  const auto& [a, b, c, d] = tetrahedron;
  return determinant3(rough_difference(points, a, b), rough_difference(points, a, c),
                      rough_difference(points, a, d));
}

// The bound is explained in ball_side.cpp: 6 monomials of degree 3.
Interval quick_volume6(const ExactPoints& points, const std::array<Index, 4>& tetrahedron) {
  const Position& origin = points.nearest(tetrahedron[0]);
  std::array<Position, 3> rows;
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Position& p = points.nearest(tetrahedron[i + 1]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rows[i][axis] = p[axis] - origin[axis];
      size = std::max(size, std::fabs(rows[i][axis]));
    }
  }
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  // Else something could over- or underflow.
  if (!(size > 0x1p-100 && size < 0x1p100)) return {-kInfinite, kInfinite};
  const double value = determinant3(rows[0], rows[1], rows[2]);
  const double error =
      2 * (16 * 6 + 3 * 6) * size * size * (size * 0x1p-53 + points.difference_error());
  return {value - error, value + error};
}

int orient3d(const ExactPoints& points, Index a, Index b, Index c, Index d) {
  ++steps;
  const int quick = quick_volume6(points, {a, b, c, d}).sign();
  if (quick != 2) return quick;
  const int sign = rough_volume6(points, {a, b, c, d}).sign();
  if (sign != 2) return sign;
  if (points.surely_coplanar(std::array{a, b, c, d})) return 0;
  thread_local Volume6 volume6;
  return sgn(volume6(points, {a, b, c, d}));
}

int insphere(const ExactPoints& points, Index a, Index b, Index c, Index d, Index e) {
  steps += 4;
  const Interval rough = insphere_determinant<Interval>(
      {rough_difference(points, e, a), rough_difference(points, e, b),
       rough_difference(points, e, c), rough_difference(points, e, d)});
  const int sign = rough.sign();
  if (sign != 2) return sign;
  return sgn(
      insphere_determinant<ExactNumber>({difference(points, e, a), difference(points, e, b),
                                         difference(points, e, c), difference(points, e, d)}));
}

ExactNumber squared(const ExactVector& v) {
  return dot(v, v);
}

int dot_sign(const ExactPoints& points, Index apex, Index p, Index q) {
  return dot_sign(points, apex, p, apex, q);
}

int dot_sign(const ExactPoints& points, Index a, Index b, Index p, Index q) {
  ++steps;
  const int quick = quick_dot(points, a, b, p, q).sign();
  if (quick != 2) return quick;
  const int sign = dot(rough_difference(points, a, b), rough_difference(points, p, q)).sign();
  if (sign != 2) return sign;
  return sgn(dot(difference(points, a, b), difference(points, p, q)));
}

bool in_diametral_ball(const ExactPoints& points, Index a, Index b, Index c, Index d) {
  steps += 2;
  const int sign =
      diametral<Interval>(rough_difference(points, a, b), rough_difference(points, a, c),
                          rough_difference(points, a, d))
          .sign();
  if (sign != 2) return sign < 0;
  return diametral<ExactNumber>(difference(points, a, b), difference(points, a, c),
                                difference(points, a, d)) < 0;
}

ExactVector area2(const ExactPoints& points, Index a, Index b, Index c) {
  return cross(difference(points, a, b), difference(points, a, c));
}

IntervalVector rough_area2(const ExactPoints& points, Index a, Index b, Index c) {
  return cross(rough_difference(points, a, b), rough_difference(points, a, c));
}

bool collinear(const ExactPoints& points, Index a, Index b, Index c) {
  if (c == a || c == b || points.is_combination(c, {a, b, b})) return true;
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
