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

// Tightens the nearest vertex that is not tight yet, and all that are at most so many edges away
// from it: where the refinement runs away, at least one corner between the two thresholds is left.
void tighten_corners(const Vec3& place, int edges_away, double otherwise,
                     const SurfaceTopology& topology, const PointStore& points,
                     std::vector<double>& vertex_cosine_squared) {
  if (vertex_cosine_squared.empty()) {
    vertex_cosine_squared.assign(topology.vertex_half_edge.size(), otherwise);
  }
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
  std::vector<std::uint8_t> here(vertex_cosine_squared.size());
  here[nearest] = 1;
  for (int step = 0; step < edges_away; ++step) {
    const std::vector<std::uint8_t> before = here;
    for (std::uint32_t e = 0; e < topology.edge_count(); ++e) {
      const auto [v, w] = topology.edge_vertices(e);
      if (before[v] != 0 || before[w] != 0) here[v] = here[w] = 1;
    }
  }
  for (VertexId v = 0; v < here.size(); ++v) {
    if (here[v] != 0) vertex_cosine_squared[v] = 0;
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
  return result;
}

Fallback::Fallback(const Options& options)
    : options_(options), chamfering_(chamfer_options(options)), gabriel_(options.gabriel) {}

InForce Fallback::in_force(double tau) const {
  constexpr double kRight = 90;
  return {tau, is_tight_everywhere() ? kRight : options_.acute,
          is_tight_everywhere() ? kRight : corner_threshold(options_), gabriel_,
          &chamfering_.vertex_cosine_squared};
}

double Fallback::runaway_length(const Session& session, double tau) {
  constexpr double kRunawayFraction = 1.0 / 4096;
  if (options_.as_paper.no_guard || (gabriel_ && is_tight_everywhere())) return 0;
  // The filter leaves tau between features, and chamfering a 16th of it: this is a 256th of that.
  if (tau > 0) return tau * session.diagonal * kRunawayFraction;
  if (feature_length_ < 0) {
    feature_length_ =
        smallest_local_feature_size(session.surface.topology(), session.points, session.control);
  }
  return feature_length_ * kRunawayFraction;
}

void Fallback::tighten_nearby(const Vec3& place, const Session& session) {
  tighten_corners(place, 1 + times_nearby_ / kSameReach, chamfering_.cosine_squared,
                  session.surface.topology(), session.points, chamfering_.vertex_cosine_squared);
  ++times_nearby_;
}

void Fallback::tighten_everywhere() {
  chamfering_.cosine_squared = chamfering_.corner_cosine_squared = 0;
  chamfering_.vertex_cosine_squared.clear();
}

}  // namespace delmesher::policies
