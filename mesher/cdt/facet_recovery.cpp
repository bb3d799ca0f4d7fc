#include "mesher/cdt/facet_recovery.h"

#include <algorithm>

#include "mesher/base/epoch.h"
#include "mesher/base/face_key.h"
#include "mesher/base/numbering.h"
#include "mesher/base/sort_unique.h"

namespace delmesher::cdt {
namespace {

Triangle reversed(const Triangle& t) {
  return {t[0], t[2], t[1]};
}

}  // namespace

FacetRecovery::FacetRecovery(Tetrahedrization& mesh, const SurfaceTopology& topology,
                             const Chains& chains, Control& control)
    : mesh_(mesh),
      predicates_(mesh.predicates()),
      topology_(topology),
      chains_(chains),
      control_(control),
      filler_(predicates_, control),
      side_mark_(predicates_.points().size(), 0),
      side_(predicates_.points().size(), 0),
      skin_mark_(predicates_.points().size(), 0) {}

// Side of the facet's plane: +1 outside the solid.
int FacetRecovery::side(VertexId v) {
  if (side_mark_[v] != facet_epoch_) {
    side_mark_[v] = facet_epoch_;
    side_[v] = static_cast<std::int8_t>(predicates_.orient3d(frame_[0], frame_[1], frame_[2], v));
  }
  return side_[v];
}

bool FacetRecovery::recover(FacetId facet, const PlanarTriangulation& triangles,
                            std::vector<FaceHandle>& found) {
  frame_ = topology_.triangles[topology_.facet_triangles[facet][0]];
  next_epoch(facet_epoch_, side_mark_);
  done_.assign(triangles.triangles.size(), 0);
  for (std::uint32_t t = 0; t < triangles.triangles.size(); ++t) {
    control_.poll(predicates_.points().size());
    found.push_back(done_[t] != 0 ? FaceHandle()
                                  : find_face(mesh_, chains_, triangles.triangles[t]));
    if (done_[t] != 0 || found.back().exists()) continue;
    collect_patch(triangles, t);
    if (!recover_patch()) return false;
  }
  counters_.wrapped_tetrahedra = filler_.counters().wrapped;
  counters_.hidden_vertices = filler_.counters().hidden;
  counters_.blocked_tetrahedra = filler_.counters().blocked;
  return true;
}

// The missing triangles connected to `start` through missing edges, and the border between them and
// the triangles that are present.
void FacetRecovery::collect_patch(const PlanarTriangulation& all, std::uint32_t start) {
  patch_.clear();
  patch_border_.clear();
  std::vector<std::uint32_t> queue = {start};
  done_[start] = 1;
  for (std::size_t n = 0; n < queue.size(); ++n) {
    control_.poll(predicates_.points().size());
    const Triangle& v = all.triangles[queue[n]];
    patch_.push_back(v);
    for (int i = 0; i < 3; ++i) {
      const VertexId a = v[(i + 1) % 3], b = v[(i + 2) % 3];
      const std::uint32_t next = all.neighbors[queue[n]][i];
      if (next == kNone || find_edge(mesh_, chains_, a, b) != kNone) {
        patch_border_.push_back({a, b});
      } else if (done_[next / 3] == 0) {
        done_[next / 3] = 1;
        queue.push_back(next / 3);
      }
    }
  }
}

void FacetRecovery::add_to_cavity(TetId t) {
  if (cavity_mark_[t] == cavity_epoch_) return;
  cavity_mark_[t] = cavity_epoch_;
  cavity_.push_back(t);
}

// The tetrahedron at a border edge that the patch enters there: its other two vertices are on
// strictly different sides of the plane, and the patch leaves the edge between them.
bool FacetRecovery::seed(const std::array<VertexId, 2>& edge) {
  const VertexId a = edge[0], b = edge[1];
  const TetId first = find_edge(mesh_, chains_, a, b);
  if (first == kNone) return false;
  mesh_.edge_ring(first, a, b, ring_);
  for (const TetId t : ring_) {
    if (mesh_.is_ghost(t)) continue;
    std::array<VertexId, 2> other{};
    int count = 0;
    for (int i = 0; i < 4; ++i) {
      const VertexId v = mesh_.vertex(t, i);
      if (v != a && v != b) other[count++] = v;
    }
    const int s0 = side(other[0]), s1 = side(other[1]);
    if (s0 * s1 >= 0) continue;
    const VertexId above = s0 > 0 ? other[0] : other[1], below = s0 > 0 ? other[1] : other[0];
    // Seen along the edge, with "above" up, the patch leaves to the left: the tetrahedron must be
    // on that side, too.
    if (predicates_.orient3d(a, b, below, above) > 0) {
      add_to_cavity(t);
      return true;
    }
  }
  return false;
}

bool FacetRecovery::grow_cavity() {
  for (std::size_t n = 0; n < cavity_.size(); ++n) {
    control_.poll(predicates_.points().size());
    const TetId t = cavity_[n];
    for (int i = 0; i < 4; ++i) {
      bool above = false, below = false;
      for (int k : kFace[i]) {
        const int s = side(mesh_.vertex(t, k));
        above = above || s > 0;
        below = below || s < 0;
      }
      if (!above || !below) continue;
      const TetId next = mesh_.neighbor(t, i);
      if (mesh_.is_ghost(next)) return false;
      add_to_cavity(next);
    }
  }
  return true;
}

void FacetRecovery::collect_skin() {
  upper_skin_.clear();
  lower_skin_.clear();
  for (const TetId t : cavity_) {
    for (int i = 0; i < 4; ++i) {
      const Triangle v = {mesh_.vertex(t, kFace[i][0]), mesh_.vertex(t, kFace[i][1]),
                          mesh_.vertex(t, kFace[i][2])};
      const int s[3] = {side(v[0]), side(v[1]), side(v[2])};
      const bool above = s[0] > 0 || s[1] > 0 || s[2] > 0;
      const bool below = s[0] < 0 || s[1] < 0 || s[2] < 0;
      if (above && below) continue;
      (above ? upper_skin_ : lower_skin_).push_back({v, {t, i}});
    }
  }
}

// The vertices of the cavity that are on neither its skin nor the plane.
void FacetRecovery::collect_isolated() {
  upper_isolated_.clear();
  lower_isolated_.clear();
  for (const std::vector<SkinFace>* skin : {&upper_skin_, &lower_skin_}) {
    for (const SkinFace& f : *skin) {
      for (const VertexId v : f.vertices) skin_mark_[v] = cavity_epoch_;
    }
  }
  for (const TetId t : cavity_) {
    for (int i = 0; i < 4; ++i) {
      const VertexId v = mesh_.vertex(t, i);
      if (skin_mark_[v] == cavity_epoch_ || side(v) == 0) continue;
      skin_mark_[v] = cavity_epoch_;  // once is enough
      (side(v) > 0 ? upper_isolated_ : lower_isolated_).push_back(v);
    }
  }
}

bool FacetRecovery::recover_patch() {
  next_epoch(cavity_epoch_, cavity_mark_, skin_mark_);
  if (cavity_mark_.size() < mesh_.capacity()) cavity_mark_.resize(mesh_.capacity() * 3 / 2, 0);
  cavity_.clear();
  for (const auto& edge : patch_border_) {
    if (!seed(edge)) return false;
  }
  if (!grow_cavity()) return false;
  collect_skin();
  collect_isolated();
  number_vertices();
  counters_.isolated_vertices += upper_isolated_.size() + lower_isolated_.size();
  counters_.missing_triangles += patch_.size();
  ++counters_.patches;
  counters_.cavity_tetrahedra += cavity_.size();
  counters_.largest_cavity = std::max<std::uint64_t>(counters_.largest_cavity, cavity_.size());

  Filling filling;
  std::vector<Triangle> faces;
  for (const Triangle& t : patch_) faces.push_back(reversed(t));
  for (const SkinFace& f : upper_skin_) faces.push_back(f.vertices);
  if (!filler_.fill(std::move(faces), upper_isolated_, filling.tetrahedra)) return false;
  faces = patch_;
  for (const SkinFace& f : lower_skin_) faces.push_back(f.vertices);
  if (!filler_.fill(std::move(faces), lower_isolated_, filling.tetrahedra)) return false;
  if (!keeps_all_vertices(filling.tetrahedra)) return false;
  if (!match_faces(filling)) return false;
  put_in(filling);
  return true;
}

void FacetRecovery::number_vertices() {
  local_.clear();
  for (const TetId t : cavity_) {
    for (int i = 0; i < 4; ++i) local_.push_back(mesh_.vertex(t, i));
  }
  for (const Triangle& t : patch_) local_.insert(local_.end(), t.begin(), t.end());
  sort_unique(local_);
  // Three numbers to a key, here and in gift wrapping, whose vertices are among these.
  constexpr std::size_t kMost = (std::size_t{1} << 21) - 1;
  if (local_.size() > kMost) stop_at_size(kMost, "vertices of one cavity");
}

// Are all vertices of the cavity and the patch (numbered) corners of the tetrahedra?
bool FacetRecovery::keeps_all_vertices(const std::vector<Tetrahedron>& tetrahedra) const {
  std::vector<std::uint8_t> kept(local_.size(), 0);
  for (const Tetrahedron& t : tetrahedra) {
    for (const VertexId v : t) {
      kept[std::ranges::lower_bound(local_, v) - local_.begin()] = 1;
    }
  }
  return std::ranges::find(kept, 0) == kept.end();
}

std::uint64_t FacetRecovery::face_key(const Triangle& t) const {
  return directed_face_key(t, local_);
}

// Finds what lies across the faces of the new tetrahedra. False if they do not fill the cavity:
// every face of a new tetrahedron must be matched by another new one or be on the skin, and
// the whole skin must be covered.
bool FacetRecovery::match_faces(Filling& filling) const {
  // Directed face, counter-clockwise seen from outside its new tetrahedron -> its index.
  FlatMap owner;
  std::vector<Triangle> face(4 * filling.tetrahedra.size());
  for (std::uint32_t n = 0; n < filling.tetrahedra.size(); ++n) {
    for (int i = 0; i < 4; ++i) {
      const Tetrahedron& t = filling.tetrahedra[n];
      const std::uint32_t f = FaceHandle(n, i).index();
      face[f] = {t[kFace[i][0]], t[kFace[i][1]], t[kFace[i][2]]};
      if (owner.get(face_key(face[f]), kNone) != kNone) return false;
      owner.set(face_key(face[f]), f);
    }
  }
  filling.partner.assign(face.size(), {});
  filling.outer.assign(face.size(), {});
  if (!match_skin(owner, filling)) return false;
  for (std::uint32_t f = 0; f < face.size(); ++f) {
    if (filling.outer[f].exists()) continue;
    const std::uint32_t partner = owner.get(face_key(reversed(face[f])), kNone);
    if (partner == kNone) return false;
    filling.partner[f] = FaceHandle::at(partner);
  }
  return true;
}

bool FacetRecovery::match_skin(const FlatMap& owner, Filling& filling) const {
  for (const std::vector<SkinFace>* skin : {&upper_skin_, &lower_skin_}) {
    for (const SkinFace& s : *skin) {
      const std::uint32_t f = owner.get(face_key(s.vertices), kNone);
      if (f == kNone) return false;
      const FaceHandle beyond = mesh_.across(s.inner);
      // A dangling wall between two tetrahedra of the cavity is matched like any other face.
      if (cavity_mark_[beyond.tet()] != cavity_epoch_) filling.outer[f] = beyond;
    }
  }
  return true;
}

// Swaps the cavity's tetrahedra for the new ones.
void FacetRecovery::put_in(const Filling& filling) {
  for (const TetId t : cavity_) mesh_.destroy(t);
  std::vector<TetId> id;
  for (const Tetrahedron& t : filling.tetrahedra) {
    id.push_back(mesh_.create(t[0], t[1], t[2], t[3]));
    for (const VertexId v : t) mesh_.set_incident(v, id.back());
  }
  for (std::uint32_t f = 0; f < filling.partner.size(); ++f) {
    const FaceHandle face = FaceHandle::at(f);
    const bool inside = !filling.outer[f].exists();
    const FaceHandle across = inside ? filling.partner[f] : filling.outer[f];
    mesh_.glue(id[face.tet()], face.face(), inside ? id[across.tet()] : across.tet(),
               across.face());
  }
}

}  // namespace delmesher::cdt
