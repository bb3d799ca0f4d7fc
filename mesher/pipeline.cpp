// The order of the stages: Algorithm 2 of the paper, and the policies that repeat parts of it.
#include <memory>
#include <optional>
#include <string>

#include "mesher/base/control.h"
#include "mesher/base/guarded.h"
#include "mesher/cdt/cdt.h"
#include "mesher/chamfer/filter.h"
#include "mesher/chamfer/removed_surface.h"
#include "mesher/delmesher.h"
#include "mesher/delmesher/option_table.h"
#include "mesher/enrich/enrichment.h"
#include "mesher/improve/diagonals.h"
#include "mesher/improve/improve.h"
#include "mesher/policies/as_given.h"
#include "mesher/policies/budget.h"
#include "mesher/policies/fallback.h"
#include "mesher/policies/finer_planes.h"
#include "mesher/policies/plain.h"
#include "mesher/policies/planes.h"
#include "mesher/policies/thinned_rounding.h"
#include "mesher/refine/refine.h"
#include "mesher/results/recorder.h"
#include "mesher/results/rounding_input.h"
#include "mesher/results/units.h"
#include "mesher/run/options.h"
#include "mesher/run/session.h"
#include "mesher/surface/validity.h"

namespace delmesher {
namespace {

// Policies see the results, the session and the shared folders, so these names need no prefix.
// Names of stages keep theirs.
using namespace policies;  // NOLINT(google-build-using-namespace)

Phase phase_of(refine::RefineStep step) {
  static constexpr Phase kPhase[] = {Phase::delaunay, Phase::segments, Phase::facets,
                                     Phase::refine};
  return kPhase[static_cast<std::size_t>(step)];
}

Phase phase_of(cdt::CdtStep step) {
  static constexpr Phase kPhase[] = {Phase::delaunay, Phase::segments, Phase::facets,
                                     Phase::classify};
  return kPhase[static_cast<std::size_t>(step)];
}

// The surface as all stages see it: valid, oriented outwards and, if it is to be refined, with
// near-coplanar triangles in exactly one plane.
Status prepare(const Surface& surface, Planes planes, Session& s, Recorder& recorder) {
  s.control.enter(Phase::check);
  const ValidityResult validity = check_validity(surface, true, s.control);
  if (!validity.report.status.ok()) return validity.report.status;
  recorder.checked(validity.report);
  s.diagonal = validity.report.bbox_diagonal;
  const PlanarSurface planar = enter_surface(surface, validity, planes, s);
  recorder.planar(planar.stand_in, planar.bound, validity);
  return {};
}

// Sections 4 and 7, in turn until neither leaves anything to the other.
chamfer::ChamferedSurface filter_and_chamfer(double tau, const chamfer::ChamferOptions& options,
                                             Session& s) {
  chamfer::FilterOptions filter{.tolerance = tau * s.diagonal,
                                .all_pairs = s.options.as_paper.filter_pairs,
                                .both_sides = s.options.as_paper.filter_chamfered};
  if (filter.both_sides) filter.chamfered_fraction = 1;
  chamfer::FilteredSurface surface(s.topology, s.points, s.predicates, options, filter, s.control);
  s.control.enter(Phase::filter);
  surface.drop_close();
  do {
    s.control.enter(Phase::chamfer);
    surface.chamfer();
    s.control.enter(Phase::filter);
  } while (surface.drop_small());
  s.control.enter(Phase::chamfer);
  return surface.result();
}

// With so large a tolerance of the filter that the mesh is predicted to keep to the budget.
chamfer::ChamferedSurface filter_to_budget(Budget& budget, const Fallback& fallback, Session& s,
                                           Recorder& recorder) {
  chamfer::ChamferedSurface chamfered = filter_and_chamfer(budget.tau(), fallback.chamfering(), s);
  while (budget.raise_tau_over_budget(chamfered, s, recorder)) {
    s.points.truncate(s.input_vertices());
    chamfered = filter_and_chamfer(budget.tau(), fallback.chamfering(), s);
  }
  return chamfered;
}

refine::RefineResult refine_mesh(chamfer::ChamferedSurface& chamfered, double tau,
                                 Fallback& fallback, Session& s) {
  refine::add_outer_box(s.topology, s.points, chamfered.chamfer.plc, s.frame);
  refine::RefineOptions options;
  options.delta = s.options.delta;
  options.slivers = s.options.slivers;
  options.max_edge = s.options.max_edge;
  options.sizes = &s.sizes;
  options.largest_ratio_first = s.options.as_paper.order;
  options.circumcentres = s.options.as_paper.steiner_point;
  options.region = s.options.region;
  options.runaway_length = fallback.runaway_length(s, tau);
  options.want_balls = s.options.want_exact;
  options.gabriel = fallback.gabriel();
  options.apex = chamfered.chamfer.vertex_is_apex;
  options.on_step = [&s](refine::RefineStep step) { s.control.enter(phase_of(step)); };
  options.removed =
      chamfer::removed_boxes(chamfered.chamfer, chamfered.filter.facet_kept, s.topology, s.points);
  return refine::refine(chamfered.chamfer.plc, s.topology, s.points, s.predicates, options,
                        s.control);
}

// Gives up the refined mesh, because the last step needs its memory.
cdt::CdtResult enriched_cdt(const chamfer::ChamferedSurface& chamfered,
                            refine::RefineResult refined, Session& s) {
  s.control.enter(Phase::enrich);
  std::unique_ptr<Tetrahedrization> delaunay = std::move(refined.delaunay);
  cdt::CdtInput input =
      enrich::enriched_input(chamfered.chamfer, chamfered.filter.facet_kept, refined, s.topology,
                             s.points, s.predicates, s.options.as_paper.kept_points, s.control);
  refined = {};
  input.on_step = [&s](cdt::CdtStep step) {
    s.control.enter(step == cdt::CdtStep::classify ? Phase::classify : Phase::enrich);
  };
  return cdt::constrained_delaunay_tetrahedrization(input, s.points, s.predicates, s.control,
                                                    std::move(delaunay));
}

improve::ImproveOptions improve_options(Region region, const Session& s) {
  return {.delta = s.options.delta,
          .max_edge = s.options.max_edge,
          .sizes = &s.sizes,
          .region = region,
          .as_given = goes_back(s.options)};
}

// Fewer and better tetrahedra on the same surface (section 8.3).
improve::ImproveResult improve_final(ConformingMesh& mesh, Session& s,
                                     const improve::Sparing& sparing = {}) {
  improve::ImproveOptions options = improve_options(s.options.region, s);
  options.sparing = sparing;
  improve::ImproveResult result = improve::improve(std::move(mesh), &s.topology, s.given, options,
                                                   s.points, s.predicates, s.control);
  mesh = std::move(result.mesh);
  return result;
}

// What has come back may take a tenth more tetrahedra than the mesh of the stand-in had; beyond
// that, points on the edges that came back are spared.
void improve_as_given(std::size_t before, const std::vector<std::uint8_t>& is_flat,
                      ConformingMesh& mesh, Session& s, Recorder& recorder) {
  std::vector<std::uint8_t> returned = is_flat;  // on the stand-in
  for (std::size_t e = 0; e < returned.size(); ++e) {
    if (s.topology.edge_is_flat[e] != 0) returned[e] = 0;
  }
  recorder.spared(improve_final(mesh, s, {returned, before + before / 10}).spared);
}

// From the stand-in to the surface as given, with all its edges: by local operations, or, where
// these do not get there, by another tetrahedrization with the same vertices. False if that cannot
// be; the mesh is not to be used then.
bool put_back(ConformingMesh& mesh, Session& s, Recorder& recorder) {
  const ConformingMesh before = mesh;
  const std::size_t points = s.points.size();
  SurfaceTopology as_given = topology_as_given(s);
  improve::DiagonalsResult entered =
      improve::enter_diagonals(std::move(mesh), s.topology, as_given, s.given,
                               improve_options(Region::hull, s), s.points, s.predicates, s.control);
  mesh = std::move(entered.mesh);
  recorder.put_back(entered.diagonals, entered.missing);
  if (entered.missing == 0 && go_back(mesh, std::move(as_given), s)) return true;
  if (s.bounds_edges()) {  // another tetrahedrization may have longer edges
    recorder.given_up();
    return false;
  }
  s.points.truncate(points);
  mesh = tetrahedrize_as_given(before, s).mesh;
  if (s.options.region == Region::interior) keep_inside(mesh);
  recorder.tetrahedrized_anew();
  return true;
}

// Improves the final mesh; a mesh of the stand-in that goes back is improved before and after.
// False if it cannot go back.
bool improve_and_go_back(Planes planes, ConformingMesh& mesh, Session& s, Recorder& recorder) {
  const bool goes_back = planes == Planes::while_refined && !s.given.empty();
  // What is outside takes time, and is in the way: of a stand-in, there are flat tetrahedra between
  // facets that are nearly in one plane.
  if (s.options.region == Region::interior) keep_inside(mesh);
  if (improve_final(mesh, s).changed) recorder.improved(mesh);
  if (!goes_back) return true;
  const std::size_t before = mesh.tetrahedra.size();
  const std::vector<std::uint8_t> is_flat = s.topology.edge_is_flat;
  if (!put_back(mesh, s, recorder)) return false;
  improve_as_given(before, is_flat, mesh, s, recorder);
  recorder.improved(mesh);
  return true;
}

void write_refined(const chamfer::ChamferedSurface& chamfered, refine::RefineResult refined,
                   Session& s, Recorder& recorder) {
  refined.delaunay.reset();
  s.control.enter(Phase::round);
  output::RoundingResult rounded = output::round_mesh(
      rounding_input(refined_part(chamfered.chamfer, refined, s.options.region), s), s.control);
  s.control.poll_now(rounded.vertices.size(), 1);  // small meshes are hardly asked before
  recorder.written(std::move(rounded));
}

Status mesh_with(Planes planes, const Surface& surface, Session& s, Recorder& recorder) {
  if (Status status = prepare(surface, planes, s, recorder); !status.ok()) return status;

  Budget budget(s.options);
  Fallback fallback(s.options);
  chamfer::ChamferedSurface chamfered = filter_to_budget(budget, fallback, s, recorder);
  refine::RefineResult refined = refine_mesh(chamfered, budget.tau(), fallback, s);
  while (refined.runaway) {
    fallback.tighten(*refined.runaway, s);
    s.points.truncate(s.input_vertices());
    chamfered = filter_and_chamfer(budget.tau(), fallback.chamfering(), s);
    refined = refine_mesh(chamfered, budget.tau(), fallback, s);
  }
  recorder.chamfered(chamfered.chamfer, chamfered.filter, fallback.in_force(budget.tau()));
  recorder.refined(chamfered.chamfer, refined);
  if (s.options.approximate) {
    write_refined(chamfered, std::move(refined), s, recorder);
    return {};
  }

  cdt::CdtResult cdt = enriched_cdt(chamfered, std::move(refined), s);
  s.control.enter(Phase::enrich);
  if (std::optional<cdt::CdtResult> plain = plain_if_better(cdt, s)) {
    cdt = std::move(*plain);
    recorder.plain_taken();
  }
  recorder.tetrahedrized(cdt);
  if (s.options.improve) {
    s.control.enter(Phase::improve);
    // Without a mesh: run_mesh has to run once more, without a stand-in.
    if (!improve_and_go_back(planes, cdt.mesh, s, recorder)) return {};
  }
  s.control.enter(Phase::round);
  round_and_record(std::move(cdt.mesh), s, recorder);
  return {};
}

Status mesh(const Surface& surface, Session& s, Recorder& recorder) {
  return mesh_with(goes_back(s.options) ? Planes::while_refined : Planes::to_the_end, surface, s,
                   recorder);
}

Status mesh_directly(const Surface& surface, Session& s, Recorder& recorder) {
  return mesh_with(Planes::none, surface, s, recorder);
}

// Without refinement: the surface alone.
Status plain_cdt(const Surface& surface, Session& s, Recorder& recorder) {
  if (Status status = prepare(surface, Planes::none, s, recorder); !status.ok()) return status;
  cdt::CdtInput input = enrich::plain_input(s.topology);
  input.on_step = [&s](cdt::CdtStep step) { s.control.enter(phase_of(step)); };
  cdt::CdtResult cdt =
      cdt::constrained_delaunay_tetrahedrization(input, s.points, s.predicates, s.control);
  recorder.tetrahedrized(cdt);
  s.control.enter(Phase::round);
  round_and_record(std::move(cdt.mesh), s, recorder);
  return {};
}

using Pipeline = Status (*)(const Surface&, Session&, Recorder&);

Result run(Pipeline pipeline, const Surface& surface, const Options& options,
           const LocalFrame& frame) {
  Result result;
  Control control(options);
  Session session(options, control, frame);
  Recorder recorder(session, result);
  result.status = guarded(control, [&]() -> Status {
    if (const std::string defect = options_defect(options); !defect.empty()) {
      return {StatusCode::invalid_options, defect};
    }
    session.sizes = SizeField(options.size_field, options.size_growth);
    return pipeline(surface, session, recorder);
  });
  recorder.finish();
  return result;
}

Result run_mesh(const Surface& surface, const Options& options, const LocalFrame& frame) {
  FinerPlanes planes(options);
  Result best = run(mesh, surface, options, frame);
  while (planes.plan_run_after(best)) {
    FinerPlanes::keep_better(
        run(planes.directly() ? mesh_directly : mesh, surface, planes.options(), frame), best);
  }
  return best;
}

Result run_plain_cdt(const Surface& surface, const Options& options, const LocalFrame& frame) {
  return run(plain_cdt, surface, options, frame);
}

}  // namespace

Result tetrahedralize(const Surface& surface, const Options& options) {
  return in_ordinary_units(surface, options, run_mesh);
}

Result constrained_delaunay(const Surface& surface, const CdtOptions& given) {
  auto options = options::taken_from<Options>(given);
  options.want_exact = given.want_exact;
  return in_ordinary_units(surface, options, run_plain_cdt);
}

}  // namespace delmesher
