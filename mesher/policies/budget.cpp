#include "mesher/policies/budget.h"

#include <algorithm>
#include <string>

#include "mesher/refine/prediction.h"

namespace delmesher::policies {
namespace {

double predict(const chamfer::ChamferedSurface& surface, const Session& session) {
  refine::PredictionOptions options;
  options.region = session.options.region;
  options.max_edge = session.options.max_edge;
  options.sizes = &session.sizes;
  // Every triangle that the filter drops comes back in the final step, with at least one and a half
  // tetrahedra.
  return 1.5 * static_cast<double>(surface.filter.dropped_triangles) +
         refine::predict_tetrahedra(surface.chamfer.plc, session.topology,
                                    surface.filter.facet_kept, session.points, options,
                                    session.control);
}

std::string over_budget(double predicted, double tau, std::uint64_t budget) {
  return "about " + std::to_string(static_cast<std::uint64_t>(predicted)) +
         " tetrahedra are predicted even with tau " + std::to_string(tau) +
         ", more than the budget of " + std::to_string(budget);
}

}  // namespace

bool Budget::raise_tau_over_budget(const chamfer::ChamferedSurface& surface, Session& session,
                                   Recorder& recorder) {
  // Beyond this, whole features of the model go.
  constexpr double kLargestTau = 0.05, kLeastTau = 1e-5;
  const std::uint64_t budget = session.options.budget;
  const double predicted = predict(surface, session);
  recorder.predicted(predicted);
  if (budget == 0 || predicted <= static_cast<double>(budget)) {
    session.control.predict(predicted);
    return false;
  }
  if (tau_ > kLargestTau) {
    throw Stopped{{StatusCode::limit_reached, over_budget(predicted, tau_, budget), Limit::size}};
  }
  tau_ = std::max(2 * tau_, kLeastTau);
  return true;
}

}  // namespace delmesher::policies
