#include "mesher/policies/budget.h"

#include <algorithm>
#include <string>

#include "mesher/refine/prediction.h"

namespace delmesher::policies {
namespace {

double predicted_tetrahedra(const chamfer::ChamferedSurface& surface, const Session& session) {
  refine::PredictionOptions options;
  options.region = session.options.region;
  options.max_edge = session.options.max_edge;
  options.sizes = &session.sizes;
  // Every triangle that the filter drops comes back in the final step, with at least one and a half
  // tetrahedra.
  return 1.5 * static_cast<double>(surface.filter.dropped_triangles) +
         refine::predict_tetrahedra(surface.chamfer.plc, session.surface.topology(),
                                    surface.filter.facet_kept, session.points, options,
                                    session.control);
}

std::string over_budget(double predicted, double tau, std::uint64_t budget) {
  return "about " + std::to_string(static_cast<std::uint64_t>(predicted)) +
         " tetrahedra are predicted even with tau " + std::to_string(tau) +
         ", more than the budget of " + std::to_string(budget);
}

}  // namespace

void Budget::predict(const chamfer::ChamferedSurface& surface, const Session& session,
                     Recorder& recorder) {
  predicted_ = predicted_tetrahedra(surface, session);
  recorder.predicted(predicted_);
}

bool Budget::can_double_tau() const {
  constexpr double kLargestTau = 0.05;
  return tau_ <= kLargestTau;
}

void Budget::double_tau() {
  constexpr double kLeastTau = 1e-5;
  tau_ = std::max(2 * tau_, kLeastTau);
}

void Budget::settle(Session& session) const {
  if (!is_kept()) {
    throw Stopped{{StatusCode::limit_reached, over_budget(predicted_, tau_, budget_), Limit::size}};
  }
  session.control.predict(predicted_);
}

}  // namespace delmesher::policies
