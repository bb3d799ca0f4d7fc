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

void tighten_corners(const Vec3& place, double otherwise, const SurfaceTopology& topology,
                     const PointStore& points, std::vector<double>& vertex_cosine_squared) {
  if (vertex_cosine_squared.empty()) {
    vertex_cosine_squared.assign(topology.vertex_half_edge.size(), otherwise);
  }
  // The nearest vertex that is not tight yet, and those that share an edge with it: where the
  // refinement runs away, at least one corner between the two thresholds is left.
  VertexId nearest = kNone;
  double smallest = 0;
  for (VertexId v = 0; v < topology.vertex_half_edge.size(); ++v) {
    if (topology.vertex_half_edge[v] == kNone || vertex_cosine_squared[v] == 0) continue;
    const double distance = point_segment_distance(place, points.nearest(v), points.nearest(v));
    if (nearest == kNone || distance < smallest) {
      nearest = v;
      smallest = distance;
    }
  }
  if (nearest == kNone) return;
  vertex_cosine_squared[nearest] = 0;
  for (std::uint32_t e = 0; e < topology.edge_count(); ++e) {
    const auto ends = topology.edge_vertices(e);
    if (ends[0] == nearest) vertex_cosine_squared[ends[1]] = 0;
    if (ends[1] == nearest) vertex_cosine_squared[ends[0]] = 0;
  }
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
  result.simplify_to_angles = options.as_paper.simplification;
  return result;
}

Fallback::Fallback(const Options& options)
    : options_(options), chamfering_(chamfer_options(options)), gabriel_(options.gabriel) {}

InForce Fallback::in_force(double tau) const {
  constexpr double kRight = 90;
  return {tau, everywhere() ? kRight : options_.acute,
          everywhere() ? kRight : corner_threshold(options_), gabriel_,
          &chamfering_.vertex_cosine_squared};
}

double Fallback::runaway_length(const Session& session, double tau) {
  constexpr double kRunawayFraction = 1.0 / 4096;
  if (options_.as_paper.no_guard || (gabriel_ && everywhere())) return 0;
  // The filter leaves tau between features, and chamfering a 16th of it: this is a 256th of that.
  if (tau > 0) return tau * session.diagonal * kRunawayFraction;
  if (feature_length_ < 0) {
    feature_length_ =
        smallest_local_feature_size(session.topology, session.points, session.control);
  }
  return feature_length_ * kRunawayFraction;
}

void Fallback::tighten(const Vec3& place, const Session& session) {
  constexpr int kLocalSteps = 6;  // then everywhere
  if (!gabriel_) {
    gabriel_ = true;
  } else if (steps_ < kLocalSteps) {
    tighten_corners(place, chamfering_.cosine_squared, session.topology, session.points,
                    chamfering_.vertex_cosine_squared);
  } else {
    chamfering_.cosine_squared = chamfering_.corner_cosine_squared = 0;
    chamfering_.vertex_cosine_squared.clear();
  }
  ++steps_;
}

}  // namespace delmesher::policies
