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
  explicit Budget(const Options& options) : budget_(options.budget), tau_(options.tau) {}

  // In force: a fraction of the diagonal.
  double tau() const { return tau_; }
  // Predicts the mesh of that surface, which was filtered with tau().
  void predict(const chamfer::ChamferedSurface& surface, const Session& session,
               Recorder& recorder);
  bool is_kept() const { return budget_ == 0 || predicted_ <= static_cast<double>(budget_); }
  // Not beyond a twentieth of the diagonal, because whole features of the model would go.
  bool can_double_tau() const;
  void double_tau();
  // Tells Session::control the prediction; throws Stopped if it exceeds the budget.
  void settle(Session& session) const;

 private:
  const std::uint64_t budget_;
  double tau_, predicted_ = 0;
};

}  // namespace delmesher::policies
