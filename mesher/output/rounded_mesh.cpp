#include "mesher/output/rounded_mesh.h"

#include <algorithm>
#include <utility>

#include "mesher/base/check.h"
#include "mesher/base/face_key.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::output {
namespace {

template <class List>
bool has(const List& list, std::uint32_t value) {
  return std::ranges::find(list, value) != list.end();
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
  for (TetId t = 0; t < tet_.size(); ++t) {
    control.poll(0, static_cast<double>(t) / static_cast<double>(tet_.size()));
    sign_[t] = 1;
    set_sign(t, sign_of(tet_[t]));
  }
}

void RoundedMesh::set_sign(TetId t, int sign) {
  if (sign_[t] <= 0) bad_.erase(t);
  sign_[t] = static_cast<std::int8_t>(sign);
  if (sign <= 0) bad_.insert(t);
}

int RoundedMesh::sign_of(const Tet& t) {
  ++signs_;
  return orient3d_sign(position_[t[0]], position_[t[1]], position_[t[2]], position_[t[3]]);
}

int RoundedMesh::sign_at(TetId t, std::uint32_t v, const Vec3& p) {
  const Vec3* x[4];
  for (int i = 0; i < 4; ++i) x[i] = tet(t)[i] == v ? &p : &position_[tet(t)[i]];
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
  const auto local = [&](VertexId v) {
    const auto at = std::ranges::lower_bound(store_id_, v);
    DELMESHER_CHECK(at != store_id_.end() && *at == v, "a boundary vertex is in no tetrahedron");
    return static_cast<std::uint32_t>(at - store_id_.begin());
  };
  std::vector<SurfaceFace> boundary = input_.mesh.boundary;
  for (SurfaceFace& face : boundary) {
    for (VertexId& v : face.vertices) v = local(v);
  }
  topology_.emplace(std::move(tet_), region_, boundary, vertices());
  region_.clear();
  find_pinched();
}

// Only the refined mesh has such vertices (--approximate), where what is inside touches itself.
void RoundedMesh::find_pinched() {
  std::vector<std::uint32_t> degree(vertices(), 0);
  for (TetId t = 0; t < slots(); ++t) {
    for (const std::uint32_t v : tet(t)) ++degree[v];
  }
  std::vector<TetId> star;
  for (std::uint32_t v = 0; v < vertices(); ++v) {
    topology_->star(v, star);
    if (star.size() < degree[v]) pinched_[v];
  }
  for (TetId t = 0; t < slots() && !pinched_.empty(); ++t) {
    for (const std::uint32_t v : tet(t)) {
      if (const auto at = pinched_.find(v); at != pinched_.end()) at->second.push_back(t);
    }
  }
}

double RoundedMesh::largest_of_surface() const {
  double largest = 0;
  const auto take = [&](VertexId point) {
    largest = std::max(largest, largest_component(frame().given(placed(point))));
  };
  for (const SurfaceFace& face : input_.mesh.boundary) {
    for (const VertexId v : face.vertices) take(v);
  }
  for (std::uint32_t v = 0; input_.mesh.boundary.empty() && v < vertices(); ++v) {
    if (fixed(v) || on_surface(v)) take(store_id_[v]);
  }
  return largest;
}

std::vector<TetId> RoundedMesh::star(std::uint32_t v) const {
  if (const auto pinched = pinched_.find(v); pinched != pinched_.end()) return pinched->second;
  std::vector<TetId> star;
  if (topology_->incident(v) == kNone) return star;
  topology_->star(v, star);
  std::ranges::sort(star);
  return star;
}

bool RoundedMesh::is_enclosed(std::uint32_t v) const {
  return std::ranges::all_of(star(v), [&](TetId t) {
    for (int i = 0; i < 4; ++i) {
      if (tet(t)[i] != v && topology_->neighbor(t, i) == kNone) return false;
    }
    return true;
  });
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
  for (const TetId t : star(v)) set_sign(t, sign_of(tet(t)));
}

void RoundedMesh::note_change(std::uint32_t v) {
  ++clock_;
  for (const TetId t : star(v)) {
    for (const std::uint32_t w : tet(t)) changed_at_[w] = clock_;
  }
}

std::uint32_t RoundedMesh::last_change(TetId t) const {
  std::uint32_t last = 0;
  for (const std::uint32_t v : tet(t)) last = std::max(last, changed_at_[v]);
  return last;
}

bool RoundedMesh::accept(const Change& change) {
  for (const TetId t : change.removed) {
    if (region(t) != region(change.removed[0])) return false;
    for (const std::uint32_t v : tet(t)) {
      if (pinched_.contains(v)) return false;
    }
  }
  if (clashes(change)) return false;
  ++clock_;
  for (const TetId t : change.removed) {
    for (const std::uint32_t v : tet(t)) changed_at_[v] = clock_;
    set_sign(t, 1);
  }
  topology_->replace(change.removed, change.created, change.faces);
  sign_.resize(slots(), 1);
  for (const TetId t : topology_->created()) set_sign(t, sign_of(tet(t)));
  return true;
}

bool RoundedMesh::clashes(const Change& change) const {
  std::vector<std::array<VertexId, 3>> faces;
  for (const auto& [t, region] : change.created) {
    for (int i = 0; i < 4; ++i) {
      faces.push_back(undirected_face(t[kFace[i][0]], t[kFace[i][1]], t[kFace[i][2]]));
      for (int j = i + 1; j < 4; ++j) {
        const VertexId edge[2] = {t[i], t[j]};
        const auto known = [&](TetId r) { return has(tet(r), edge[0]) && has(tet(r), edge[1]); };
        if (std::ranges::none_of(change.removed, known) &&
            has_element_elsewhere(edge, change.removed)) {
          return true;
        }
      }
    }
  }
  std::ranges::sort(faces);
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i] == faces[i - 1] && has_element_elsewhere(faces[i], change.removed)) return true;
  }
  return false;
}

bool RoundedMesh::has_element_elsewhere(std::span<const VertexId> vertices,
                                        std::span<const TetId> removed) const {
  return std::ranges::any_of(star(vertices[0]), [&](TetId t) {
    return !has(removed, t) &&
           std::ranges::all_of(vertices, [&](VertexId v) { return has(tet(t), v); });
  });
}

}  // namespace delmesher::output
