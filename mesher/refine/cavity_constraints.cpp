#include "mesher/refine/cavity_constraints.h"

#include "mesher/base/epoch.h"

namespace delmesher::refine {

void CavityConstraints::begin() {
  next_epoch(epoch_, subfacet_mark_, subsegment_mark_);
  subfacet_mark_.resize(subfacets_.size(), 0);
  subsegment_mark_.resize(subsegments_.size(), 0);
  found_subfacets_.clear();
  found_subsegments_.clear();
}

void CavityConstraints::collect(TetId t) {
  if (subfacets_.any_on(t)) {
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t s = subfacets_.on_face(t, i);
      if (s == kNone) continue;
      if (subfacet_mark_[s] == epoch_) {
        for (FoundSubfacet& found : found_subfacets_) found.internal |= found.id == s;
        continue;
      }
      subfacet_mark_[s] = epoch_;
      found_subfacets_.push_back({s, false});
    }
  }
  subsegments_.for_each_on(t, [&](std::uint32_t s) {
    if (subsegment_mark_[s] == epoch_) return;
    subsegment_mark_[s] = epoch_;
    found_subsegments_.push_back(s);
  });
}

bool CavityConstraints::queue_encroached_subsegments(VertexId v, Count first,
                                                     std::uint32_t except) {
  bool any = false;
  for (std::size_t n = first.subsegments; n < found_subsegments_.size(); ++n) {
    const std::uint32_t s = found_subsegments_[n];
    if (s == except || !subsegments_.encroached_by(s, v)) continue;
    subsegments_.queue(s);
    any = true;
  }
  return any;
}

bool CavityConstraints::queue_encroached_subfacets(VertexId v, Count first) {
  bool any = false;
  for (std::size_t n = first.subfacets; n < found_subfacets_.size(); ++n) {
    const std::uint32_t s = found_subfacets_[n].id;
    if (!subfacets_.encroached_by(s, v)) continue;
    subfacets_.queue(s);
    any = true;
  }
  return any;
}

bool CavityConstraints::queue_lost_subfacets(TetId t) {
  if (!subfacets_.any_on(t)) return false;
  const bool ghost = dt_.is_ghost(t);
  bool any = false;
  for (int i = 0; i < 4; ++i) {
    const std::uint32_t s = subfacets_.on_face(t, i);
    if (s == kNone) continue;
    if (!ghost && !dt_.in_cavity(dt_.neighbor(t, i))) continue;
    subfacets_.queue(s);
    any = true;
  }
  return any;
}

void CavityConstraints::requeue_lost() {
  for (const FoundSubfacet& found : found_subfacets_) {
    if (found.internal) subfacets_.queue(found.id);
  }
  next_epoch(epoch_, subfacet_mark_, subsegment_mark_);
  for (const TetId t : dt_.created()) {
    // A subsegment that is younger than the cavity has no mark, and cannot be lost.
    subsegments_.for_each_on(t, [&](std::uint32_t s) {
      if (s < subsegment_mark_.size()) subsegment_mark_[s] = epoch_;
    });
  }
  for (const std::uint32_t s : found_subsegments_) {
    if (subsegment_mark_[s] != epoch_) subsegments_.queue(s);
  }
}

}  // namespace delmesher::refine
