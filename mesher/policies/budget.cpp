#include "mesher/policies/budget.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "mesher/refine/prediction.h"

namespace delmesher::policies {
namespace {

refine::PredictionOptions prediction_options(const Session& session) {
  return {.region = session.options.region,
          .max_edge = session.options.max_edge,
          .sizes = &session.sizes};
}

// With the surface kept: on the 459 valid models of the collection 1.7 per triangle at the median;
// and as many as edges are to be short.
double kept_tetrahedra(const Session& session) {
  constexpr double kPerTriangle = 1.7;
  const SurfaceTopology& topology = session.surface.topology();
  double tetrahedra = kPerTriangle * static_cast<double>(topology.triangles.size());
  if (session.bounds_edges()) {
    const std::vector<std::uint8_t> none(topology.facet_triangles.size(), 0);
    tetrahedra += refine::predict_tetrahedra({}, topology, none, session.points,
                                             prediction_options(session), session.control);
  }
  return tetrahedra;
}

double predicted_tetrahedra(const chamfer::ChamferedSurface& surface, double enough,
                            const Session& session) {
  refine::PredictionOptions options = prediction_options(session);
  if (enough > 0) options.enough = enough;
  // Every triangle that the filter drops comes back in the final step, with at least one and a half
  // tetrahedra.
  return 1.5 * static_cast<double>(surface.filter.dropped_triangles) +
         refine::predict_tetrahedra(surface.chamfer.plc, session.surface.topology(),
                                    surface.filter.facet_kept, session.points, options,
                                    session.control);
}

std::string over_budget(double tau, double budget) {
  char share[32];
  std::snprintf(share, sizeof share, "%.2g", tau);
  return "more tetrahedra are predicted than the budget of " +
         std::to_string(static_cast<std::uint64_t>(budget)) + ", even if facets closer than " +
         share + " of the diagonal wait for the last step";
}

}  // namespace

void Budget::predict(const chamfer::ChamferedSurface& surface, const Session& session,
                     Recorder& recorder) {
  if (is_automatic_ && budget_ == 0) {
    // Of that predicted, two thirds are left after the improvement, at the median.
    constexpr double kTimes = 4, kLeft = 0.67, kSmall = 300;
    budget_ = kTimes / kLeft * kept_tetrahedra(session) + kSmall;
  }
  predicted_ = predicted_tetrahedra(surface, budget_, session);
  recorder.predicted(predicted_);
}

bool Budget::can_raise_tau() const {
  constexpr double kLargestTau = 0.05;
  return is_automatic_ ? tau_ < tau_asked_ : tau_ <= kLargestTau;
}

void Budget::raise_tau() {
  constexpr double kLeastTau = 1e-5;
  tau_ = is_automatic_ ? tau_asked_ : std::max(2 * tau_, kLeastTau);
}

void Budget::settle(Session& session) const {
  if (!is_kept()) {
    throw Stopped{{StatusCode::limit_reached, over_budget(tau_, budget_), Limit::size}};
  }
  session.control.predict(predicted_);
  if (is_automatic_) {
    // Refined meshes have a vertex for two tetrahedra predicted.
    constexpr double kFarBeyond = 3;
    session.control.allow(session.points.size() +
                          static_cast<std::uint64_t>(kFarBeyond * budget_ / 2));
  }
}

}  // namespace delmesher::policies
