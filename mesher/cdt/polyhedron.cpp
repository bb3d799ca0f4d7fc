#include "mesher/cdt/polyhedron.h"

#include <algorithm>
#include <span>

#include "mesher/base/check.h"
#include "mesher/base/sort_unique.h"
#include "mesher/cdt/gift_wrapping.h"
#include "mesher/cdt/separation.h"

namespace delmesher::cdt {
namespace {

// Fewer vertices are not worth a Delaunay tetrahedrization of their own.
constexpr std::size_t kWrapBelow = 12;

// The tetrahedra of the vertices' unconstrained Delaunay tetrahedrization that are constrained
// Delaunay in the polyhedron: the tetrahedra inside it that no missing face of it enters.
class DelaunayPart {
 public:
  DelaunayPart(Predicates& predicates, Control& control, const std::vector<Triangle>& faces)
      : predicates_(predicates), control_(control), faces_(faces), mesh_(predicates) {}

  void run(const std::vector<VertexId>& vertices) {
    mesh_.build(vertices, control_);
    wall_.assign(4 * mesh_.capacity(), 0);
    state_.assign(mesh_.capacity(), kUnknown);
    find_faces();
    block();
    flood();
  }

  std::uint64_t blocked() const { return blocked_; }

  // The tetrahedra found so far, and the faces of the polyhedron that is still empty. False if the
  // tetrahedra reach beyond the hull: then the faces enclose nothing.
  bool collect(std::vector<Tetrahedron>& tetrahedra, std::vector<Triangle>& rest) const {
    for (std::uint32_t n = 0; n < faces_.size(); ++n) {
      if (!inner_[n].exists() || state_[inner_[n].tet()] != kInside) rest.push_back(faces_[n]);
    }
    for (const TetId t : inside_) {
      if (mesh_.is_ghost(t)) return false;
      const VertexId* v = mesh_.vertices(t);
      tetrahedra.push_back({v[0], v[1], v[2], v[3]});
      for (int i = 0; i < 4; ++i) {
        if (is_wall({t, i}) || state_[mesh_.neighbor(t, i)] == kInside) continue;
        rest.push_back({v[kFace[i][0]], v[kFace[i][2]], v[kFace[i][1]]});
      }
    }
    return true;
  }

 private:
  enum State : std::uint8_t { kUnknown, kInside, kBlocked };

  void find_faces() {
    inner_.assign(faces_.size(), {});
    for (std::uint32_t n = 0; n < faces_.size(); ++n) {
      control_.poll();
      const Triangle& f = faces_[n];
      const FaceHandle found = mesh_.find_face(f[0], f[1], f[2]);
      if (!found.exists()) continue;
      // f is counter-clockwise seen from outside the polyhedron; seen from outside the tetrahedron
      // on its inner side it is so, too.
      const FaceHandle beyond = mesh_.across(found);
      inner_[n] = corner_after(found, f[0]) == f[1] ? found : beyond;
      wall_[found.index()] = wall_[beyond.index()] = 1;
    }
  }
  // The corner of the face that follows v in the order of kFace.
  VertexId corner_after(FaceHandle face, VertexId v) const {
    const auto& corner = kFace[face.face()];
    int k = 0;
    while (mesh_.vertex(face.tet(), corner[k]) != v) ++k;
    return mesh_.vertex(face.tet(), corner[(k + 1) % 3]);
  }
  bool is_wall(FaceHandle face) const { return wall_[face.index()] != 0; }

  void block() {
    std::vector<Triangle> missing;
    for (std::uint32_t n = 0; n < faces_.size(); ++n) {
      if (!inner_[n].exists()) missing.push_back(faces_[n]);
    }
    if (missing.empty()) return;
    for (TetId t = 0; t < mesh_.capacity(); ++t) {
      if (!mesh_.alive(t) || mesh_.is_ghost(t)) continue;
      control_.poll();
      const VertexId* v = mesh_.vertices(t);
      const Tetrahedron tet = {v[0], v[1], v[2], v[3]};
      for (const Triangle& f : missing) {
        if (boxes_disjoint(predicates_.points(), tet, f)) continue;
        if (may_meet_improperly(predicates_, tet, f)) {
          state_[t] = kBlocked;
          ++blocked_;
          break;
        }
      }
    }
  }

  void flood() {
    const auto take = [&](TetId t) {
      if (state_[t] != kUnknown) return;
      state_[t] = kInside;
      inside_.push_back(t);
    };
    for (const FaceHandle face : inner_) {
      if (face.exists()) take(face.tet());
    }
    for (std::size_t n = 0; n < inside_.size(); ++n) {
      const TetId t = inside_[n];
      for (int i = 0; i < 4; ++i) {
        if (!is_wall({t, i})) take(mesh_.neighbor(t, i));
      }
    }
  }

  Predicates& predicates_;
  Control& control_;
  const std::vector<Triangle>& faces_;
  Tetrahedrization mesh_;
  std::vector<std::uint8_t> wall_;  // per face of a tetrahedron: is it one of the polyhedron?
  std::vector<State> state_;
  std::vector<FaceHandle> inner_;  // per face of the polyhedron, from its inner side; or none
  std::vector<TetId> inside_;
  std::uint64_t blocked_ = 0;
};

}  // namespace

void PolyhedronFiller::collect_vertices(const std::vector<Triangle>& faces,
                                        const std::vector<VertexId>& isolated) {
  vertices_ = isolated;
  for (const Triangle& f : faces) vertices_.insert(vertices_.end(), f.begin(), f.end());
  sort_unique(vertices_);
}

bool PolyhedronFiller::delaunay_part(std::vector<Triangle>& faces,
                                     std::vector<Tetrahedron>& tetrahedra) {
  std::vector<Triangle> rest;
  DelaunayPart part(predicates_, control_, faces);
  part.run(vertices_);
  counters_.blocked += part.blocked();
  if (!part.collect(tetrahedra, rest)) return false;
  faces = std::move(rest);
  return true;
}

bool PolyhedronFiller::fill(std::vector<Triangle> faces, std::vector<VertexId> isolated,
                            std::vector<Tetrahedron>& tetrahedra) {
  const std::size_t start = tetrahedra.size();
  for (;;) {
    if (faces.empty()) return isolated.empty();
    collect_vertices(faces, isolated);
    if (vertices_.size() < kWrapBelow) break;
    const std::size_t before = tetrahedra.size();
    if (!delaunay_part(faces, tetrahedra)) {
      tetrahedra.resize(start);
      return false;
    }
    if (tetrahedra.size() == before) break;
    const std::span added = std::span(tetrahedra).subspan(before);
    std::erase_if(isolated, [&](VertexId v) {  // from now on it is on a face, or done with
      return std::ranges::any_of(
          added, [&](const Tetrahedron& t) { return std::ranges::find(t, v) != t.end(); });
    });
  }
  if (gift_wrap(predicates_, control_, faces, vertices_, tetrahedra, counters_)) return true;
  tetrahedra.resize(start);
  return false;
}

}  // namespace delmesher::cdt
