// Policy: how much of the surface the filter drops, so that the mesh keeps to a budget.
#pragma once

#include "mesher/chamfer/filter.h"
#include "mesher/results/recorder.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// The filter's tolerance is Options::tau, and doubled as long as more tetrahedra are predicted than
// Options::budget says (0: never).
class Budget {
 public:
  explicit Budget(const Options& options) : tau_(options.tau) {}

  // In force: a fraction of the diagonal.
  double tau() const { return tau_; }

  // Doubles tau() if the mesh of that surface, which was filtered with tau(), is predicted to
  // exceed the budget; throws Stopped where tau() is too large for that. Returns whether it was
  // doubled. Otherwise the prediction is told to Session::control.
  bool raise_tau_over_budget(const chamfer::ChamferedSurface& surface, Session& session,
                             Recorder& recorder);

 private:
  double tau_;
};

}  // namespace delmesher::policies
