#include "mesher/chamfer/chamfer.h"

#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/chamfer/assemble.h"
#include "mesher/chamfer/bridges.h"
#include "mesher/chamfer/chamfer_surface.h"
#include "mesher/chamfer/simplify.h"

namespace delmesher::chamfer {

namespace {

// Removes the new points that simplification left unused, and renumbers.
void drop_unused_points(Bridges& bridges, const PointStore& points, NewPoints& new_points) {
  std::vector<std::uint8_t> used(points.size());
  for (VertexId v : bridges.edge_end) {
    if (v != kNone) used[v] = 1;
  }
  for (const auto& chain : bridges.chain) {
    for (VertexId v : chain) used[v] = 1;
  }
  const std::vector<VertexId> id = new_points.keep(used);
  for (VertexId& v : bridges.edge_end) {
    if (v != kNone) v = id[v];
  }
  for (auto& chain : bridges.chain) {
    for (VertexId& v : chain) v = id[v];
  }
}

void measure_radii(const KeptSurface& surface, const Cuts& cuts, const Bridges& bridges,
                   const PointStore& points, ChamferResult& result) {
  const SurfaceTopology& topology = surface.topology();
  const double unscale = 1 / surface.scale();
  result.vertex_distance = cuts.distance;
  result.vertex_radius = cuts.distance;
  for (std::uint32_t c = 0; c < bridges.chain.size(); ++c) {
    const VertexId v = surface.corners()[c].vertex;
    for (VertexId p : bridges.chain[c]) {
      result.vertex_radius[v] = std::max(result.vertex_radius[v],
                                         distance(surface.place(points, p), surface.position(v)));
    }
  }
  for (double& d : result.vertex_distance) d *= unscale;
  for (double& r : result.vertex_radius) r *= unscale;
  result.edge_radius.assign(topology.edge_count(), 0);
  for (std::uint32_t e = 0; e < topology.edge_count(); ++e) {
    for (std::uint32_t h : topology.edge_half_edges(e)) {
      result.edge_radius[e] = std::max(result.edge_radius[e], unscale * cuts.height[h]);
    }
  }
}

AcuteCount counted(const Acuteness& acute) {
  AcuteCount count;
  for (std::uint8_t flag : acute.vertex) count.vertices += flag;
  for (std::uint8_t flag : acute.edge) count.edges += flag;
  return count;
}

}  // namespace

ChamferResult chamfer_surface(const KeptSurface& surface, const Acuteness& acute,
                              PointStore& points, Predicates& predicates,
                              const ChamferOptions& options,
                              const std::vector<std::uint8_t>& active, Control& control) {
  const Thresholds thresholds(options);
  const CutOptions cut_options{.max_radius = options.max_radius * surface.scale(),
                               .to_link = options.link_distances,
                               .per_triangle = options.bridge_per_triangle};
  const Cuts cuts = find_cuts(surface, acute, predicates, cut_options, control);
  NewPoints new_points(surface.topology(), points);
  Bridges bridges = build_bridges(surface, acute, cuts, thresholds, new_points, control);
  if (options.simplify_bridges) {
    simplify_bridges(surface, acute, cuts, thresholds, predicates, bridges, control);
  }
  drop_unused_points(bridges, points, new_points);

  ChamferResult result;
  result.first_new_point = new_points.first();
  result.new_point_vertex = new_points.vertices();
  measure_radii(surface, cuts, bridges, points, result);
  assemble_plc(surface, acute, cuts, bridges, active, options.isolated_clearance, result);
  result.vertex_is_acute = acute.vertex;
  result.edge_is_acute = acute.edge;
  result.vertex_is_apex = acute.apex;
  const AcuteCount count = counted(acute);
  result.acute_vertices = count.vertices;
  result.acute_edges = count.edges;
  return result;
}

ChamferResult chamfer(const SurfaceTopology& topology, PointStore& points, Predicates& predicates,
                      const ChamferOptions& options, Control& control) {
  const KeptSurface surface(topology, points, options.facet_kept);
  const Acuteness acute = find_acute(surface, predicates, Thresholds(options), {}, control);
  return chamfer_surface(surface, acute, points, predicates, options, {}, control);
}

AcuteCount count_acute(const SurfaceTopology& topology, const PointStore& points,
                       Predicates& predicates, const ChamferOptions& options, Control& control) {
  const KeptSurface surface(topology, points, options.facet_kept);
  return counted(find_acute(surface, predicates, Thresholds(options), {}, control));
}

}  // namespace delmesher::chamfer
