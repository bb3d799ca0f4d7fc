// Refinement of tetrahedra by largest radius-edge ratio (section 5.4), with off-centres and sliver
// treatment (5.7).
#include <algorithm>
#include <string>

#include "mesher/base/check.h"
#include "mesher/refine/refiner.h"

namespace delmesher {
namespace {

// The proof of termination needs a radius-edge ratio above 2, that is an angle below asin(1/4)
// (design: the paper's 20.7 is the planar bound).
constexpr double kGuaranteedDelta = 14.4775;

}  // namespace

std::uint8_t Refiner::badness(TetId t) const {
  if (dt_.is_ghost(t)) return 0;
  if (options_.region == Region::interior && note(t, kSide) == kOutside) return 0;
  return goal_.badness(points_, dt_.vertices(t));
}

bool Refiner::reach(const Goal& goal, std::size_t cap) {
  goal_ = goal;
  bad_.start();
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    control_.poll(points_.size());
    if (!dt_.alive(t)) continue;
    const std::uint8_t level = badness(t);
    if (level != 0) bad_.add(t, level);
  }
  for (;;) {
    control_.poll(points_.size());
    drain();
    bad_.judge_fresh([&](TetId t) { return badness(t); });
    const TetId t = bad_.next();
    if (t == kNone) return true;
    if (points_.size() > cap) return false;
    if (options_.region == Region::interior && side_of(t) == kOutside) {
      bad_.dismiss(t);
    } else {
      split_tetrahedron(t);
    }
  }
}

// First what is guaranteed to end; then, with a cap on insertions, what is not: slivers and angles
// above the bound. Where a cap strikes, the guaranteed goal is reached once more, so that it holds
// in any case.
void Refiner::refine_tetrahedra() {
  refining_ = true;
  constexpr std::size_t kUnlimited = ~std::size_t{0};
  constexpr std::size_t kCapFactor = 4;
  const Goal guaranteed(std::min(options_.delta, kGuaranteedDelta), false, options_.max_edge);
  const Goal wanted(options_.delta, options_.slivers, options_.max_edge);
  reach(guaranteed, kUnlimited);
  if (!options_.slivers && options_.delta <= kGuaranteedDelta) return;
  if (!reach(wanted, kCapFactor * points_.size())) reach(guaranteed, kUnlimited);
}

void Refiner::split_tetrahedron(TetId t) {
  const VolumeTargets targets = steiner_.in_tetrahedron(dt_.vertices(t), goal_);
  for (std::size_t n = 0; n < targets.count; ++n) {
    if (try_volume_point(t, steiner_.in_volume(targets.place[n], targets.grid))) return;
  }
  // No double is in the circumball: the solid is a few roundings thick there.
  const VertexId* v = dt_.vertices(t);
  const VertexId* corner =
      std::find_if(v, v + 4, [&](VertexId w) { return w < topology_.vertex_half_edge.size(); });
  stop_at_precision(corner != v + 4 ? "vertex " + std::to_string(*corner) : "a tetrahedron inside");
}

// Inserts the point, the last of the store, unless it encroaches, in which case what it encroaches
// upon is queued. False if the point is not inside the circumball.
bool Refiner::try_volume_point(TetId t, VertexId v) {
  const VertexId* w = dt_.vertices(t);
  if (predicates_.insphere_perturbed(w[0], w[1], w[2], w[3], v) <= 0) {
    points_.pop_back();
    return false;
  }
  if (!find_free_cavity(v, t, true)) {
    points_.pop_back();  // t waits on
    return true;
  }
  in_volume_.push_back(v);
  if (options_.want_balls) ball_.push_back({w[0], w[1], w[2], w[3]});
  commit(v);
  new_subfacets_.clear();
  after_insertion();
  return true;
}

}  // namespace delmesher
