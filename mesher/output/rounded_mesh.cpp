#include "mesher/output/rounded_mesh.h"

#include <algorithm>
#include <utility>

#include "mesher/base/check.h"
#include "mesher/base/face_key.h"
#include "mesher/geometry/vector.h"

namespace delmesher::output {
namespace {

template <class List>
bool has(const List& list, std::uint32_t value) {
  return std::ranges::find(list, value) != list.end();
}

}  // namespace

NearestMesh::NearestMesh(RoundingInput input, Control& control) : RoundingInput(std::move(input)) {
  DELMESHER_CHECK(mesh.region.size() == mesh.tetrahedra.size(),
                  "there are not as many regions as tetrahedra");
  std::vector<std::uint8_t> used(points->size(), 0);
  for (const Tet& t : mesh.tetrahedra) {
    for (const VertexId v : t) used[v] = 1;
  }
  home.resize(used.size());
  for (VertexId v = 0; v < used.size(); ++v) {
    if (used[v] == 0) continue;
    by_home.push_back(v);
    home[v] = frame.written(local_home(v));
  }
  std::stable_sort(by_home.begin(), by_home.end(),
                   [&](VertexId v, VertexId w) { return home[v] < home[w]; });
  sign.reserve(mesh.tetrahedra.size());
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    control.poll(0, static_cast<double>(sign.size()) / static_cast<double>(sign.capacity()));
    sign.push_back(static_cast<std::int8_t>(orient3d_sign(home[a], home[b], home[c], home[d])));
    bad += sign.back() > 0 ? 0 : 1;
  }
}

double NearestMesh::home_error(VertexId v) const {
  const double error = points->approximation(v).error;
  if (!frame.moved()) return error;
  const Vec3 d = subtract(home[v], local_home(v));
  return (error + largest_component(d)) * (1 + 0x1p-50);
}

double NearestMesh::largest_of_surface() const {
  double largest = 0;
  const auto take = [&](VertexId v) {
    largest = std::max(largest, largest_component(frame.given(home[v])));
  };
  for (const SurfaceFace& face : mesh.boundary) {
    for (const VertexId v : face.vertices) take(v);
  }
  for (const VertexId v : by_home) {
    if (mesh.boundary.empty() && on_surface(v)) take(v);
  }
  return largest;
}

std::vector<double> NearestMesh::largest_of_facets() const {
  std::map<FacetId, double> of_facet;
  for (const SurfaceFace& face : mesh.boundary) {
    double& largest = of_facet[face.facet];
    for (const VertexId v : face.vertices) {
      largest = std::max(largest, largest_component(frame.given(home[v])));
    }
  }
  std::vector<double> largest(home.size(), largest_of_surface());
  for (const SurfaceFace& face : mesh.boundary) {
    for (const VertexId v : face.vertices) {
      largest[v] = std::min(largest[v], of_facet[face.facet]);
    }
  }
  return largest;
}

std::vector<std::vector<VertexId>> NearestMesh::coincident(std::span<const Vec3> position) const {
  // Moves never end at other vertices (occupied), so only vertices that have not moved can
  // coincide.
  std::vector<std::vector<VertexId>> groups;
  std::vector<VertexId> group;
  const auto close = [&] {
    if (group.size() > 1) groups.push_back(group);
    group.clear();
  };
  for (const VertexId v : by_home) {
    if (position[v] != home[v]) continue;
    if (!group.empty() && position[group.back()] != position[v]) close();
    group.push_back(v);
  }
  close();
  std::sort(groups.begin(), groups.end());
  return groups;
}

RoundedMesh::RoundedMesh(const NearestMesh& nearest)
    : PlacedMesh(numbered_by_points(nearest.mesh, nearest.home.size())),
      nearest_(nearest),
      predicates_(*nearest.points),
      sign_(nearest.sign) {
  position_ = nearest.home;
  mobility_ = nearest.mobility;
  for (TetId t = 0; t < sign_.size(); ++t) {
    if (sign_[t] <= 0) bad_.insert(t);
  }
  find_pinched();
}

void RoundedMesh::find_pinched() {
  for (const VertexId v : mesh.pinched()) pinched_[v];
  for (TetId t = 0; t < mesh.slots() && !pinched_.empty(); ++t) {
    for (const VertexId v : mesh.tet(t)) {
      if (const auto at = pinched_.find(v); at != pinched_.end()) at->second.push_back(t);
    }
  }
}

void RoundedMesh::ask_exact_points(bool ask) {
  exact_.clear();
  if (ask) exact_.push_back(&predicates_);
}

void RoundedMesh::note(TetId t) {
  ++signs_;
  sign_.resize(mesh.slots(), 1);
  set_sign(t, sign_of(mesh.tet(t)));
}

void RoundedMesh::set_sign(TetId t, int sign) {
  if (sign_[t] <= 0) bad_.erase(t);
  sign_[t] = static_cast<std::int8_t>(sign);
  if (sign <= 0) bad_.insert(t);
}

std::vector<TetId> RoundedMesh::star(VertexId v) const {
  if (const auto pinched = pinched_.find(v); pinched != pinched_.end()) return pinched->second;
  std::vector<TetId> star;
  if (mesh.incident(v) == kNone) return star;
  mesh.star(v, star);
  std::ranges::sort(star);
  return star;
}

bool RoundedMesh::is_enclosed(VertexId v) const {
  return std::ranges::all_of(star(v), [&](TetId t) {
    for (int i = 0; i < 4; ++i) {
      if (mesh.tet(t)[i] != v && mesh.neighbor(t, i) == kNone) return false;
    }
    return true;
  });
}

bool RoundedMesh::occupied(const Vec3& p) const {
  if (moved_to_.contains(p)) return true;
  auto at = std::ranges::lower_bound(nearest_.by_home, p, {}, [&](VertexId v) { return home(v); });
  for (; at != nearest_.by_home.end() && home(*at) == p; ++at) {
    if (position_[*at] == p) return true;
  }
  return false;
}

void RoundedMesh::move(VertexId v, const Vec3& p) {
  if (position_[v] != home(v)) {
    const auto from = moved_to_.find(position_[v]);
    if (--from->second == 0) moved_to_.erase(from);
  }
  position_[v] = p;
  if (p != home(v)) ++moved_to_[p];
  for (const TetId t : star(v)) note(t);
}

void RoundedMesh::note_move(VertexId v) {
  ++clock_;
  for (const TetId t : star(v)) note_change(t);
}

std::uint32_t RoundedMesh::last_change(TetId t) const {
  std::uint32_t last = 0;
  for (const VertexId v : mesh.tet(t)) last = std::max(last, changed_at(v));
  return last;
}

bool RoundedMesh::accept(const Change& change) {
  for (const TetId t : change.removed) {
    if (mesh.region(t) != mesh.region(change.removed[0])) return false;
    for (const VertexId v : mesh.tet(t)) {
      if (pinched_.contains(v)) return false;
    }
  }
  if (clashes(change) || !PlacedMesh::accept(change)) return false;
  for (const TetId t : change.removed) {
    if (!mesh.alive(t)) set_sign(t, 1);
  }
  return true;
}

bool RoundedMesh::clashes(const Change& change) const {
  std::vector<std::array<VertexId, 3>> faces;
  for (const auto& [t, region] : change.created) {
    for (int i = 0; i < 4; ++i) {
      faces.push_back(undirected_face(t[kFace[i][0]], t[kFace[i][1]], t[kFace[i][2]]));
      for (int j = i + 1; j < 4; ++j) {
        const VertexId edge[2] = {t[i], t[j]};
        const auto known = [&](TetId r) {
          return has(mesh.tet(r), edge[0]) && has(mesh.tet(r), edge[1]);
        };
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
           std::ranges::all_of(vertices, [&](VertexId v) { return has(mesh.tet(t), v); });
  });
}

}  // namespace delmesher::output
