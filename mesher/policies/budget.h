// Policy: how much of the surface the filter drops, so that the mesh keeps to a budget.
#pragma once

#include <optional>

#include "mesher/chamfer/filter.h"
#include "mesher/results/recorder.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// The filter's tolerance is Options::tau, and doubled as long as more tetrahedra are predicted than
// Options::budget says (0: never). With SurfaceChoice::automatic the budget is what the option says
// there, and the tolerance kFinestTau, or Options::tau where that is too much.
class Budget {
 public:
  // A fraction of the diagonal. Features that are smaller are hardly meant, and few doubles tell
  // their points apart.
  static constexpr double kFinestTau = 1e-9;

  explicit Budget(const Options& options)
      : is_automatic_(options.surface == SurfaceChoice::automatic),
        budget_(static_cast<double>(options.budget)),
        tau_asked_(options.tau),
        tau_(is_automatic_ ? kFinestTau : tau_asked_) {}

  // In force: a fraction of the diagonal.
  double tau() const { return tau_; }
  // Does what the first step of the filter has left take too many tetrahedra, however it is
  // chamfered? Then there is no need to do that.
  bool is_exceeded_at_least(chamfer::FilteredSurface& surface, const Session& session,
                            Recorder& recorder);
  // Predicts the mesh of that surface, which was filtered with tau().
  void predict(chamfer::FilteredSurface& surface, const Session& session, Recorder& recorder);
  bool is_kept() const { return budget_ == 0 || predicted_ <= budget_; }
  // Not beyond a twentieth of the diagonal, because whole features of the model would go.
  bool can_raise_tau() const;
  void raise_tau();
  // Tells Session::control the prediction; throws Stopped, as a limit of size, if it exceeds the
  // budget. With SurfaceChoice::automatic a refinement far beyond it ends in the same way.
  void settle(Session& session) const;

 private:
  double least(chamfer::FilteredSurface& surface, const Session& session) const;

  const bool is_automatic_;
  double budget_;  // tetrahedra; 0: none, or not known yet
  const double tau_asked_;
  double tau_, predicted_ = 0;
  std::optional<double> least_of_whole_;  // least(), with nothing dropped
  std::uint64_t times_chamfered_ = 0;     // before the last prediction
};

}  // namespace delmesher::policies
