// The order of the stages in the plane (section 3).
#include <algorithm>
#include <cmath>
#include <string>

#include "mesher/base/check.h"
#include "mesher/base/control.h"
#include "mesher/base/guarded.h"
#include "mesher/base/validating.h"
#include "mesher/delmesher.h"
#include "mesher/plane/chamfer.h"
#include "mesher/plane/enrich.h"
#include "mesher/plane/graph.h"
#include "mesher/plane/output.h"
#include "mesher/plane/refine.h"
#include "mesher/predicates/predicates.h"

namespace delmesher {
namespace {

using plane::Side;

// Narrow channels and extreme scales may ask for any number of triangles. Unless told otherwise,
// nobody shall wait for a machine that runs out of memory.
std::uint64_t default_limit(const PlanarGraph& graph) {
  return 10'000'000 + 64 * static_cast<std::uint64_t>(graph.vertices.size());
}

class Run {
 public:
  Run(const PlanarGraph& input, const Options& options, Control& control, PlaneResult& result)
      : input_(input), options_(options), control_(control), result_(result) {}

  Status mesh() {
    if (const std::string defect = options_defect(options_, 34, 60); !defect.empty()) {
      return {StatusCode::invalid_options, defect};
    }
    control_.enter(Phase::check);
    plane::InputGraph graph = plane::build_graph(input_, points_, predicates_, control_);
    result_.warnings = graph.warnings;
    result_.statistics.bbox_diagonal = graph.diagonal;
    if (options_.region == Region::interior &&
        std::count(graph.inside.begin(), graph.inside.end(), 1) == 0) {
      return {StatusCode::invalid_surface, "the segments enclose nothing"};
    }
    const bool box_is_seen = options_.region == Region::hull || options_.want_exact;
    if (box_is_seen && !box_is_finite(graph)) {
      return {StatusCode::invalid_surface,
              "the rectangle around the graph, which is asked for, ends beyond the largest double"};
    }
    plane::Chamfered chamfered;
    plane::RefinedMesh refined = chamfer_and_refine(graph, chamfered);
    if (kValidating) validate(refined.mesh);
    record_refined(graph, chamfered, refined);
    if (options_.approximate) {
      write(graph, plane::select(refined.mesh, refined.side, {}, options_.region));
      return {};
    }
    control_.enter(Phase::enrich);
    plane::enrich(graph, chamfered, refined.mesh, points_, control_);
    if (kValidating) validate(refined.mesh);
    control_.enter(Phase::classify);
    const plane::Faces faces = plane::find_faces(graph, refined.mesh, points_, nullptr);
    refined.side.resize(refined.mesh.size());
    for (std::size_t t = 0; t < refined.side.size(); ++t) {
      refined.side[t] = faces.inside[t] != 0 ? Side::inside : Side::outside;
    }
    if (options_.want_exact) {
      plane::record_triangles(graph, refined.mesh, refined.side, result_.exact.final,
                              result_.exact.final_edges);
    }
    write(graph, plane::select(refined.mesh, refined.side, faces.attributes, options_.region));
    return {};
  }

  void finish() {
    PlaneStatistics& s = result_.statistics;
    s.phase_seconds = control_.phase_seconds();
    s.predicate_filter = predicates_.counters.filter;
    s.predicate_exact = predicates_.counters.exact;
    s.predicate_symbolic = predicates_.counters.symbolic;
  }

 private:
  static void validate(const plane::Triangulation& mesh) {
    const char* const defect = mesh.check(true);
    DELMESHER_CHECK(defect == nullptr, defect);
  }

  // As written: in the units of the store it is.
  bool box_is_finite(const plane::InputGraph& graph) const {
    for (const VertexId v : {graph.vertices, graph.vertices + 2}) {
      const Vec3 p = points_.nearest(v);
      if (!std::isfinite(std::ldexp(p[0], graph.scale)) ||
          !std::isfinite(std::ldexp(p[1], graph.scale))) {
        return false;
      }
    }
    return true;
  }

  // Again without what left no room between doubles; in the end without any segments, which always
  // succeeds. Deterministic: lengths decide, never time.
  plane::RefinedMesh chamfer_and_refine(plane::InputGraph& graph, plane::Chamfered& chamfered) {
    constexpr int kAttempts = 8;
    const double unit = std::ldexp(1.0, -graph.scale);
    plane::ChamferOptions chamfering;
    // Right angles and those of 60 degrees are off by rounding; a billionth less does no harm.
    chamfering.cosine_squared = cosine_squared(options_.acute) * (1 + 1e-9) + 1e-18;
    chamfering.max_radius = options_.chamfer_radius * unit;
    chamfering.tau = options_.tau;
    chamfering.everywhere = options_.region == Region::hull;
    plane::RefineOptions refining;
    refining.delta = options_.delta;
    refining.max_edge = options_.max_edge * unit;
    refining.everywhere = options_.region == Region::hull;
    if (options_.tau > 0) {
      // A channel as narrow as tau allows takes about 4 / tau; neighbours may add to that.
      refining.most_splits = 16 * (static_cast<std::uint64_t>(1 / options_.tau) + graph.vertices);
    }
    const std::size_t input_points = points_.size();
    plane::Spared spared;
    for (int attempt = 1;; ++attempt) {
      control_.enter(Phase::chamfer);
      chamfered = plane::chamfer(graph, points_, predicates_, chamfering, spared, control_);
      result_.statistics.filter_rounds += chamfered.rounds;
      plane::RefinedMesh refined =
          plane::refine(graph, chamfered, points_, predicates_, refining, control_);
      if (!refined.crowded) {
        result_.statistics.guaranteed_delta = refined.delta;
        if (refined.delta < options_.delta) {
          result_.warnings.push_back(
              "the angle bound asked for was not reached within the limit of points; 20.7 degrees "
              "are kept");
        }
        record_spared(graph, spared);
        return refined;
      }
      spare(graph, refined, attempt >= kAttempts, spared);
      while (points_.size() > input_points) points_.pop_back();
    }
  }

  static void spare(const plane::InputGraph& graph, const plane::RefinedMesh& refined, bool all,
                    plane::Spared& spared) {
    const std::size_t before = spared.count;
    const auto drop = [&](std::uint8_t& flag) {
      spared.count += flag == 0;
      flag = 1;
    };
    for (const plane::PieceId p : refined.crowded_pieces) {
      if (p >= plane::kBoxPieces) drop(spared.piece[p]);
    }
    for (const VertexId v : refined.crowded_vertices) drop(spared.vertex[v]);
    for (plane::PieceId p = plane::kBoxPieces; p < graph.pieces.size(); ++p) {
      const plane::Piece& piece = graph.pieces[p];
      if (spared.vertex[piece.a] != 0 || spared.vertex[piece.b] != 0) drop(spared.piece[p]);
    }
    if (!all && spared.count > before) return;
    std::fill(spared.piece.begin(), spared.piece.end(), 1);
    std::fill(spared.piece.begin(), spared.piece.begin() + plane::kBoxPieces, 0);
    std::fill(spared.vertex.begin(), spared.vertex.end(), 1);
  }

  void record_spared(const plane::InputGraph& graph, const plane::Spared& spared) {
    std::vector<std::uint32_t>& dropped = result_.exact.dropped;
    for (plane::PieceId p = plane::kBoxPieces; p < graph.pieces.size(); ++p) {
      if (spared.piece[p] == 0) continue;
      ++result_.statistics.dropped_segments;
      dropped.push_back(graph.pieces[p].segment);
    }
    std::sort(dropped.begin(), dropped.end());
    dropped.erase(std::unique(dropped.begin(), dropped.end()), dropped.end());
  }

  void record_refined(const plane::InputGraph& graph, const plane::Chamfered& chamfered,
                      const plane::RefinedMesh& refined) {
    PlaneStatistics& s = result_.statistics;
    s.acute_vertices = chamfered.corners.size();
    s.chamfered_segments = chamfered.cut_pieces;
    s.steiner_on_segments = refined.on_segments;
    s.steiner_in_faces = refined.in_faces;
    s.refined = plane::refined_statistics(refined, points_, options_.region);
    if (options_.want_chamfered) {
      result_.chamfered = plane::chamfered_graph(graph, chamfered, points_);
    }
    if (!options_.want_exact) {
      result_.exact.dropped.clear();
      return;
    }
    result_.exact.delta = refined.delta;
    result_.exact.acute = options_.acute;
    result_.exact.corners = chamfered.corners;
    for (auto& corner : result_.exact.corners) {
      corner.vertex = graph.number_of(corner.vertex);
      corner.radius = std::ldexp(corner.radius, graph.scale);
    }
    plane::record_triangles(graph, refined.mesh, refined.side, result_.exact.refined,
                            result_.exact.refined_edges);
  }

  void write(const plane::InputGraph& graph, const plane::MeshToWrite& exact) {
    control_.enter(Phase::round);
    plane::RoundedPlane rounded = plane::round_plane(graph, exact, points_, control_);
    control_.poll_now(rounded.mesh.vertices.size(), 1);  // small meshes are hardly asked before
    PlaneStatistics& s = result_.statistics;
    s.rounding_inverted = rounded.inverted;
    s.rounding_flat = rounded.flat;
    s.rounding_repaired = rounded.repaired;
    s.max_segment_deviation = rounded.max_deviation;
    s.final = plane::plane_statistics(rounded.mesh.vertices, rounded.mesh.triangles);
    s.final.edges = rounded.mesh.edges.size();
    s.final.interior_triangles = static_cast<std::uint64_t>(
        std::count(rounded.mesh.inside.begin(), rounded.mesh.inside.end(), 1));
    if (options_.want_exact) {
      plane::record_points(graph, points_, result_.exact);
      result_.exact.mesh_vertices.clear();
      for (const VertexId v : rounded.vertices) {
        result_.exact.mesh_vertices.push_back(graph.number_of(v));
      }
    }
    result_.mesh = std::move(rounded.mesh);
  }

  const PlanarGraph& input_;
  const Options& options_;
  Control& control_;
  PlaneResult& result_;
  PointStore points_;
  plane::PlanePredicates predicates_{points_};
};

}  // namespace

PlaneResult triangulate_polygon(const PlanarGraph& graph, const Options& given) {
  PlaneResult result;
  Options options = given;
  if (options.max_vertices == 0) options.max_vertices = default_limit(graph);
  Control control(options);
  Run run(graph, options, control, result);
  result.status = guarded(control, [&run] { return run.mesh(); });
  run.finish();
  if (!result.status.ok()) result.mesh = {};
  return result;
}

}  // namespace delmesher
