#include "mesher/results/plane_recorder.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/sort_unique.h"
#include "mesher/plane/record.h"
#include "mesher/plane/statistics.h"

namespace delmesher::plane {
namespace {

// The segments that pieces are spared of, once per piece.
std::vector<std::uint32_t> dropped_segments(const InputGraph& graph, const Spared& spared) {
  std::vector<std::uint32_t> dropped;
  for (PieceId p = kBoxPieces; p < graph.pieces.size(); ++p) {
    if (spared.piece[p] != 0) dropped.push_back(graph.pieces[p].segment);
  }
  return dropped;
}

}  // namespace

void Recorder::checked(const InputGraph& graph) {
  result_.warnings = graph.warnings;
  result_.statistics.bbox_diagonal = graph.diagonal;
}

void Recorder::chamfered(const Chamfered& chamfered) {
  result_.statistics.filter_rounds += chamfered.rounds;
}

void Recorder::refined(const InputGraph& graph, const Chamfered& chamfered, const Spared& spared,
                       const RefinedMesh& refined) {
  const PlaneOptions& options = session_.options;
  std::vector<std::uint32_t> dropped = dropped_segments(graph, spared);
  PlaneStatistics& s = result_.statistics;
  s.guaranteed_delta = refined.delta;
  s.dropped_segments = dropped.size();
  s.acute_vertices = chamfered.corners.size();
  s.chamfered_segments = chamfered.cut_pieces;
  s.steiner_on_segments = refined.on_segments;
  s.steiner_in_faces = refined.in_faces;
  s.refined = refined_statistics(refined, session_.points, options.region);
  if (options.want_chamfered) {
    result_.chamfered = chamfered_graph(graph, chamfered, session_.points);
  }
  if (exact()) record_refined(graph, chamfered, std::move(dropped), refined);
}

void Recorder::record_refined(const InputGraph& graph, const Chamfered& chamfered,
                              std::vector<std::uint32_t> dropped, const RefinedMesh& refined) {
  PlaneRecord& record = result_.exact;
  sort_unique(dropped);
  record.dropped = std::move(dropped);
  record.delta = refined.delta;
  record.acute = session_.options.acute;
  record.corners = chamfered.corners;
  for (PlaneRecord::Corner& corner : record.corners) {
    corner.vertex = graph.number_of(corner.vertex);
    corner.distance = std::ldexp(corner.distance, graph.scale);
  }
  record_triangles(graph, refined.mesh, refined.side, record.refined, record.refined_edges);
}

void Recorder::enriched(const InputGraph& graph, const RefinedMesh& mesh) {
  if (!exact()) return;
  record_triangles(graph, mesh.mesh, mesh.side, result_.exact.final, result_.exact.final_edges);
}

void Recorder::written(const InputGraph& graph, RoundedPlane rounded) {
  PlaneStatistics& s = result_.statistics;
  s.rounding_inverted = rounded.inverted;
  s.rounding_flat = rounded.flat;
  s.rounding_repaired = rounded.repaired;
  s.max_segment_deviation = rounded.max_deviation;
  s.final = plane_statistics(rounded.mesh.vertices, rounded.mesh.triangles);
  s.final.edges = rounded.mesh.edges.size();
  s.final.interior_triangles = static_cast<std::uint64_t>(
      std::count(rounded.mesh.inside.begin(), rounded.mesh.inside.end(), 1));
  if (exact()) {
    record_points(graph, session_.points, result_.exact);
    result_.exact.mesh_vertices.clear();
    for (const VertexId v : rounded.vertices) {
      result_.exact.mesh_vertices.push_back(graph.number_of(v));
    }
  }
  result_.mesh = std::move(rounded.mesh);
}

void Recorder::finish() {
  PlaneStatistics& s = result_.statistics;
  if (result_.status.ok() && s.guaranteed_delta < session_.options.delta) {
    result_.warnings.push_back(
        "the angle bound asked for was not reached within the limit of points; 20.7 degrees are "
        "kept");
  }
  if (result_.status.ok() && s.dropped_segments > 0) {
    const bool one = s.dropped_segments == 1;
    result_.warnings.push_back(std::to_string(s.dropped_segments) +
                               (one ? " segment lies" : " segments lie") +
                               " in too narrow a gap (see --tau): left to the last step, without "
                               "a bound on the angles there");
  }
  s.phase_seconds = session_.control.phase_seconds();
  s.predicate_filter = session_.predicates.counters.filter;
  s.predicate_exact = session_.predicates.counters.exact;
  s.predicate_symbolic = session_.predicates.counters.symbolic;
  if (!result_.status.ok()) result_.mesh = {};
}

}  // namespace delmesher::plane
