// Policy: is the refined mesh too heavy? Then the filter drops more, or the surface is kept.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "mesher/chamfer/filter.h"
#include "mesher/results/recorder.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// Tetrahedra may be as many as Options::budget says; else, with SurfaceChoice::automatic, four
// times those of a kept surface. Where more are predicted, for a budget far more, or made, the run
// ends with Limit::budget. With SurfaceChoice::automatic the filter's tolerance is kFinestTau, and
// Options::tau where that is too much.
class Budget {
 public:
  // A fraction of the diagonal. Features that are smaller are hardly meant, and few doubles tell
  // their points apart.
  static constexpr double kFinestTau = 1e-9;

  explicit Budget(const Options& options);

  // In force: a fraction of the diagonal.
  double tau() const { return tau_; }
  // Does what the first step of the filter has left take too many tetrahedra, however it is
  // chamfered? Then there is no need to do that.
  bool is_exceeded_at_least(chamfer::FilteredSurface& surface, const Session& session,
                            Recorder& recorder);
  // Predicts the mesh of that surface, which was filtered with tau().
  void predict(chamfer::FilteredSurface& surface, const Session& session, Recorder& recorder);
  bool is_kept() const { return most_predicted_ == 0 || predicted_ <= most_predicted_; }
  bool can_raise_tau() const { return tau_ < tau_asked_; }
  void raise_tau() { tau_ = tau_asked_; }
  // Tells Session::control the prediction; throws Stopped if it is too much.
  void settle(Session& session) const;
  // What makes far more vertices than are wanted ends in the same way from now on.
  void bound(Session& session) const;

  // Not OK, with the limit of the budget, if a mesh to be written has more.
  static Status check(const Options& options, const Result& result);

 private:
  double least(chamfer::FilteredSurface& surface, const Session& session) const;
  void want_at_most(double tetrahedra);
  std::string excess() const;

  const bool is_automatic_;
  const std::uint64_t budget_;
  const double tau_asked_;
  double tau_, predicted_ = 0;
  double most_predicted_ = 0;             // 0: any number, or not known yet
  double most_vertices_ = 0;              // that may be added
  std::optional<double> least_of_whole_;  // least(), with nothing dropped
  std::uint64_t times_chamfered_ = 0;     // before the last prediction
};

}  // namespace delmesher::policies
