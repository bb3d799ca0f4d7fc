#include "mesher/predicates/points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesher/arithmetic/dyadic.h"
#include "mesher/arithmetic/fixed_integer.h"
#include "mesher/base/check.h"
#include "mesher/predicates/common_denominator.h"
#include "mesher/predicates/exact_point.h"

namespace delmesher::predicates {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The corners of an implicit point, over a common denominator.
struct ExactCorners {
  ExactCorners(const PointStore& points, const PointDefinition& d)
      : count(d.kind == PointKind::on_segment ? 2 : 3) {
    for (std::size_t i = 0; i < count; ++i) corner[i] = exact_point(points, d.corner[i]);
    to_common_denominator({corner.data(), count});
  }
  std::size_t count;
  std::array<RationalPoint, 3> corner;
};

// a * 2^shift in another size, which must have room for it.
template <int N, int M>
arithmetic::FixedInteger<N> shifted(const arithmetic::FixedInteger<M>& a, int shift) {
  const std::uint64_t beyond = a.negative() ? ~std::uint64_t{0} : 0;
  const int words = shift / 64, bits = shift % 64;
  const auto limb = [&](int i) { return i < 0 ? 0 : i < M ? a.limb[i] : beyond; };
  arithmetic::FixedInteger<N> result;
  for (int i = 0; i < N; ++i) {
    const std::uint64_t low = limb(i - words);
    result.limb[i] = bits == 0 ? low : low << bits | limb(i - words - 1) >> (64 - bits);
  }
  return result;
}

// x[n - 1] + sum of parameter[i] * (x[i] - x[n - 1]), i < n - 1, in integers of a fixed size. False
// if they have no room for it.
bool combine_doubles(std::span<const double> x, const std::array<double, 2>& parameter,
                     Dyadic& result) {
  using arithmetic::decompose, arithmetic::DoubleParts, arithmetic::FixedInteger;
  // Differences have 127 bits, their products with parameters 180; shifted by 130 bits at most,
  // three of them have room in five words.
  constexpr int kMostBits = 126, kMostShift = 130, kWords = 5;
  constexpr int kFar = 1 << 20;
  const std::size_t last = x.size() - 1;
  std::array<DoubleParts, 3> part;
  int low = kFar, high = -kFar;
  for (std::size_t i = 0; i <= last; ++i) {
    part[i] = decompose(x[i]);
    if (part[i].magnitude == 0) continue;
    low = std::min(low, part[i].exponent);
    high = std::max(high, part[i].exponent + 53);
  }
  if (high - low > kMostBits) return false;
  const auto integer = [&](const DoubleParts& p) {
    const bool zero = p.magnitude == 0;
    return arithmetic::fixed_integer<2>(&p.magnitude, 1, p.negative, zero ? 0 : p.exponent - low);
  };
  const FixedInteger<2> anchor = integer(part[last]);
  std::array<DoubleParts, 2> factor;
  int scale = 0;
  for (std::size_t i = 0; i < last; ++i) {
    factor[i] = decompose(parameter[i]);
    if (factor[i].magnitude != 0) scale = std::min(scale, factor[i].exponent);
  }
  if (-scale > kMostShift) return false;
  FixedInteger<kWords> sum = shifted<kWords>(anchor, -scale);
  for (std::size_t i = 0; i < last; ++i) {
    const DoubleParts& f = factor[i];
    if (f.magnitude == 0) continue;
    if (f.exponent - scale > kMostShift) return false;
    const FixedInteger<1> whole = {{f.negative ? -f.magnitude : f.magnitude}};
    sum = sum + shifted<kWords>((integer(part[i]) - anchor) * whole, f.exponent - scale);
  }
  result = {};
  if (sum.sign() == 0) return true;
  const bool negative = sum.negative();
  if (negative) sum = FixedInteger<kWords>{} - sum;
  result.mantissa = BigInteger(sum.limb.data(), kWords, negative);
  const std::size_t zeros = result.mantissa.trailing_zeros();
  if (zeros != 0) result.mantissa.drop_bits(zeros);
  result.exponent = low + scale + static_cast<std::int32_t>(zeros);
  return true;
}

// combination() of corners that are doubles, as most are.
bool combine_doubles(const PointStore& points, const PointDefinition& d, RationalPoint& result) {
  const std::size_t count = d.kind == PointKind::on_segment ? 2 : 3;
  std::array<Vec3, 3> corner{};
  for (std::size_t i = 0; i < count; ++i) {
    if (!points.is_explicit(d.corner[i])) return false;
    corner[i] = points.nearest(d.corner[i]);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::array<double, 3> x = {corner[0][axis], corner[1][axis], corner[2][axis]};
    if (!combine_doubles({x.data(), count}, {d.u, d.v}, result.numerator[axis])) return false;
  }
  return true;
}

// anchor + sum of parameter * (corner - anchor).
RationalPoint combination(const PointStore& points, const PointDefinition& d) {
  if (RationalPoint result; combine_doubles(points, d, result)) return result;
  const ExactCorners given(points, d);
  RationalPoint result = given.corner[given.count - 1];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Dyadic anchor = result.numerator[axis];
    const auto term = [&](std::size_t i, double parameter) {
      const Dyadic difference = given.corner[i].numerator[axis] - anchor;
      // A coordinate that all corners have in common is the point's, too.
      if (difference.sign() == 0) return;
      result.numerator[axis] = result.numerator[axis] + Dyadic::from_double(parameter) * difference;
    };
    term(0, d.u);
    if (given.count == 3) term(1, d.v);
  }
  return result;
}

DyadicPoint dyadic_vector(const Vec3& v) {
  return {Dyadic::from_double(v[0]), Dyadic::from_double(v[1]), Dyadic::from_double(v[2])};
}

Dyadic dot(const DyadicPoint& a, const DyadicPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

DyadicPoint cross(const DyadicPoint& a, const DyadicPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

DyadicPoint exact_normal(const PlaneEquation& plane) {
  if (!plane.spanned) return dyadic_vector(plane.normal);
  const auto edge = [&](std::size_t k) {
    const DyadicPoint a = dyadic_vector(plane.through[0]), b = dyadic_vector(plane.through[k]);
    return DyadicPoint{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  };
  return cross(edge(1), edge(2));
}

// Cramer's rule: the sum of h_i n_j x n_k over n_i . (n_j x n_k), with n_i . x = h_i.
RationalPoint meeting_point(const std::array<PlaneEquation, 3>& planes) {
  std::array<DyadicPoint, 3> n;
  for (std::size_t i = 0; i < 3; ++i) n[i] = exact_normal(planes[i]);
  DyadicPoint sum;
  for (std::size_t i = 0; i < 3; ++i) {
    const Dyadic height = dot(n[i], dyadic_vector(planes[i].through[0]));
    const DyadicPoint c = cross(n[(i + 1) % 3], n[(i + 2) % 3]);
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] = sum[axis] + height * c[axis];
  }
  Dyadic determinant = dot(n[0], cross(n[1], n[2]));
  DELMESHER_CHECK(determinant.sign() != 0, "the three planes of a point do not meet in one point");
  if (determinant.sign() < 0) {
    determinant.mantissa = -determinant.mantissa;
    for (Dyadic& x : sum) x.mantissa = -x.mantissa;
  }
  for (Dyadic& x : sum) {
    if (x.sign() != 0) x.exponent -= determinant.exponent;
  }
  return {sum, determinant.mantissa};
}

// The nearest double of x / y, and that of the remainder.
struct RoundedQuotient {
  Rounded nearest, rest;
};

RoundedQuotient round_quotient(const Dyadic& x, const Dyadic& y) {
  const Dyadic q = leading_digits_of_quotient(x, y);
  const Dyadic r = x - q * y;
  const Dyadic q2 = leading_digits_of_quotient(r, y);
  const Rounded q3 = round_to_double(leading_digits_of_quotient(r - q2 * y, y));
  const Dyadic both = q + q2;
  RoundedQuotient result{round_to_double(both), {0, 0}};
  if (!(result.nearest.error < kInfinity)) {
    result.rest.error = kInfinity;
    return result;
  }
  result.rest = round_to_double(both - Dyadic::from_double(result.nearest.value));
  // q3 is off by less than 2^-50 of itself, or by its own error where it is subnormal.
  const double neglected = (std::fabs(q3.value) + q3.error) * (1 + 0x1p-40);
  if (neglected == 0) return result;
  result.rest.error = (result.rest.error + neglected) * (1 + 0x1p-40);
  result.nearest.error = (result.nearest.error + neglected) * (1 + 0x1p-40);
  return result;
}

RoundedQuotient round_dyadic(const Dyadic& x) {
  RoundedQuotient result{round_to_double(x), {0, 0}};
  if (!(result.nearest.error < kInfinity)) {
    result.rest.error = kInfinity;
  } else if (result.nearest.error > 0) {
    result.rest = round_to_double(x - Dyadic::from_double(result.nearest.value));
  }
  return result;
}

}  // namespace

void PointStore::reserve(std::size_t n) {
  approximations_.reserve(n);
  detail_of_.reserve(n);
}

VertexId PointStore::add_explicit(double x, double y, double z) {
  DELMESHER_CHECK(std::isfinite(x) && std::isfinite(y) && std::isfinite(z),
                  "a coordinate is not finite");
  // Adding zero turns -0 into +0: equal points then have equal representations.
  approximations_.push_back({x + 0.0, y + 0.0, z + 0.0, 0.0});
  detail_of_.push_back(kNone);
  return static_cast<VertexId>(size() - 1);
}

void PointStore::move_explicit(VertexId v, const Vec3& x) {
  DELMESHER_CHECK(detail_of_[v] == kNone, "a point is to move that has a definition or supports");
  DELMESHER_CHECK(std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]),
                  "a coordinate is not finite");
  approximations_[v] = {x[0] + 0.0, x[1] + 0.0, x[2] + 0.0, 0.0};
}

VertexId PointStore::add_on_segment(VertexId p, VertexId q, double t) {
  return add_implicit({PointKind::on_segment, {p, q, kNone}, t, 0});
}

VertexId PointStore::add_on_triangle(VertexId p, VertexId q, VertexId r, double u, double v) {
  return add_implicit({PointKind::on_triangle, {p, q, r}, u, v});
}

void PointStore::copy_corners(const PointStore& from, std::size_t count) {
  DELMESHER_CHECK(size() == 0, "corners are copied to a store that is not empty");
  equations_ = from.equations_;
  for (VertexId v = 0; v < count; ++v) {
    if (from.is_explicit(v)) {
      approximations_.push_back(from.approximation(v));
      detail_of_.push_back(kNone);
    } else {
      add(from.definition(v));
    }
  }
}

VertexId PointStore::add(const PointDefinition& implicit_point) {
  DELMESHER_CHECK(implicit_point.kind != PointKind::explicit_point,
                  "an explicit point is added as an implicit one");
  return add_implicit(implicit_point);
}

std::uint32_t PointStore::add_plane(const PlaneEquation& plane) {
  equations_.push_back(plane);
  return static_cast<std::uint32_t>(equations_.size() - 1);
}

VertexId PointStore::add_on_planes(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return add_implicit({PointKind::on_planes, {a, b, c}, 0, 0});
}

VertexId PointStore::add_on_planes(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                                   const PointStore& from, VertexId same) {
  const Detail& known = from.details_[from.detail_of_[same]];
  Detail d = known;
  d.definition.corner = {a, b, c};
  d.first_limb = limbs_.size();
  d.first_support = supports_.size();
  d.planes = d.lines = 0;
  const Word* limbs = from.limbs_.data() + known.first_limb;
  limbs_.append(limbs, limbs + limb_count(known));
  put(from.approximations_[same], d);
  return static_cast<VertexId>(size() - 1);
}

VertexId PointStore::add_implicit(const PointDefinition& definition) {
  RationalPoint exact;
  const std::array<VertexId, 3>& c = definition.corner;
  if (definition.kind == PointKind::on_planes) {
    DELMESHER_CHECK(
        c[0] < equations_.size() && c[1] < equations_.size() && c[2] < equations_.size(),
        "a point is on a plane that is not in the store");
    exact = meeting_point({equations_[c[0]], equations_[c[1]], equations_[c[2]]});
  } else {
    const std::size_t corners = definition.kind == PointKind::on_segment ? 2 : 3;
    for (std::size_t i = 0; i < corners; ++i) {
      DELMESHER_CHECK(
          c[i] < size() && is_corner(c[i]),
          "a corner of an implicit point is not in the store, or neither explicit nor on planes");
    }
    DELMESHER_CHECK(std::isfinite(definition.u) && std::isfinite(definition.v),
                    "a parameter is not finite");
    exact = combination(*this, definition);
  }
  append(definition, exact);
  return static_cast<VertexId>(size() - 1);
}

void PointStore::append(const PointDefinition& definition, const RationalPoint& exact) {
  std::array<Rounded, 3> nearest;
  std::array<Rounded, 3> rest;
  Detail d;
  d.definition = definition;
  d.first_limb = limbs_.size();
  d.first_support = supports_.size();
  const auto keep = [&](const BigInteger& x) {
    limbs_.append(x.data(), x.data() + x.used());
    return static_cast<std::int32_t>(x.used());
  };
  const bool whole = exact.denominator == BigInteger(1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Dyadic& x = exact.numerator[axis];
    const RoundedQuotient r = whole ? round_dyadic(x) : round_quotient(x, {exact.denominator, 0});
    nearest[axis] = r.nearest;
    rest[axis] = r.rest;
    d.size[axis] = x.sign() * keep(x.mantissa);
    d.exponent[axis] = x.exponent;
  }
  if (!whole) d.denominator = keep(exact.denominator);
  const auto combined = [](const std::array<Rounded, 3>& r) -> Approximation {
    const double error = std::max({r[0].error, r[1].error, r[2].error});
    return {r[0].value, r[1].value, r[2].value, error};
  };
  d.remainder = combined(rest);
  put(combined(nearest), d);
}

void PointStore::put(const Approximation& approximation, const Detail& d) {
  approximations_.push_back(approximation);
  detail_of_.push_back(static_cast<std::uint32_t>(details_.size()));
  details_.push_back(d);
}

std::size_t PointStore::limb_count(const Detail& d) {
  return static_cast<std::size_t>(std::abs(d.size[0]) + std::abs(d.size[1]) + std::abs(d.size[2]) +
                                  d.denominator);
}

void PointStore::pop_back() {
  DELMESHER_CHECK(size() > 0, "a point is removed from an empty store");
  const std::uint32_t index = detail_of_.back();
  if (index != kNone) {
    const Detail& d = details_[index];
    // The pools shrink if the data of the point are at their end, as they are for the newest point.
    // Otherwise (supports of an explicit point, set late) the space is left unused.
    if (d.first_limb + limb_count(d) == limbs_.size()) limbs_.resize(d.first_limb);
    const std::size_t supports = std::size_t{d.planes} + d.lines;
    if (d.first_support + supports == supports_.size()) supports_.resize(d.first_support);
    if (index + 1 == details_.size()) details_.pop_back();
  }
  detail_of_.pop_back();
  approximations_.pop_back();
}

PointStore::Detail& PointStore::detail(VertexId v) {
  if (detail_of_[v] == kNone) {
    detail_of_[v] = static_cast<std::uint32_t>(details_.size());
    details_.push_back({});  // without limbs
  }
  return details_[detail_of_[v]];
}

void PointStore::set_supports(VertexId v, std::span<const PlaneId> planes,
                              std::span<const std::uint32_t> lines) {
  if (planes.empty() && lines.empty() && detail_of_[v] == kNone) return;
  // The arguments may be supports of another point of this store: copy before the pool moves.
  std::vector<std::uint32_t> ids(planes.begin(), planes.end());
  ids.insert(ids.end(), lines.begin(), lines.end());
  Detail& d = detail(v);
  if (std::size_t{d.planes} + d.lines < ids.size()) {
    const bool at_end = d.first_support + d.planes + d.lines == supports_.size();
    if (!at_end) d.first_support = supports_.size();
    supports_.resize(d.first_support + ids.size());
  }
  d.planes = static_cast<std::uint32_t>(planes.size());
  d.lines = static_cast<std::uint32_t>(lines.size());
  std::copy(ids.begin(), ids.end(),
            supports_.begin() + static_cast<std::ptrdiff_t>(d.first_support));
}

std::span<const PlaneId> PointStore::planes(VertexId v) const {
  if (detail_of_[v] == kNone) return {};
  const Detail& d = details_[detail_of_[v]];
  return {supports_.data() + d.first_support, d.planes};
}

std::span<const std::uint32_t> PointStore::lines(VertexId v) const {
  if (detail_of_[v] == kNone) return {};
  const Detail& d = details_[detail_of_[v]];
  return {supports_.data() + d.first_support + d.planes, d.lines};
}

PointDefinition PointStore::definition(VertexId v) const {
  if (detail_of_[v] == kNone) return Detail{}.definition;
  return details_[detail_of_[v]].definition;
}

Approximation PointStore::remainder(VertexId v) const {
  if (detail_of_[v] == kNone) return {0, 0, 0, 0};
  return details_[detail_of_[v]].remainder;
}

Vec3 PointStore::difference(VertexId a, VertexId b) const {
  const Approximation &p = approximations_[a], &q = approximations_[b];
  Vec3 d = {q.x - p.x, q.y - p.y, q.z - p.z};
  const double error = std::max(p.error, q.error);
  if (error == 0 || error < 0x1p-40 * (std::fabs(d[0]) + std::fabs(d[1]) + std::fabs(d[2]))) {
    return d;
  }
  const Approximation r = remainder(a), s = remainder(b);
  return {d[0] + (s.x - r.x), d[1] + (s.y - r.y), d[2] + (s.z - r.z)};
}

void set_exact(const Vec3& x, ExactPosition& out) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const DoubleParts parts = decompose(x[axis]);
    out.own[axis] = parts.magnitude;
    const std::int32_t size = parts.magnitude == 0 ? 0 : (parts.negative ? -1 : 1);
    out.coordinate[axis] = {&out.own[axis], size, parts.exponent};
  }
  out.denominator = {};
}

void PointStore::exact(VertexId v, ExactPosition& out) const {
  if (is_explicit(v)) {
    set_exact(nearest(v), out);
    return;
  }
  const Detail& d = details_[detail_of_[v]];
  const Word* limbs = limbs_.data() + d.first_limb;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.coordinate[axis] = {limbs, d.size[axis], d.exponent[axis]};
    limbs += std::abs(d.size[axis]);
  }
  out.denominator = {limbs, d.denominator, 0};
}

}  // namespace delmesher::predicates
