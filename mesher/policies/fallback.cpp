#include "mesher/policies/fallback.h"

#include <algorithm>

#include "mesher/surface/feature_size.h"

namespace delmesher::policies {
namespace {

// The threshold for the angle of two edges. A facet's triangle at a corner that is not chamfered
// has its angle, so that has to exceed delta.
double corner_threshold(const Options& o) {
  constexpr double kMargin = 5;
  return std::min(o.acute, std::max(o.corner, o.delta + kMargin));
}

}  // namespace

chamfer::ChamferOptions chamfer_options(const Options& options) {
  chamfer::ChamferOptions result;
  result.cosine_squared = cosine_squared(options.acute);
  result.corner_cosine_squared = cosine_squared(corner_threshold(options));
  result.max_radius = options.chamfer_radius;
  result.simplify_bridges = options.simplify_bridges;
  result.bridge_per_triangle = options.as_paper.bridges;
  result.link_distances = options.as_paper.link || options.as_paper.bridges;
  return result;
}

Fallback::Fallback(const Options& options)
    : options_(options), chamfering_(chamfer_options(options)), gabriel_(options.gabriel) {}

InForce Fallback::in_force(double tau) const {
  constexpr double kRight = 90;
  return {tau, is_tight() ? kRight : options_.acute,
          is_tight() ? kRight : corner_threshold(options_), gabriel_};
}

double Fallback::runaway_length(const Session& session, double tau) const {
  constexpr double kRunawayFraction = 1.0 / 4096;
  if (options_.as_paper.no_guard || (gabriel_ && is_tight())) return 0;
  // The filter leaves tau between features, and chamfering a 16th of it: this is a 256th of that.
  const double features = tau > 0 ? tau * session.diagonal
                                  : smallest_local_feature_size(session.surface.topology(),
                                                                session.points, session.control);
  return features * kRunawayFraction;
}

void Fallback::tighten() {
  gabriel_ = true;
  chamfering_.cosine_squared = chamfering_.corner_cosine_squared = 0;
}

}  // namespace delmesher::policies
