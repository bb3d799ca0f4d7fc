#include "mesher/predicates/points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesher/arithmetic/dyadic.h"
#include "mesher/base/check.h"

namespace delmesher::predicates {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Coordinate `axis` of an implicit point: anchor + sum of parameter * (corner - anchor).
Dyadic exact_coordinate(const PointStore& points, const PointDefinition& d, std::size_t axis) {
  const auto of = [&](std::size_t i) {
    return Dyadic::from_double(points.nearest(d.corner[i])[axis]);
  };
  const std::size_t last = d.kind == PointKind::on_segment ? 1 : 2;
  const Dyadic anchor = of(last);
  // What all corners have in common, so does the point: parallel to an axis, or in the plane z = 0.
  const auto same = [&](std::size_t i) {
    return points.nearest(d.corner[i])[axis] == points.nearest(d.corner[last])[axis];
  };
  if (same(0) && same(1)) return anchor;
  Dyadic sum = anchor + Dyadic::from_double(d.u) * (of(0) - anchor);
  if (last == 2) sum = sum + Dyadic::from_double(d.v) * (of(1) - anchor);
  return sum;
}

}  // namespace

void PointStore::reserve(std::size_t n) {
  approximations_.reserve(n);
  detail_of_.reserve(n);
}

VertexId PointStore::add_explicit(double x, double y, double z) {
  DELMESHER_CHECK(std::isfinite(x) && std::isfinite(y) && std::isfinite(z), "point not finite");
  // Adding zero turns -0 into +0: equal points then have equal representations.
  approximations_.push_back({x + 0.0, y + 0.0, z + 0.0, 0.0});
  detail_of_.push_back(kNone);
  return static_cast<VertexId>(size() - 1);
}

VertexId PointStore::add_on_segment(VertexId p, VertexId q, double t) {
  return add_implicit({PointKind::on_segment, {p, q, kNone}, t, 0});
}

VertexId PointStore::add_on_triangle(VertexId p, VertexId q, VertexId r, double u, double v) {
  return add_implicit({PointKind::on_triangle, {p, q, r}, u, v});
}

VertexId PointStore::add(const PointDefinition& implicit_point) {
  DELMESHER_CHECK(implicit_point.kind != PointKind::explicit_point, "not an implicit point");
  return add_implicit(implicit_point);
}

VertexId PointStore::add_implicit(const PointDefinition& definition) {
  const std::size_t corners = definition.kind == PointKind::on_segment ? 2 : 3;
  for (std::size_t i = 0; i < corners; ++i) {
    const VertexId c = definition.corner[i];
    DELMESHER_CHECK(c < size() && is_explicit(c), "implicit points have explicit corners");
  }
  DELMESHER_CHECK(std::isfinite(definition.u) && std::isfinite(definition.v),
                  "parameter not finite");
  std::array<Rounded, 3> nearest;
  std::array<Rounded, 3> rest;
  Detail d;
  d.definition = definition;
  d.first_limb = limbs_.size();
  d.first_support = supports_.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Dyadic x = exact_coordinate(*this, definition, axis);
    nearest[axis] = round_to_double(x);
    rest[axis] = {0, 0};
    if (!(nearest[axis].error < kInfinity)) {
      rest[axis].error = kInfinity;
    } else if (nearest[axis].error > 0) {
      rest[axis] = round_to_double(x - Dyadic::from_double(nearest[axis].value));
    }
    d.size[axis] = x.sign() * static_cast<std::int32_t>(x.mantissa.used());
    d.exponent[axis] = x.exponent;
    limbs_.append(x.mantissa.data(), x.mantissa.data() + x.mantissa.used());
  }
  const auto combined = [](const std::array<Rounded, 3>& r) -> Approximation {
    const double error = std::max({r[0].error, r[1].error, r[2].error});
    return {r[0].value, r[1].value, r[2].value, error};
  };
  approximations_.push_back(combined(nearest));
  d.remainder = combined(rest);
  detail_of_.push_back(static_cast<std::uint32_t>(details_.size()));
  details_.push_back(d);
  return static_cast<VertexId>(size() - 1);
}

std::size_t PointStore::limb_count(const Detail& d) {
  return static_cast<std::size_t>(std::abs(d.size[0]) + std::abs(d.size[1]) + std::abs(d.size[2]));
}

void PointStore::pop_back() {
  DELMESHER_CHECK(size() > 0, "no point to remove");
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
}

}  // namespace delmesher::predicates
