#include "mesher/improve/edge_removal.h"

#include <algorithm>
#include <cmath>

namespace delmesher::improve {

bool EdgeRemoval::run(TetId t, int i, int j, std::span<const std::uint32_t> failed) {
  if (!find(t, i, j, Operation::kLongest, failed)) return false;
  judge_.want(Aim::best_worst, state_.to_be_better(state_.worst_of(operation_.ring())));
  return refill(-HUGE_VAL);
}

bool EdgeRemoval::flip(TetId t, int i, int j) {
  if (!find(t, i, j, Operation::kLongest, {}) || !operation_.is_in_facet()) return false;
  judge_.want(Aim::best_worst, {});
  return refill(-HUGE_VAL);
}

bool EdgeRemoval::round_off(TetId t, int i, int j, std::span<const std::uint32_t> failed) {
  // Of a change, so that many that bring nothing do not follow each other.
  constexpr double kLeastGain = 0.02;
  const Tet& tet = state_.mesh.tet(t);
  judge_.look_at(tet[i], tet[j], failed);
  for (const int k : opposite_edge(i, j)) {  // most rings are known by one of these
    if (judge_.is_known(state_.mesh.neighbor(t, k))) return false;
  }
  const auto is_on_surface = [&](VertexId v) { return state_.mobility(v) != Mobility::free; };
  const int longest =
      is_on_surface(tet[i]) && is_on_surface(tet[j]) ? kLongestForRoundness : kLargestForRoundness;
  if (!find(t, i, j, static_cast<std::size_t>(longest), failed)) return false;
  if (std::ranges::any_of(operation_.polygons(),
                          [](const auto& p) { return p.size > kLargestForRoundness; })) {
    return false;
  }
  judge_.want(Aim::roundest, state_.to_be_acceptable(state_.worst_of(operation_.ring())));
  double before = 0;
  for (const TetId u : operation_.ring()) {
    if (state_.counts(u)) before += Judge::roundness(state_.quality(u));
  }
  return refill(before + kLeastGain);
}

bool EdgeRemoval::find(TetId t, int i, int j, std::size_t longest,
                       std::span<const std::uint32_t> failed) {
  judge_.look_at(state_.mesh.tet(t)[i], state_.mesh.tet(t)[j], failed);
  return operation_.find(t, i, j, longest, judge_);
}

// Fills all polygons, if that is rounder than this.
bool EdgeRemoval::refill(double least_roundness) {
  const Filling filling = operation_.refill(judge_);
  return Judge::is_possible(filling) && filling.roundness > least_roundness &&
         state_.accept(operation_.change());
}

// Above 0 for tetrahedra rounder than kMean, which raise the mean; of the others, fewer are better.
double EdgeRemoval::Judge::roundness(const Quality& q) {
  constexpr double kMean = 0.65;
  return std::sqrt(q.gamma) - kMean;
}

}  // namespace delmesher::improve
