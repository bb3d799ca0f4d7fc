// Puts a point into a cavity of tetrahedra: those between the point and the cavity's skin replace
// them (Klingner and Shewchuk 2007, "Aggressive tetrahedral mesh improvement").
//
// A point on the surface is in a facet, or on an edge between two: its own facets. The cavity is on
// both sides of these: no face of them is left on its skin but on the hull, and those within it are
// tiled anew from the point. It crosses no other facet, so that the surface is the same.
// Growing it and then asking for its skin takes time linear in its size.
//
// The operation only finds what is to be replaced. Who calls grows the cavity, and decides whether
// the point sees its skin. A judge tells what the tetrahedron between the point and a face is
// worth:
//   Value value_of(TetId t, int i)   face i of t
//   Value in_plane()                 for faces in the point's facets, where there is none
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "mesher/base/epoch.h"
#include "mesher/tetmesh/mesh_topology.h"

namespace delmesher::tetmesh {

template <class Judge>
class InsertPoint {
 public:
  struct Face {
    TetId tet;  // in the cavity
    int face;
    typename Judge::Value value;
  };
  // An edge of a face that is replaced, a tetrahedron at that face, and the index of the corner
  // there that is not on the edge.
  struct FaceEdge {
    std::array<VertexId, 2> ends;  // the smaller one first
    FacetId facet;
    TetId tet;
    int corner;
  };

  explicit InsertPoint(const MeshTopology& mesh) : mesh_(mesh) {}

  // `own`: facets of the point; kNone in the volume. `piece`: the ends of the edge between them
  // that it is on, the smaller one first.
  void begin(const std::array<FacetId, 2>& own, const std::array<VertexId, 2>& piece) {
    own_ = own;
    piece_ = piece;
    crosses_ = false;
    cavity_.clear();
    skin_.clear();
    covered_ = false;
    mark_.resize(mesh_.slots(), 0);
    next_epoch(epoch_, mark_);
  }
  void add(TetId t, const Judge& judge) { add(t, -1, judge); }
  // The tetrahedron beyond a face of the skin.
  void cross(typename std::vector<Face>::const_iterator face, const Judge& judge) {
    const auto [tet, i, value] = *face;
    skin_.erase(face);
    add(mesh_.neighbor(tet, i), mesh_.mirror(tet, i), judge);
  }
  const std::vector<TetId>& cavity() const { return cavity_; }
  bool contains(TetId t) const { return t != kNone && mark_[t] == epoch_; }
  // In the order in which its faces came.
  std::vector<Face>& skin() {
    if (covered_) {
      std::erase_if(skin_, [&](const Face& f) { return contains(mesh_.neighbor(f.tet, f.face)); });
    }
    covered_ = false;
    return skin_;
  }
  bool crosses_facets() const { return crosses_; }
  // Is face i of t in a facet of the point?
  bool is_own(TetId t, int i) const {
    const FacetId facet = mesh_.facet(t, i);
    return facet != kNone && (facet == own_[0] || facet == own_[1]);
  }

  // Finds the change, with kNone for the point. False if the surface would be another one, or a
  // vertex would go that may not: bool may_go(VertexId).
  template <class MayGo>
  bool find_change(const MayGo& may_go) {
    created_.clear();
    faces_.clear();
    outline_.clear();
    inner_.clear();
    if (crosses_) return false;
    for (const auto& [tet, face, value] : skin()) {
      if (is_own(tet, face)) {
        if (mesh_.neighbor(tet, face) != kNone) return false;
        continue;
      }
      created_.push_back({mesh_.tet(tet), mesh_.region(tet)});
      created_.back().vertices[face] = kNone;
    }
    return keeps_vertices(may_go) && (own_[0] == kNone || tile_facets());
  }
  std::vector<CreatedTet>& created() { return created_; }
  std::vector<SurfaceFace>& faces() { return faces_; }
  // Of the faces that are replaced: the edges around all of them, and those between two of one
  // facet, which go.
  const std::vector<FaceEdge>& outline() const { return outline_; }
  const std::vector<FaceEdge>& inner() const { return inner_; }

 private:
  // `from`: its face that is no longer on the skin, -1 if none is known.
  void add(TetId t, int from, const Judge& judge) {
    cavity_.push_back(t);
    mark_[t] = epoch_;
    for (int i = 0; i < 4; ++i) {
      const TetId u = mesh_.neighbor(t, i);
      if (!contains(u)) {
        skin_.push_back({t, i, is_own(t, i) ? Judge::in_plane() : judge.value_of(t, i)});
        continue;
      }
      crosses_ = crosses_ || (mesh_.facet(t, i) != kNone && !is_own(t, i));
      covered_ = covered_ || i != from;
    }
  }

  template <class MayGo>
  bool keeps_vertices(const MayGo& may_go) {
    kept_.resize(mesh_.vertices(), 0);
    next_epoch(kept_epoch_, kept_);
    for (const CreatedTet& tet : created_) {
      for (const VertexId v : tet.vertices) {
        if (v != kNone) kept_[v] = kept_epoch_;
      }
    }
    return std::ranges::all_of(cavity_, [&](TetId t) {
      return std::ranges::all_of(mesh_.tet(t),
                                 [&](VertexId v) { return kept_[v] == kept_epoch_ || may_go(v); });
    });
  }

  bool tile_facets() {
    edges_.clear();
    for (const TetId t : cavity_) {
      for (int i = 0; i < 4; ++i) {
        const TetId u = mesh_.neighbor(t, i);
        if (!is_own(t, i) || (u != kNone && u < t)) continue;
        for (int k = 0; k < 3; ++k) {
          const auto [a, b] =
              std::minmax(mesh_.tet(t)[kFace[i][k]], mesh_.tet(t)[kFace[i][(k + 1) % 3]]);
          edges_.push_back({{a, b}, mesh_.facet(t, i), t, kFace[i][(k + 2) % 3]});
        }
      }
    }
    const auto key = [](const FaceEdge& e) { return std::tie(e.ends, e.facet); };
    std::ranges::sort(edges_, {}, key);
    int pieces = 0;
    for (auto e = edges_.begin(); e != edges_.end(); ++e) {
      if (e + 1 != edges_.end() && key(e[0]) == key(e[1])) {
        inner_.push_back(*e++);
      } else if (e->ends == piece_) {
        ++pieces;
      } else {
        outline_.push_back(*e);
        faces_.push_back({{e->ends[0], e->ends[1], kNone}, e->facet});
      }
    }
    return own_[1] == kNone || own_[1] == own_[0] || pieces == 2;
  }

  const MeshTopology& mesh_;
  std::array<FacetId, 2> own_ = {kNone, kNone};
  std::array<VertexId, 2> piece_ = {kNone, kNone};
  bool crosses_ = false;  // facets that are not the point's
  std::vector<TetId> cavity_;
  std::vector<std::uint32_t> mark_;  // per slot: epoch_ in the cavity
  std::uint32_t epoch_ = 0;
  std::vector<Face> skin_;
  bool covered_ = false;  // some of these are no longer on the skin
  std::vector<CreatedTet> created_;
  std::vector<SurfaceFace> faces_;
  std::vector<FaceEdge> edges_, outline_, inner_;
  std::vector<std::uint32_t> kept_;  // per vertex: kept_epoch_ if it stays
  std::uint32_t kept_epoch_ = 0;
};

}  // namespace delmesher::tetmesh
