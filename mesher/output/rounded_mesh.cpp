#include "mesher/output/rounded_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "mesher/arithmetic/fixed_integer.h"
#include "mesher/base/check.h"

namespace delmesher::output {
namespace {

constexpr double kHuge = 0x1p300;
// Products of three differences below kHuge, and so also what underflow takes from them, are off
// by far less than this.
constexpr double kUnderflow = 0x1p-700;
// Shewchuk (1997): relative to the sum of the absolute values of the six products.
constexpr double kRelativeError = 0x1p-50;

// Sign of det(b - a, c - a, d - a) if plain doubles can tell, else 0.
int filtered_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Vec3 v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const Vec3 w{d[0] - a[0], d[1] - a[1], d[2] - a[2]};
  double determinant = 0, permanent = 0, largest = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double p = u[j] * v[k], q = u[k] * v[j];
    determinant += (p - q) * w[i];
    permanent += (std::fabs(p) + std::fabs(q)) * std::fabs(w[i]);
    largest = std::max({largest, std::fabs(u[i]), std::fabs(v[i]), std::fabs(w[i])});
  }
  if (!(largest < kHuge)) return 0;
  const double bound = kRelativeError * permanent + kUnderflow;
  if (determinant > bound) return 1;
  return determinant < -bound ? -1 : 0;
}

// Coordinates along one axis as integers below 2^60 in a common unit, if they are.
bool as_integers(const std::array<double, 4>& coordinate, std::array<std::int64_t, 4>& integer) {
  constexpr int kMostBits = 60;
  std::array<std::uint64_t, 4> mantissa{};
  std::array<int, 4> exponent{};
  int low = 0, high = 0;
  bool any = false;
  for (std::size_t n = 0; n < 4; ++n) {
    const auto bits = std::bit_cast<std::uint64_t>(coordinate[n]);
    const int field = static_cast<int>((bits >> 52U) & 0x7ffU);
    std::uint64_t m = bits & 0xfffffffffffffU;
    if (field != 0) m |= std::uint64_t{1} << 52U;
    if (m == 0) continue;
    const int zeros = std::countr_zero(m);
    mantissa[n] = m >> zeros;
    exponent[n] = std::max(field, 1) + zeros;
    const int top = exponent[n] + static_cast<int>(std::bit_width(mantissa[n]));
    low = any ? std::min(low, exponent[n]) : exponent[n];
    high = any ? std::max(high, top) : top;
    any = true;
  }
  if (high - low > kMostBits) return false;
  for (std::size_t n = 0; n < 4; ++n) {
    if (mantissa[n] == 0) {
      integer[n] = 0;
      continue;
    }
    const auto size = static_cast<std::int64_t>(mantissa[n] << (exponent[n] - low));
    integer[n] = std::signbit(coordinate[n]) ? -size : size;
  }
  return true;
}

// The same sign exactly where every axis has a unit of its own that suits all four coordinates, as
// it has for vertices not much nearer to the origin than to each other; else nothing.
std::optional<int> orientation_in_integers(const Vec3& a, const Vec3& b, const Vec3& c,
                                           const Vec3& d) {
  std::array<std::int64_t, 3> u{}, v{}, w{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<std::int64_t, 4> x{};
    if (!as_integers({a[i], b[i], c[i], d[i]}, x)) return {};
    u[i] = x[1] - x[0];
    v[i] = x[2] - x[0];
    w[i] = x[3] - x[0];
  }
  const auto integer = [](std::int64_t x) { return FixedInteger<1>{{static_cast<Word>(x)}}; };
  FixedInteger<3> sum{};  // the minors are below 2^123, and all of it is below 2^187
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const FixedInteger<2> minor = integer(u[j]) * integer(v[k]) - integer(u[k]) * integer(v[j]);
    sum = sum + minor * integer(w[i]);
  }
  return sum.sign();
}

template <typename T>
void erase_sorted(std::vector<T>& sorted, T value) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), value);
  DELMESHER_CHECK(at != sorted.end() && *at == value, "a star lost a tetrahedron");
  sorted.erase(at);
}

std::array<std::uint32_t, 3> sorted_triple(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  std::array<std::uint32_t, 3> face{a, b, c};
  std::sort(face.begin(), face.end());
  return face;
}

}  // namespace

int DoubleOrientation::operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const int sign = filtered_orientation(a, b, c, d);
  if (sign != 0) return sign;
  if (const std::optional<int> exact = orientation_in_integers(a, b, c, d)) return *exact;
  const VertexId i = scratch_.add_explicit(a[0], a[1], a[2]);
  const VertexId j = scratch_.add_explicit(b[0], b[1], b[2]);
  const VertexId k = scratch_.add_explicit(c[0], c[1], c[2]);
  const VertexId l = scratch_.add_explicit(d[0], d[1], d[2]);
  const int exact = predicates_.orient3d(i, j, k, l);
  for (int n = 0; n < 4; ++n) scratch_.pop_back();
  return exact;
}

RoundedMesh::RoundedMesh(RoundingInput& input, Control& control)
    : input_(input), tet_(std::move(input.tetrahedra)), inside_(std::move(input.inside)) {
  DELMESHER_CHECK(inside_.size() == tet_.size(), "one inside flag per tetrahedron");
  number_vertices();
  certify(control);
}

void RoundedMesh::number_vertices() {
  std::vector<std::uint32_t> local(input_.points->size(), kNone);
  for (const Tet& t : tet_) {
    for (const std::uint32_t v : t) local[v] = 0;
  }
  for (VertexId v = 0; v < local.size(); ++v) {
    if (local[v] == kNone) continue;
    local[v] = static_cast<std::uint32_t>(store_id_.size());
    store_id_.push_back(v);
    position_.push_back(input_.points->nearest(v));
  }
  for (Tet& t : tet_) {
    for (std::uint32_t& v : t) v = local[v];
  }
  by_position_.resize(store_id_.size());
  for (std::uint32_t v = 0; v < by_position_.size(); ++v) by_position_[v] = v;
  std::stable_sort(by_position_.begin(), by_position_.end(),
                   [&](std::uint32_t v, std::uint32_t w) { return position_[v] < position_[w]; });
}

void RoundedMesh::certify(Control& control) {
  sign_.resize(tet_.size());
  for (std::uint32_t t = 0; t < tet_.size(); ++t) {
    control.poll(0, static_cast<double>(t) / static_cast<double>(tet_.size()));
    sign_[t] = 1;
    set_sign(t, sign_of(tet_[t]));
  }
}

void RoundedMesh::set_sign(std::uint32_t t, int sign) {
  if (sign_[t] <= 0) bad_.erase(t);
  sign_[t] = static_cast<std::int8_t>(sign);
  if (sign <= 0) bad_.insert(t);
}

int RoundedMesh::sign_of(const Tet& t) {
  return orientation_(position_[t[0]], position_[t[1]], position_[t[2]], position_[t[3]]);
}

int RoundedMesh::sign_at(std::uint32_t t, std::uint32_t v, const Vec3& p) {
  const Vec3* x[4];
  for (int i = 0; i < 4; ++i) x[i] = tet_[t][i] == v ? &p : &position_[tet_[t][i]];
  return orientation_(*x[0], *x[1], *x[2], *x[3]);
}

std::vector<std::vector<std::uint32_t>> RoundedMesh::coincident() const {
  // Moved vertices never meet others, so only those still at home can coincide.
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<std::uint32_t> group;
  const auto close = [&] {
    if (group.size() > 1) groups.push_back(group);
    group.clear();
  };
  for (const std::uint32_t v : by_position_) {
    if (position_[v] != home(v)) continue;
    if (!group.empty() && position_[group.back()] != position_[v]) close();
    group.push_back(v);
  }
  close();
  std::sort(groups.begin(), groups.end());
  return groups;
}

void RoundedMesh::prepare_repairs() {
  changed_at_.assign(vertices(), 0);
  star_begin_.assign(vertices() + 1, 0);
  for (const Tet& t : tet_) {
    for (const std::uint32_t v : t) ++star_begin_[v + 1];
  }
  for (std::size_t v = 0; v < vertices(); ++v) star_begin_[v + 1] += star_begin_[v];
  star_tets_.resize(4 * tet_.size());
  std::vector<std::uint32_t> next(star_begin_.begin(), star_begin_.end() - 1);
  for (std::uint32_t t = 0; t < tet_.size(); ++t) {
    for (const std::uint32_t v : tet_[t]) star_tets_[next[v]++] = t;
  }
  const auto local = [&](VertexId v) {
    const auto at = std::lower_bound(store_id_.begin(), store_id_.end(), v);
    DELMESHER_CHECK(at != store_id_.end() && *at == v, "a boundary vertex is in no tetrahedron");
    return static_cast<std::uint32_t>(at - store_id_.begin());
  };
  boundary_.clear();
  boundary_.reserve(input_.boundary.size());
  for (const auto& [a, b, c] : input_.boundary) {
    boundary_.push_back(sorted_triple(local(a), local(b), local(c)));
  }
  std::sort(boundary_.begin(), boundary_.end());
}

std::span<const std::uint32_t> RoundedMesh::star(std::uint32_t v) const {
  if (const auto changed = changed_stars_.find(v); changed != changed_stars_.end()) {
    return changed->second;
  }
  return {star_tets_.data() + star_begin_[v], star_tets_.data() + star_begin_[v + 1]};
}

std::vector<std::uint32_t>& RoundedMesh::editable_star(std::uint32_t v) {
  const auto [at, fresh] = changed_stars_.try_emplace(v);
  if (fresh) {
    at->second.assign(star_tets_.begin() + star_begin_[v], star_tets_.begin() + star_begin_[v + 1]);
  }
  return at->second;
}

bool RoundedMesh::is_enclosed(std::uint32_t v) const {
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (const std::uint32_t t : star(v)) {
    for (int i = 0; i < 4; ++i) {
      if (tet_[t][i] == v) continue;
      faces.push_back(
          sorted_triple(tet_[t][(i + 1) % 4], tet_[t][(i + 2) % 4], tet_[t][(i + 3) % 4]));
    }
  }
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 0; i < faces.size(); i += 2) {
    if (i + 1 == faces.size() || faces[i] != faces[i + 1]) return false;
  }
  return true;
}

bool RoundedMesh::is_boundary(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  return std::binary_search(boundary_.begin(), boundary_.end(), sorted_triple(a, b, c));
}

bool RoundedMesh::occupied(const Vec3& p) const {
  if (moved_to_.contains(p)) return true;
  auto at = std::lower_bound(by_position_.begin(), by_position_.end(), p,
                             [&](std::uint32_t v, const Vec3& q) { return home(v) < q; });
  for (; at != by_position_.end() && home(*at) == p; ++at) {
    if (position_[*at] == p) return true;
  }
  return false;
}

void RoundedMesh::move(std::uint32_t v, const Vec3& p) {
  if (position_[v] != home(v)) {
    const auto from = moved_to_.find(position_[v]);
    if (--from->second == 0) moved_to_.erase(from);
  }
  position_[v] = p;
  if (p != home(v)) ++moved_to_[p];
  for (const std::uint32_t t : star(v)) set_sign(t, sign_of(tet_[t]));
}

void RoundedMesh::note_change(std::uint32_t v) {
  ++clock_;
  for (const std::uint32_t t : star(v)) {
    for (const std::uint32_t w : tet_[t]) changed_at_[w] = clock_;
  }
}

std::uint32_t RoundedMesh::last_change(std::uint32_t t) const {
  std::uint32_t last = 0;
  for (const std::uint32_t v : tet_[t]) last = std::max(last, changed_at_[v]);
  return last;
}

void RoundedMesh::replace(std::span<const std::uint32_t> removed, std::span<const Tet> created) {
  ++clock_;
  const std::uint8_t flag = inside_[removed[0]];
  std::vector<std::uint32_t> free(removed.begin(), removed.end());
  std::sort(free.begin(), free.end(), std::greater<>());
  for (const std::uint32_t t : free) {
    for (const std::uint32_t v : tet_[t]) {
      erase_sorted(editable_star(v), t);
      changed_at_[v] = clock_;
    }
    set_sign(t, 1);
    tet_[t].fill(kNone);
  }
  for (const Tet& vertices : created) {
    auto t = static_cast<std::uint32_t>(tet_.size());
    if (free.empty()) {
      tet_.emplace_back();
      inside_.push_back(flag);
      sign_.push_back(1);
    } else {
      t = free.back();
      free.pop_back();
    }
    tet_[t] = vertices;
    set_sign(t, sign_of(vertices));
    for (const std::uint32_t v : vertices) {
      auto& slots = editable_star(v);
      slots.insert(std::lower_bound(slots.begin(), slots.end(), t), t);
    }
  }
}

}  // namespace delmesher::output
