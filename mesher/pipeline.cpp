// The order of the stages. Reads as a table of contents; what passes between them is put together
// in assembly.cpp.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "mesher/assembly.h"
#include "mesher/base/check.h"
#include "mesher/base/control.h"
#include "mesher/cdt/cdt.h"
#include "mesher/chamfer/filter.h"
#include "mesher/delmesher.h"
#include "mesher/guarded.h"
#include "mesher/output/rounding.h"
#include "mesher/output/statistics.h"
#include "mesher/refine/prediction.h"
#include "mesher/refine/refine.h"
#include "mesher/scaling.h"
#include "mesher/surface/feature_size.h"
#include "mesher/surface/topology.h"
#include "mesher/surface/validity.h"
#include "mesher/thinning.h"

namespace delmesher {
namespace {

// The threshold for the angle of two edges. A facet's triangle at a corner that is not chamfered
// has its angle, so that has to exceed delta.
double corner_threshold(const Options& o) {
  constexpr double kMargin = 5;
  return std::min(o.acute, std::max(o.corner, o.delta + kMargin));
}

// One run on one surface: the store, the predicates and the topology that all stages share.
class Run {
 public:
  Run(const Options& options, Control& control, Result& result)
      : options_(options), control_(control), result_(result) {}

  Status mesh(const Surface& surface) {
    if (Status status = prepare(surface); !status.ok()) return status;
    std::unique_ptr<Tetrahedrization> delaunay;
    std::optional<CdtInput> input = refined_input(delaunay);
    if (!input) return {};
    CdtResult cdt = constrained_delaunay_tetrahedrization(*input, points_, predicates_, control_,
                                                          std::move(delaunay));
    input.reset();
    if (std::optional<CdtResult> plain = plain_if_better(cdt)) cdt = std::move(*plain);
    record_cdt(cdt);
    round_and_write(std::move(cdt));
    return {};
  }

  Status cdt(const Surface& surface) {
    if (Status status = prepare(surface); !status.ok()) return status;
    CdtInput input = plain_input(topology_);
    input.phase_by_phase = true;
    CdtResult cdt = constrained_delaunay_tetrahedrization(input, points_, predicates_, control_);
    record_cdt(cdt);
    round_and_write(std::move(cdt));
    return {};
  }

  void finish() {
    const PredicateCounters& c = predicates_.counters;
    Statistics& s = result_.statistics;
    s.phase_seconds = control_.phase_seconds();
    s.predicate_filter = c.filter;
    s.predicate_extended = c.extended;
    s.predicate_exact = c.exact;
    s.predicate_symbolic = c.symbolic;
    s.predicate_by_support = c.support;
  }

 private:
  Status prepare(const Surface& surface) {
    if (const std::string defect = options_defect(options_, 30, 0); !defect.empty()) {
      return {StatusCode::invalid_options, defect};
    }
    control_.enter(Phase::check);
    const ValidityResult validity = check_validity(surface, true, control_);
    if (!validity.report.status.ok()) return validity.report.status;
    result_.warnings = validity.report.warnings;
    result_.statistics.bbox_diagonal = validity.report.bbox_diagonal;
    topology_ = build_topology(oriented_outwards(surface, validity), points_, predicates_);
    return {};
  }

  // What the last step restores the surface in; none if the refined mesh was to be written itself.
  // The refined mesh goes before the last step needs the memory.
  std::optional<CdtInput> refined_input(std::unique_ptr<Tetrahedrization>& delaunay) {
    ChamferResult chamfered;
    RefineResult refined = chamfer_and_refine(chamfered);
    if (options_.approximate) {
      refined.delaunay.reset();
      control_.enter(Phase::round);
      MeshToWrite exact = approximate_mesh(chamfered, refined, topology_, points_, options_.region);
      RoundingResult rounded = round_mesh(std::move(exact.rounding), control_);
      write(exact, std::move(rounded));
      return {};
    }
    control_.enter(Phase::enrich);
    delaunay = std::move(refined.delaunay);
    return enriched_input(chamfered, filter_.facet_kept, refined, topology_, points_, predicates_,
                          control_);
  }

  void forget_points(std::size_t first) {
    while (points_.size() > first) points_.pop_back();
  }

  // A solid that meets the bound without any further point needs none: its plain constrained
  // tetrahedrization, where that is the better one in every respect. (TetGen leaves such inputs as
  // they are, too; large ones are never among them.)
  std::optional<CdtResult> plain_if_better(const CdtResult& enriched) {
    constexpr std::size_t kMostTriangles = 1000;
    if (options_.region != Region::interior || options_.max_edge > 0 ||
        topology_.triangles.size() > kMostTriangles) {
      return std::nullopt;
    }
    const std::size_t enriched_points = points_.size();
    CdtResult plain = constrained_delaunay_tetrahedrization(plain_input(topology_), points_,
                                                            predicates_, control_);
    forget_points(enriched_points);
    if (!plain.steiner.empty()) return std::nullopt;
    const MeshStatistics p = interior_statistics(plain, points_, control_);
    if (p.min_face_angle < options_.delta) return std::nullopt;
    const MeshStatistics e = interior_statistics(enriched, points_, control_);
    const bool better = p.min_face_angle >= e.min_face_angle && p.min_dihedral >= e.min_dihedral &&
                        p.tetrahedra <= e.tetrahedra;
    result_.statistics.enriched = !better;
    return better ? std::optional(std::move(plain)) : std::nullopt;
  }

  // Chamfering and refinement, again with empty diametral balls and then with stricter corners
  // where the refinement would not end (section 4 proves that it ends with both, at 90 degrees).
  // Deterministic: the guard looks at lengths, never at time.
  RefineResult chamfer_and_refine(ChamferResult& chamfered) {
    constexpr int kLocalFallbacks = 6;  // then everywhere
    ChamferOptions options;
    options.cosine_squared = cosine_squared(options_.acute);
    options.corner_cosine_squared = cosine_squared(corner_threshold(options_));
    gabriel_ = options_.gabriel;
    options.max_radius = options_.chamfer_radius;
    options.simplify_bridges = options_.simplify_bridges;
    const std::size_t input_points = points_.size();
    for (int fallbacks = 0;; ++fallbacks) {
      const bool strictest =
          gabriel_ && options.cosine_squared == 0 && options.corner_cosine_squared == 0;
      chamfered = fallbacks == 0 ? fit_budget(options) : filter_and_chamfer_input(options);
      RefineResult refined = refine_complex(chamfered, !strictest);
      if (!refined.runaway) {
        record_corners(chamfered, options);
        record_refinement(chamfered, refined);
        return refined;
      }
      if (!gabriel_) {
        gabriel_ = true;
      } else if (fallbacks < kLocalFallbacks) {
        tighten_corners(*refined.runaway, options.cosine_squared, topology_, points_,
                        options.vertex_cosine_squared);
      } else {
        options.cosine_squared = options.corner_cosine_squared = 0;
        options.vertex_cosine_squared.clear();
      }
      forget_points(input_points);
    }
  }

  // Chamfers and filters with the smallest of tau, 2 tau, 4 tau ... that the budget allows.
  ChamferResult fit_budget(const ChamferOptions& chamfering) {
    // Beyond this, whole features of the model go.
    constexpr double kLargestTau = 0.05, kLeastTau = 1e-5;
    const std::size_t input_points = points_.size();
    for (;;) {
      ChamferResult chamfered = filter_and_chamfer_input(chamfering);
      const double predicted = predict(chamfered);
      result_.statistics.predicted_tetrahedra = predicted;
      if (options_.budget == 0 || predicted <= static_cast<double>(options_.budget)) {
        control_.predict(predicted);
        return chamfered;
      }
      if (tau_ > kLargestTau) {
        throw Stopped{{StatusCode::limit_reached, over_budget(predicted), Limit::size}};
      }
      tau_ = std::max(2 * tau_, kLeastTau);
      forget_points(input_points);
    }
  }

  double predict(const ChamferResult& chamfered) {
    PredictionOptions options;
    options.region = options_.region;
    options.max_edge = options_.max_edge;
    // What the filter drops comes back in the final step, as at least a tetrahedron and a half
    // each.
    return 1.5 * static_cast<double>(filter_.dropped_triangles) +
           predict_tetrahedra(chamfered.plc, topology_, filter_.facet_kept, points_, options,
                              control_);
  }

  std::string over_budget(double predicted) const {
    return "about " + std::to_string(static_cast<std::uint64_t>(predicted)) +
           " tetrahedra are predicted even with tau " + std::to_string(tau_) +
           ", more than the budget of " + std::to_string(options_.budget);
  }

  // The smallest distance that chamfering and filtering leave between features, roughly.
  double feature_length() {
    if (tau_ > 0) return tau_ * result_.statistics.bbox_diagonal;
    if (feature_length_ < 0) {
      feature_length_ = smallest_local_feature_size(topology_, points_, control_);
    }
    return feature_length_;
  }

  ChamferResult filter_and_chamfer_input(const ChamferOptions& options) {
    const double tolerance = tau_ * result_.statistics.bbox_diagonal;
    return filter_and_chamfer(topology_, points_, predicates_, options, tolerance, control_,
                              filter_);
  }

  RefineResult refine_complex(ChamferResult& chamfered, bool guarded) {
    constexpr double kRunawayFraction = 1.0 / 4096;
    add_outer_box(topology_, points_, chamfered.plc);
    RefineOptions options;
    options.delta = options_.delta;
    options.slivers = options_.slivers;
    options.max_edge = options_.max_edge;
    options.region = options_.region;
    options.runaway_length = guarded ? feature_length() * kRunawayFraction : 0;
    options.want_balls = options_.want_exact;
    options.gabriel = gabriel_;
    options.apex = chamfered.vertex_is_apex;
    options.removed = removed_boxes(chamfered, filter_.facet_kept, topology_, points_);
    return refine(chamfered.plc, topology_, points_, predicates_, options, control_);
  }

  void record_corners(const ChamferResult& chamfered, const ChamferOptions& options) {
    Statistics& s = result_.statistics;
    s.tau = tau_;
    s.dropped_triangles = filter_.dropped_triangles;
    s.filter_rounds = filter_.rounds;
    s.acute_vertices = chamfered.acute_vertices;
    s.acute_edges = chamfered.acute_edges;
    const bool everywhere = options.cosine_squared == 0 && options.corner_cosine_squared == 0;
    s.guaranteed_acute = everywhere ? 90 : options_.acute;
    s.guaranteed_corner = everywhere ? 90 : corner_threshold(options_);
    s.gabriel = gabriel_;
    const auto& tightened = options.vertex_cosine_squared;
    s.fallback_corners =
        static_cast<std::uint64_t>(std::count(tightened.begin(), tightened.end(), 0.0));
    if (!options_.want_exact) return;
    record_parameters(options_, tau_ * result_.statistics.bbox_diagonal, result_.exact);
    record_facets(topology_, &filter_, result_.exact);
    record_chamfer(chamfered, s.guaranteed_acute, tightened, result_.exact);
    result_.exact.parameters.acute = s.guaranteed_acute;
    result_.exact.parameters.corner = s.guaranteed_corner;
    result_.exact.parameters.gabriel = s.gabriel;
  }

  void record_refinement(const ChamferResult& chamfered, const RefineResult& refined) {
    Statistics& s = result_.statistics;
    s.steiner_on_segments = refined.on_segments;
    s.steiner_on_facets = refined.on_facets;
    s.steiner_in_volume = refined.in_volume.size();
    s.refined = refined_statistics(refined, points_, options_.region, control_);
    if (options_.want_exact) record_refined(chamfered, refined, topology_, result_.exact);
    if (options_.want_chamfered) {
      result_.chamfered = chamfered_surface(chamfered, refined, topology_, points_);
    }
  }

  void record_cdt(const CdtResult& cdt) {
    result_.statistics.steiner_on_segments += cdt.steiner.size();
    if (!options_.want_exact) return;
    if (result_.exact.facets.empty()) record_facets(topology_, nullptr, result_.exact);
    record_final(cdt, topology_, result_.exact);
  }

  // Where doubles are too coarse for the points of the last step, it does with fewer of them.
  void round_and_write(CdtResult cdt) {
    constexpr int kMostRings = 3;
    control_.enter(Phase::round);
    MeshToWrite exact = conforming_mesh(cdt, topology_, points_, options_.region);
    RoundingResult rounded = round_mesh(std::move(exact.rounding), control_);
    std::uint64_t thinned = 0;
    for (int rings = 0; rings <= kMostRings && defects(rounded) != kNoDefects; ++rings) {
      const std::size_t gone = thin_out(rounded.disturbed, rings, topology_.vertex_half_edge.size(),
                                        points_, predicates_, control_, cdt);
      thinned += gone;
      if (gone == 0) continue;
      MeshToWrite thinner = conforming_mesh(cdt, topology_, points_, options_.region);
      RoundingResult other = round_mesh(std::move(thinner.rounding), control_, rings == kMostRings);
      if (!(defects(other) < defects(rounded))) continue;
      rounded = std::move(other);
      exact = std::move(thinner);
      result_.statistics.rounding_thinned = thinned;
      if (options_.want_exact) record_thinned(cdt, topology_, result_.exact);
    }
    write(exact, std::move(rounded));
  }

  // Fills in mesh and statistics.
  void write(MeshToWrite& exact, RoundingResult rounded) {
    Statistics& s = result_.statistics;
    s.rounding_inverted = rounded.inverted;
    s.rounding_flat = rounded.flat;
    s.rounding_repaired = rounded.repaired;
    s.max_surface_deviation = rounded.max_surface_deviation;
    std::uint64_t interior = 0;
    for (const std::uint8_t inside : rounded.inside) interior += inside;
    if (rounded.operations > 0) exact.repeated_faces.clear();  // they are other tetrahedra now
    s.final = mesh_statistics(rounded.coordinates, rounded.tetrahedra, exact.repeated_faces,
                              rounded.vertices.size(), interior, control_);
    if (options_.want_exact) {
      // Repairs by local operations have changed tetrahedra: the record holds what is written.
      if (rounded.operations > 0) record_repaired(rounded, options_.region, result_.exact);
      record_points(points_, topology_.vertex_half_edge.size(), rounded, result_.exact);
    }
    TetMesh& mesh = result_.mesh;
    mesh.vertices = std::move(rounded.coordinates);
    mesh.tetrahedra = std::move(rounded.tetrahedra);
    mesh.inside = std::move(rounded.inside);
    mesh.boundary = std::move(rounded.boundary);
    for (const FacetId f : exact.boundary_facet) {
      mesh.boundary_facets.push_back(topology_.facet_triangles[f][0]);
      mesh.boundary_labels.push_back(topology_.labels[topology_.facet_triangles[f][0]]);
    }
  }

  const Options& options_;
  Control& control_;
  Result& result_;
  PointStore points_;
  Predicates predicates_{points_};
  SurfaceTopology topology_;
  FilterResult filter_;
  double feature_length_ = -1;
  double tau_ = options_.tau;  // in force
  bool gabriel_ = false;       // in force: options_.gabriel, or a fallback
};

template <class Body>
Result run(const Options& options, Body&& body) {
  Result result;
  Control control(options);
  Run stages(options, control, result);
  result.status = guarded(control, [&] { return body(stages); });
  stages.finish();
  if (!result.status.ok()) result.mesh = {};
  return result;
}

}  // namespace

Result tetrahedralize(const Surface& surface, const Options& options) {
  return in_ordinary_units(surface, options, [](const Surface& s, const Options& o) {
    return run(o, [&](Run& stages) { return stages.mesh(s); });
  });
}

Result constrained_delaunay(const Surface& surface, const Options& options) {
  return in_ordinary_units(surface, options, [](const Surface& s, const Options& o) {
    return run(o, [&](Run& stages) { return stages.cdt(s); });
  });
}

SurfaceReport check_surface(const Surface& surface, const Options& options) {
  SurfaceReport report;
  Control control(options);
  const Status status = guarded(control, [&]() -> Status {
    control.enter(Phase::check);
    ValidityResult validity = check_validity(surface, false, control);
    report = std::move(validity.report);
    if (!report.status.ok()) return report.status;
    PointStore points;
    Predicates predicates(points);
    const SurfaceTopology topology =
        build_topology(oriented_outwards(surface, validity), points, predicates);
    report.facets = topology.facet_triangles.size();
    report.smallest_local_feature_size = smallest_local_feature_size(topology, points, control);
    ChamferOptions chamfering;
    chamfering.cosine_squared = cosine_squared(options.acute);
    chamfering.corner_cosine_squared = cosine_squared(corner_threshold(options));
    const AcuteCount acute = count_acute(topology, points, predicates, chamfering, control);
    report.acute_vertices = acute.vertices;
    report.acute_edges = acute.edges;
    return {};
  });
  report.status = status;
  return report;
}

}  // namespace delmesher
