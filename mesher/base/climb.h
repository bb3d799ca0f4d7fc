// How the rungs of the ladder (delmesher/ladder.h) are taken.
#pragma once

#include <cstddef>

#include "mesher/base/namespaces.h"
#include "mesher/delmesher/ladder.h"

namespace delmesher::base {

template <class Attempt>
struct Step {
  Rung rung;
  bool (*applies)(const Attempt&);
  void (*take)(Attempt&);
};

// Takes the steps in their order, each as long as it applies and as often as its row allows, until
// the attempt is good enough. Counts a step before it is taken: it may end the run.
template <class Attempt, std::size_t kSteps>
void climb(Attempt& attempt, const Step<Attempt> (&steps)[kSteps], RungCounts& counts) {
  for (const Step<Attempt>& step : steps) {
    const std::size_t most = kLadder[static_cast<std::size_t>(step.rung)].at_most;
    for (std::size_t n = 0; n < most && !attempt.good_enough() && step.applies(attempt); ++n) {
      ++counts[step.rung];
      step.take(attempt);
    }
  }
}

}  // namespace delmesher::base
