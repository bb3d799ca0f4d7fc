#include "mesher/improve/face_removal.h"

#include <algorithm>

namespace delmesher::improve {

bool FaceRemoval::run(TetId t, int i) {
  judge_.region = state_.mesh.region(t);
  if (!state_.counts(t) || !operation_.find(t, i, judge_)) return false;
  const Quality least = state_.to_be_better(state_.worst_of(operation_.change().removed));
  return std::ranges::all_of(operation_.values(),
                             [&](const Quality& q) { return State::reaches(q, least); }) &&
         state_.accept(operation_.change());
}

}  // namespace delmesher::improve
