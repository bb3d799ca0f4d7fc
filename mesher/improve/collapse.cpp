#include "mesher/improve/collapse.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/epoch.h"

namespace delmesher::improve {

bool Collapse::run(VertexId v) {
  if (state_.mobility(v) == Mobility::fixed) return false;
  state_.mesh.star(v, star_);
  return take_out(v, state_.to_be_acceptable(state_.worst_of(star_)));
}

bool Collapse::run(VertexId v, const Quality& least) {
  if (state_.mobility(v) == Mobility::fixed) return false;
  state_.mesh.star(v, star_);
  return take_out(v, least);
}

bool Collapse::take_out(VertexId v, const Quality& least) {
  find_targets(v);
  look_around(v);
  VertexId best = kNone;
  float best_score = 0;
  for (const VertexId w : targets_) {
    const float score = score_after(w, least, best_score);
    if (score <= best_score) continue;
    best = w;
    best_score = score;
  }
  if (best == kNone || !certain(v, best)) return false;
  state_.contract(v, best, star_);
  return true;
}

// The neighbours of v that are on the same edge or facet of the surface, if v is on one.
void Collapse::find_targets(VertexId v) {
  targets_.clear();
  mark_.resize(state_.mesh.vertices(), 0);
  next_epoch(epoch_, mark_);
  mark_[v] = epoch_;
  for (const TetId t : star_) {
    for (const VertexId w : state_.mesh.tet(t)) {
      if (mark_[w] == epoch_) continue;
      mark_[w] = epoch_;
      targets_.push_back(w);
    }
  }
  if (state_.mobility(v) == Mobility::free) return;
  find_edges_on_surface(v);
  std::erase_if(targets_, [&](VertexId w) { return !stays_on_surface(v, w); });
}

// The edges from v on the surface: each twice, with the facets of the faces beside it.
void Collapse::find_edges_on_surface(VertexId v) {
  const MeshTopology& mesh = state_.mesh;
  edges_.clear();
  for (const TetId t : star_) {
    if (!mesh.inside(t)) continue;
    for (int k = 0; k < 4; ++k) {
      if (mesh.facet(t, k) == kNone || mesh.tet(t)[k] == v) continue;
      for (const int j : kFace[k]) {
        if (mesh.tet(t)[j] != v) edges_.emplace_back(mesh.tet(t)[j], mesh.facet(t, k));
      }
    }
  }
}

// May v go to w? Within its facet, or along the edge between its two facets.
bool Collapse::stays_on_surface(VertexId v, VertexId w) const {
  FacetId first = kNone;
  for (const auto& [x, facet] : edges_) {
    if (x != w) continue;
    if (first != kNone) {
      return state_.mobility(v) == (facet == first ? Mobility::in_plane : Mobility::on_line);
    }
    first = facet;
  }
  return false;
}

void Collapse::look_around(VertexId v) {
  around_.clear();
  for (const TetId t : star_) {
    around_.push_back({t, state_.mesh.index_of(t, v), state_.counts(t)});
  }
}

// The score of the worst tetrahedron of v's star after the collapse; 0 if that is not allowed, or
// if it is not above `enough`. What forbids one target often forbids the next.
float Collapse::score_after(VertexId w, const Quality& least, float enough) {
  float score = HUGE_VALF;
  for (Around& around : around_) {
    const auto& [t, i, counts] = around;
    if (state_.mesh.index_of(t, w) >= 0) continue;
    const Tet& tet = state_.mesh.tet(t);
    const Quality q = state_.quality_with(tet, i, state_.position(w), counts ? least : Quality{});
    bool ok = q.dihedral > 0;
    if (ok && counts) {
      score = std::min(score, state_.score(q));
      ok = State::reaches(q, least) && score > enough;
      for (int k = 0; k < 4; ++k) {
        ok = ok && (k == i || !state_.too_long(state_.position(w), state_.position(tet[k])));
      }
    }
    if (ok) continue;
    std::swap(around, around_.front());
    return 0;
  }
  return score;
}

bool Collapse::certain(VertexId v, VertexId w) {
  return std::all_of(star_.begin(), star_.end(), [&](TetId t) {
    if (state_.mesh.index_of(t, w) >= 0) return true;
    Tet tet = state_.mesh.tet(t);
    tet[state_.mesh.index_of(t, v)] = w;
    return state_.is_positive(tet);
  });
}

}  // namespace delmesher::improve
