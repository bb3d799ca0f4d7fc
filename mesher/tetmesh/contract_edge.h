// Contracts an edge: one of its vertices goes, and its star is filled from the other. A vertex of a
// facet goes to another one of that facet, a vertex of an input edge along that edge, so that the
// surface is the same.
//
// The operation only proposes where the vertex goes. A judge says what the changed tetrahedra are
// worth:
//   Value nothing()                    of none
//   bool add(TetId t, int i, VertexId w, Value&)
//                                      vertex i of t becomes w; false if that must not be
//   bool is_better(Value, Value best)
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "mesher/base/epoch.h"
#include "mesher/tetmesh/mesh_topology.h"

namespace delmesher::tetmesh {

template <class Judge>
class ContractEdge {
 public:
  using Value = typename Judge::Value;

  explicit ContractEdge(const MeshTopology& mesh) : mesh_(mesh) {}

  // Considers v, and finds its star.
  void begin(VertexId v) {
    v_ = v;
    mesh_.star(v, star_);
  }
  const std::vector<TetId>& star() const { return star_; }

  // The best of the vertices that v can go to, if one is better than `least`; else kNone.
  // `in_volume`: v is known to be neither on the surface nor on the hull.
  VertexId find(const Value& least, Judge& judge, bool in_volume = false) {
    find_targets(in_volume);
    around_.clear();
    for (const TetId t : star_) around_.emplace_back(t, mesh_.index_of(t, v_));
    VertexId target = kNone;
    Value best = least;
    for (const VertexId w : targets_) {
      Value value = judge.nothing();
      if (!evaluate(w, best, judge, value)) continue;
      target = w;
      best = value;
    }
    return target;
  }

 private:
  // The neighbours of v; if it is on the surface, those on the same edge or facet; none if it is on
  // the hull beside the surface.
  void find_targets(bool in_volume) {
    targets_.clear();
    mark_.resize(mesh_.vertices(), 0);
    next_epoch(epoch_, mark_);
    mark_[v_] = epoch_;
    for (const TetId t : star_) {
      for (const VertexId w : mesh_.tet(t)) {
        if (mark_[w] == epoch_) continue;
        mark_[w] = epoch_;
        targets_.push_back(w);
      }
    }
    if (in_volume) return;
    const bool on_hull = find_edges_on_surface();
    if (edges_.empty() && on_hull) targets_.clear();
    if (edges_.empty()) return;
    const bool in_facet = std::ranges::all_of(
        edges_, [&](const auto& edge) { return edge.second == edges_.front().second; });
    if (in_facet && keep_rim()) return;
    std::erase_if(targets_, [&](VertexId w) { return !stays_on_surface(in_facet, w); });
  }

  // Of a vertex on a free edge of the surface: the targets along it, which are on one face at v.
  bool keep_rim() {
    std::vector<VertexId>& once = once_;
    once.clear();
    for (const auto& [w, facet] : edges_) once.push_back(w);
    std::ranges::sort(once);
    std::size_t kept = 0;
    for (std::size_t n = 0, end = 0; n < once.size(); n = end) {
      for (end = n + 1; end < once.size() && once[end] == once[n];) ++end;
      if (end == n + 1) once[kept++] = once[n];
    }
    once.resize(kept);
    if (once.empty()) return false;
    std::erase_if(targets_, [&](VertexId w) { return !std::ranges::binary_search(once, w); });
    return true;
  }

  // The edges from v on the surface: each twice, with the facets of the faces beside it. Is a face
  // at v on the hull, and not on the surface?
  bool find_edges_on_surface() {
    edges_.clear();
    bool on_hull = false;
    for (const TetId t : star_) {
      for (int k = 0; k < 4; ++k) {
        const FacetId facet = mesh_.facet(t, k);
        if (mesh_.tet(t)[k] == v_) continue;
        on_hull = on_hull || (facet == kNone && mesh_.neighbor(t, k) == kNone);
        if (facet == kNone || !mesh_.is_told_from(t, k)) continue;
        for (const int j : kFace[k]) {
          if (mesh_.tet(t)[j] != v_) edges_.emplace_back(mesh_.tet(t)[j], facet);
        }
      }
    }
    return on_hull;
  }

  // May v go to w? Within its facet, or along the edge between its two facets.
  bool stays_on_surface(bool in_facet, VertexId w) const {
    FacetId first = kNone;
    for (const auto& [x, facet] : edges_) {
      if (x != w) continue;
      if (first != kNone) return in_facet == (facet == first);
      first = facet;
    }
    return false;
  }

  // Is v's star better than `best` after it has gone to w? What forbids one target often forbids
  // the next.
  bool evaluate(VertexId w, const Value& best, Judge& judge, Value& value) {
    for (auto& around : around_) {
      const auto& [t, i] = around;
      if (mesh_.index_of(t, w) >= 0) continue;
      if (judge.add(t, i, w, value) && judge.is_better(value, best)) continue;
      std::swap(around, around_.front());
      return false;
    }
    return judge.is_better(value, best);
  }

  const MeshTopology& mesh_;
  VertexId v_ = 0;
  std::vector<TetId> star_;
  std::vector<std::pair<TetId, int>> around_;  // and the corner at v; those first that forbade
  std::vector<VertexId> targets_;
  std::vector<std::uint32_t> mark_;  // of find_targets()
  std::uint32_t epoch_ = 0;
  std::vector<std::pair<VertexId, FacetId>> edges_;  // of the surface
  std::vector<VertexId> once_;                       // of keep_rim()
};

}  // namespace delmesher::tetmesh
