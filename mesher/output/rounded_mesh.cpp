#include "mesher/output/rounded_mesh.h"

#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/base/face_key.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::output {
namespace {

template <typename T>
void erase_sorted(std::vector<T>& sorted, T value) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), value);
  DELMESHER_CHECK(at != sorted.end() && *at == value,
                  "a tetrahedron is not in the star of its vertex");
  sorted.erase(at);
}

}  // namespace

RoundedMesh::RoundedMesh(RoundingInput& input, Control& control)
    : input_(input), tet_(std::move(input.mesh.tetrahedra)), region_(std::move(input.mesh.region)) {
  DELMESHER_CHECK(region_.size() == tet_.size(), "there are not as many regions as tetrahedra");
  number_vertices();
  certify(control);
}

double RoundedMesh::home_error(std::uint32_t v) const {
  const double error = approximation(v).error;
  if (!frame().moved()) return error;
  const Vec3 d = subtract(home(v), nearest(store_id_[v]));
  return (error + largest_component(d)) * (1 + 0x1p-50);
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
    position_.push_back(placed(v));
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
  ++signs_;
  return orient3d_sign(position_[t[0]], position_[t[1]], position_[t[2]], position_[t[3]]);
}

int RoundedMesh::sign_at(std::uint32_t t, std::uint32_t v, const Vec3& p) {
  const Vec3* x[4];
  for (int i = 0; i < 4; ++i) x[i] = tet_[t][i] == v ? &p : &position_[tet_[t][i]];
  ++signs_;
  return orient3d_sign(*x[0], *x[1], *x[2], *x[3]);
}

std::vector<std::vector<std::uint32_t>> RoundedMesh::coincident() const {
  // Moves never end at other vertices (occupied), so only vertices that have not moved can
  // coincide.
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
  boundary_.reserve(input_.mesh.boundary.size());
  for (const SurfaceFace& face : input_.mesh.boundary) {
    const auto& [a, b, c] = face.vertices;
    boundary_.push_back(undirected_face(local(a), local(b), local(c)));
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
          undirected_face(tet_[t][(i + 1) % 4], tet_[t][(i + 2) % 4], tet_[t][(i + 3) % 4]));
    }
  }
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 0; i < faces.size(); i += 2) {
    if (i + 1 == faces.size() || faces[i] != faces[i + 1]) return false;
  }
  return true;
}

bool RoundedMesh::is_boundary(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  return std::binary_search(boundary_.begin(), boundary_.end(), undirected_face(a, b, c));
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
  const RegionId region = region_[removed[0]];
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
      region_.push_back(region);
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
