// The order of the stages: Algorithm 2 of the paper, and the policies that repeat parts of it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>

#include "mesher/base/climb.h"
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
#include "mesher/planar/planar.h"
#include "mesher/policies/as_given.h"
#include "mesher/policies/budget.h"
#include "mesher/policies/budget_size.h"
#include "mesher/policies/default_size.h"
#include "mesher/policies/fallback.h"
#include "mesher/policies/plain.h"
#include "mesher/policies/planar_runs.h"
#include "mesher/policies/thinned_rounding.h"
#include "mesher/refine/refine.h"
#include "mesher/remesh/remesh.h"
#include "mesher/results/recorder.h"
#include "mesher/results/region_list.h"
#include "mesher/results/region_points.h"
#include "mesher/results/rounding_input.h"
#include "mesher/results/split_walls.h"
#include "mesher/results/units.h"
#include "mesher/run/options.h"
#include "mesher/run/session.h"
#include "mesher/surface/complex.h"
#include "mesher/surface/loose_points.h"
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

bool is_complex(const Session& s) {
  return s.options.regions != Regions::solid;
}

Status bounds_nothing() {
  return {StatusCode::invalid_surface,
          "the triangles bound no region: all that they divide is open to the outside"};
}

// Powers of shorter lengths are no doubles, and a refinement that strives for them need not end.
Status sizes_are_doubles(const Surface& surface, const Session& s) {
  constexpr double kShortest = 1e-50;  // of the diagonal
  if (s.options.size_field.empty()) return {};
  const Box box = Box::around(surface.vertices);
  for (std::size_t n = 0; n < s.options.size_field.size(); ++n) {
    const auto& [place, size] = s.options.size_field[n];
    if (!(size < kShortest * s.diagonal)) continue;
    Vec3 nearest = place;  // in the box
    for (std::size_t k = 0; k < 3; ++k) nearest[k] = std::clamp(place[k], box.lo[k], box.hi[k]);
    if (s.sizes.at(nearest) < kShortest * s.diagonal) {
      return {StatusCode::limit_reached,
              "source " + std::to_string(n) +
                  " of the size field asks for edges below 1e-50 of the diagonal, too short for "
                  "double precision",
              Limit::precision};
    }
  }
  return {};
}

// What is to be meshed, checked once however many runs there are.
struct Given {
  const Surface& surface;
  std::optional<ValidityResult> validity{};

  const ValidityResult& checked(Rules rules, Control& control) {
    if (!validity) validity = check_validity(surface, true, control, kMostPlaces, rules);
    return *validity;
  }
};

// A tetrahedron has at most the volume of a regular one with its longest edge, and its faces the
// area of an equilateral one.
Status sizes_can_be_numbered(const Surface& surface, const Session& s) {
  const double edge = s.options.max_edge;
  if (edge == 0) return {};
  double area = 0, volume = 0;
  for (const auto& t : surface.triangles) {
    const Vec3 &a = surface.vertices[t[0]], &b = surface.vertices[t[1]],
               &c = surface.vertices[t[2]];
    area += norm(cross(subtract(b, a), subtract(c, a))) / 2;
    volume +=
        dot(subtract(a, surface.vertices.front()),
            cross(subtract(b, surface.vertices.front()), subtract(c, surface.vertices.front()))) /
        6;
  }
  const bool kept = s.options.surface == SurfaceChoice::keep || is_complex(s);
  const double least = std::max(kept ? 0 : area / edge / edge * 4 / std::numbers::sqrt3,
                                std::fabs(volume) / edge / edge / edge * 6 * std::numbers::sqrt2);
  if (least < 0x1p32) return {};
  char text[100];
  std::snprintf(text, sizeof text,
                "edges so short take %.2g tetrahedra at least, more than can be numbered",
                std::min(least, 1e300));
  return {StatusCode::limit_reached, text, Limit::size};
}

// The surface as all stages see it: valid, oriented outwards and, if it is to be refined, with
// near-coplanar triangles in exactly one plane. A complex as it is given.
Status prepare(Given& given, Planes planes, Session& s, Recorder& recorder) {
  s.control.enter(Phase::check);
  const Surface& surface = given.surface;
  const Rules rules = is_complex(s) ? Rules::complex : Rules::solid;
  const ValidityResult& validity = given.checked(rules, s.control);
  if (!validity.report.status.ok()) return validity.report.status;
  recorder.checked(validity.report);
  s.diagonal = validity.report.bbox_diagonal;
  if (Status status = sizes_are_doubles(surface, s); !status.ok()) return status;
  if (Status status = sizes_can_be_numbered(surface, s); !status.ok()) return status;
  if (rules == Rules::solid) {
    recorder.planar(enter_surface(surface, validity, planes, s), validity);
    return {};
  }
  s.surface.enter_given(build_topology(surface, s.points, s.predicates, rules));
  recorder.planar({}, validity);
  return s.surface.topology().plane_count == 1 ? bounds_nothing() : Status{};
}

chamfer::FilteredSurface filtered_surface(double tau, const chamfer::ChamferOptions& options,
                                          Session& s) {
  chamfer::FilterOptions filter{.tolerance = tau * s.diagonal,
                                .all_pairs = s.options.as_paper.filter_pairs,
                                .both_sides = s.options.as_paper.filter_chamfered};
  if (filter.both_sides) filter.chamfered_fraction = 1;
  return {s.surface.topology(), s.points, s.predicates, options, filter, s.control};
}

refine::RefineResult refine_mesh(chamfer::ChamferedSurface& chamfered, double tau,
                                 const Fallback& fallback, Session& s) {
  refine::add_outer_box(s.surface.topology(), s.points, chamfered.chamfer.plc, s.frame);
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
  options.removed = chamfer::removed_boxes(chamfered.chamfer, chamfered.filter.facet_kept,
                                           s.surface.topology(), s.points);
  return refine::refine(chamfered.chamfer.plc, s.surface.topology(), s.points, s.predicates,
                        options, s.control);
}

// The refined mesh, and what the surface is for it.
struct Refinement {
  Session& s;
  Recorder& recorder;
  Budget budget{s.options};
  Fallback fallback{s.options};
  std::optional<chamfer::FilteredSurface> surface{};
  chamfer::ChamferedSurface chamfered{};
  refine::RefineResult refined{};

  // Sections 4 and 7, in turn until neither leaves anything to the other; false if the first step
  // shows that the mesh will not keep to the budget.
  bool filter(bool within_budget) {
    s.control.enter(Phase::filter);
    surface->drop_close();
    if (within_budget && budget.is_exceeded_at_least(*surface, s, recorder)) return false;
    do {
      s.control.enter(Phase::chamfer);
      surface->chamfer();
      s.control.enter(Phase::filter);
    } while (surface->drop_small());
    s.control.enter(Phase::chamfer);
    return true;
  }
  void begin() {
    s.points.truncate(s.input_vertices());
    surface.emplace(filtered_surface(budget.tau(), fallback.chamfering(), s));
  }
  void end() {
    chamfered = surface->result();
    surface.reset();
  }
  void refine() { refined = refine_mesh(chamfered, budget.tau(), fallback, s); }
  void refine_anew() {
    begin();
    filter(false);
    end();
    refine();
  }
};

// With so large a tolerance of the filter that the mesh is predicted to keep to the budget.
struct Filtering {
  Refinement& r;

  void attempt() {
    if (r.filter(true)) r.budget.predict(*r.surface, r.s, r.recorder);
  }
  bool good_enough() const { return r.budget.is_kept(); }
};

constexpr Step<Filtering> kFiltering[] = {
    {Rung::larger_tau, [](const Filtering& f) { return f.r.budget.can_raise_tau(); },
     [](Filtering& f) {
       f.r.budget.raise_tau();
       f.r.surface->raise(f.r.budget.tau() * f.r.s.diagonal);
       f.attempt();
     }},
};

// The guard has stopped a refinement that would not end.
struct Guarded {
  Refinement& r;

  bool good_enough() const { return !r.refined.runaway; }
};

constexpr Step<Guarded> kGuard[] = {
    {Rung::chamfers_everywhere, [](const Guarded&) { return true; },
     [](Guarded& g) {
       g.r.fallback.tighten();
       g.r.refine_anew();
     }},
};

// Gives up the refined mesh, because the last step needs its memory.
cdt::CdtResult enriched_cdt(const chamfer::ChamferedSurface& chamfered,
                            refine::RefineResult refined, Session& s) {
  s.control.enter(Phase::enrich);
  std::unique_ptr<Tetrahedrization> delaunay = std::move(refined.delaunay);
  cdt::CdtInput input = enrich::enriched_input(
      chamfered.chamfer, chamfered.filter.facet_kept, refined, s.surface.topology(), s.points,
      s.predicates, s.options.as_paper.kept_points, s.control);
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
  options.halve_edges = true;  // also where corners came back unrefined
  improve::ImproveResult result =
      improve::improve(std::move(mesh), &s.surface.topology(), s.surface.given_vertices(), options,
                       s.points, s.predicates, s.control);
  mesh = std::move(result.mesh);
  return result;
}

// What has come back may take a tenth more tetrahedra than the planarized one had; beyond
// that, points on the edges that came back are spared.
void improve_as_given(std::size_t before, const std::vector<std::uint8_t>& is_flat,
                      ConformingMesh& mesh, Session& s, Recorder& recorder) {
  std::vector<std::uint8_t> returned = is_flat;  // on the planarized surface
  for (std::size_t e = 0; e < returned.size(); ++e) {
    if (s.surface.topology().edge_is_flat[e] != 0) returned[e] = 0;
  }
  recorder.spared(improve_final(mesh, s, {returned, before + before / 10}).spared);
}

// From the planarized surface to the surface as given, with all its edges.
struct WayBack {
  const ConformingMesh planarized;
  Session& s;
  Recorder& recorder;
  const std::size_t points = s.points.size();
  SurfaceAsGiven given = as_given(s);
  std::optional<ConformingMesh> mesh{};

  bool good_enough() const { return mesh.has_value(); }

  void attempt() {
    improve::DiagonalsResult entered = improve::enter_diagonals(
        planarized, s.surface.topology(), given.topology, s.surface.given_vertices(),
        improve_options(Region::hull, s), s.points, s.predicates, s.control);
    recorder.put_back(entered.diagonals, entered.missing);
    if (entered.missing == 0 && go_back(entered.mesh, given, s)) mesh = std::move(entered.mesh);
  }
  void tetrahedrize_again() {
    s.points.truncate(points);
    mesh = tetrahedrize_as_given(planarized, std::move(given), s).mesh;
    if (s.options.region == Region::interior) keep_inside(*mesh);
  }
};

constexpr Step<WayBack> kWayBack[] = {
    {Rung::tetrahedrize_again, [](const WayBack& w) { return !w.s.bounds_edges(); },
     [](WayBack& w) { w.tetrahedrize_again(); }},
};

Status put_back(ConformingMesh& mesh, Session& s, Recorder& recorder) {
  WayBack way{std::move(mesh), s, recorder};
  way.attempt();
  climb(way, kWayBack, recorder.ladder());
  if (!way.mesh) {
    recorder.no_way_back();
    return {StatusCode::limit_reached, "the mesh found no way back from planar facets",
            Limit::precision};
  }
  mesh = std::move(*way.mesh);
  return {};
}

// Improves the final mesh; a mesh of the planarized surface that goes back is improved before and
// after.
Status improve_and_go_back(Planes planes, ConformingMesh& mesh, Session& s, Recorder& recorder) {
  // Drop outside tetrahedra first: they cost time, and between facets that are nearly in one plane
  // there are flat ones that block operations.
  if (s.options.region == Region::interior) keep_inside(mesh);
  if (improve_final(mesh, s).changed) recorder.improved(mesh);
  if (planes != Planes::while_refined || !s.surface.is_planarized()) return {};
  const std::size_t before = mesh.tetrahedra.size();
  const std::vector<std::uint8_t> is_flat = s.surface.topology().edge_is_flat;
  if (Status status = put_back(mesh, s, recorder); !status.ok()) return status;
  improve_as_given(before, is_flat, mesh, s, recorder);
  recorder.improved(mesh);
  return {};
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

Status mesh_with(Planes planes, Given& given, Session& s, Recorder& recorder) {
  if (Status status = prepare(given, planes, s, recorder); !status.ok()) return status;

  Refinement refinement{s, recorder};
  refinement.begin();
  Filtering filtering{refinement};
  filtering.attempt();
  climb(filtering, kFiltering, recorder.ladder());
  refinement.budget.settle(s);
  refinement.end();
  refinement.refine();
  Guarded guard{refinement};
  climb(guard, kGuard, recorder.ladder());
  const chamfer::ChamferedSurface& chamfered = refinement.chamfered;
  refine::RefineResult& refined = refinement.refined;
  recorder.chamfered(chamfered.chamfer, chamfered.filter,
                     refinement.fallback.in_force(refinement.budget.tau()));
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
    if (Status status = improve_and_go_back(planes, cdt.mesh, s, recorder); !status.ok()) {
      return status;
    }
  }
  s.control.enter(Phase::round);
  round_and_record(std::move(cdt.mesh), s, recorder);
  return {};
}

cdt::CdtResult plain_cdt(cdt::CdtInput input, Session& s) {
  if (is_complex(s)) input.partition = cdt::Partition::regions;
  input.on_step = [&s](cdt::CdtStep step) { s.control.enter(phase_of(step)); };
  return cdt::constrained_delaunay_tetrahedrization(input, s.points, s.predicates, s.control);
}

// A mesh whose faces on the surface are the triangles, but for those that vertices were left on
// and, with SurfaceChoice::automatic, those with edges that are longer than wanted.
struct Keeping {
  Session& s;
  Recorder& recorder;
  ConformingMesh mesh{};
  std::uint64_t missing = 0, left = 0;
  std::size_t bare = 0;                // triangles with nothing inside on either side
  std::vector<double> region_edges{};  // Options::region_sizes, by region

  bool good_enough() const { return missing == 0; }

  void tetrahedrize() {
    cdt::CdtResult cdt =
        plain_cdt(enrich::plain_input(s.surface.topology(), s.points, s.predicates), s);
    recorder.tetrahedrized(cdt);
    mesh = std::move(cdt.mesh);
    s.control.enter(Phase::improve);
    bare = drop_outside_if_apart();
  }
  // Local operations need all tetrahedra at a vertex, which hang together with those outside.
  std::size_t drop_outside_if_apart() {
    return !is_complex(s) || !touches_itself(mesh) ? drop_outside() : 0;
  }
  std::size_t drop_outside() {
    keep_inside(mesh);
    return is_complex(s) ? drop_bare_faces(mesh) : 0;
  }
  // What is not to be written becomes outside.
  Status choose(const MergedSurface& merged, std::vector<MeshRegion>& regions) {
    RegionList list = list_regions(merged, s.points, mesh);
    regions = std::move(list.report.regions);
    bare += list.bare;
    if (Status status = enter_region_points(s.options.region_points, mesh, s.points, regions,
                                            recorder.warnings());
        !status.ok()) {
      return status;
    }
    if (Status status = find_region_sizes(s.options, regions, region_edges); !status.ok()) {
      return status;
    }
    if (Status status = choose_regions(s.options, regions, mesh); !status.ok()) return status;
    drop_outside_if_apart();
    return check_wall_names(s.options, merged, regions, mesh);
  }
  bool is_empty() const {
    return std::ranges::count(mesh.region, kOutside) == std::ssize(mesh.region);
  }
  void fill_and_improve(bool unfinished = false) {
    improve::ImproveOptions options = improve_options(Region::interior, s);
    options.region_edges = region_edges;
    options.keep_surface = true;
    options.unfinished = unfinished;
    options.halve_edges = s.options.surface != SurfaceChoice::keep && !is_complex(s) && !unfinished;
    improve::ImproveResult improved = improve::improve(std::move(mesh), &s.surface.topology(), {},
                                                       options, s.points, s.predicates, s.control);
    mesh = std::move(improved.mesh);
    left = improved.left;
  }
  // Flat edges come back where there is room below them, which takes far fewer points than to
  // tetrahedrize with them.
  void enter_edges() {
    tetrahedrize();
    const std::vector<std::uint8_t>& is_flat = s.surface.topology().edge_is_flat;
    if (is_empty() || std::ranges::find(is_flat, 1) == is_flat.end()) return;
    fill_and_improve(true);
    SurfaceTopology each = with_facet_per_triangle(s.surface.topology());
    improve::DiagonalsResult entered = improve::enter_diagonals(
        std::move(mesh), s.surface.topology(), each, {}, {}, s.points, s.predicates, s.control);
    mesh = std::move(entered.mesh);
    missing = entered.missing;
    s.surface.enter_given(std::move(each));
  }
  void tetrahedrize_triangles() {
    s.points.truncate(s.input_vertices());
    tetrahedrize();
    missing = 0;
  }
};

constexpr Step<Keeping> kKeeping[] = {
    {Rung::tetrahedrize_again, [](const Keeping&) { return true; },
     [](Keeping& k) { k.tetrahedrize_triangles(); }},
};

// `merged`: a complex, whose regions are listed in `regions`.
Status mesh_kept_surface(Given& given, Session& s, Recorder& recorder,
                         const MergedSurface* merged = nullptr,
                         std::vector<MeshRegion>* regions = nullptr) {
  if (Status status = prepare(given, Planes::none, s, recorder); !status.ok()) return status;
  Keeping keeping{s, recorder};
  keeping.enter_edges();
  climb(keeping, kKeeping, recorder.ladder());
  if (keeping.is_empty()) return bounds_nothing();
  if (merged != nullptr) {
    if (Status status = keeping.choose(*merged, *regions); !status.ok()) return status;
  }
  if (s.bounds_edges()) Budget(s.options).bound(s);  // else all may be counted and told
  keeping.fill_and_improve();
  keeping.drop_outside();
  recorder.left_out(keeping.bare);
  recorder.kept(keeping.mesh, keeping.left);
  if (s.options.strict && keeping.left > 0) {
    return {StatusCode::limit_reached,
            std::to_string(keeping.left) + " vertices find no way off the surface",
            Limit::precision};
  }
  s.control.enter(Phase::round);
  round_and_record(std::move(keeping.mesh), s, recorder);
  return {};
}

// Without refinement: the surface alone.
Status surface_alone(Given given, Session& s, Recorder& recorder) {
  if (Status status = prepare(given, Planes::none, s, recorder); !status.ok()) return status;
  cdt::CdtResult cdt = plain_cdt(enrich::plain_input(s.surface.topology()), s);
  recorder.tetrahedrized(cdt);
  s.control.enter(Phase::round);
  round_and_record(std::move(cdt.mesh), s, recorder);
  return {};
}

using Pipeline = std::function<Status(Session&, Recorder&)>;

Result run(const Pipeline& pipeline, const Options& options, const LocalFrame& frame) {
  Result result;
  Control control(options);
  Session session(options, control, frame);
  Recorder recorder(session, result);
  result.status = guarded(control, [&]() -> Status {
    if (const std::string defect = options_defect(options); !defect.empty()) {
      return {StatusCode::invalid_options, defect};
    }
    session.sizes = SizeField(options.size_field, options.size_growth);
    const Status status = pipeline(session, recorder);
    return status.ok() ? Budget::check(options, result) : status;
  });
  recorder.finish();
  return result;
}

Result run_keeping(Given& given, const Options& options, const LocalFrame& frame) {
  return run([&](Session& s, Recorder& recorder) { return mesh_kept_surface(given, s, recorder); },
             options, frame);
}

Result run_kept(const Surface& surface, const Options& options, const LocalFrame& frame) {
  Given given{surface};
  return run_keeping(given, options, frame);
}

// Every part of space that the surface bounds; repeated triangles count once.
Result run_complex(const Surface& surface, const Options& options, const LocalFrame& frame) {
  const MergedSurface merged = merge_repeated(surface);
  Given given{merged.surface};
  std::vector<MeshRegion> regions;
  Result result = run(
      [&](Session& s, Recorder& recorder) {
        return mesh_kept_surface(given, s, recorder, &merged, &regions);
      },
      options, frame);
  if (!result.status.ok()) return result;
  result.regions = std::move(regions);
  finish_regions(options, merged, surface.triangles.size(), result);
  return result;
}

// Whole runs; the best counts.
struct Runs {
  Given given;
  const LocalFrame& frame;
  PlanarRuns planes;
  bool may_keep;
  Result best;
  bool is_kept = false;

  bool good_enough() const { return !is_too_heavy() && PlanarRuns::good_enough(best); }
  bool is_too_heavy() const { return may_keep && !is_kept && planes.is_too_heavy(best); }

  Result run_with(Planes how, const Options& options) {
    return run([&](Session& s, Recorder& recorder) { return mesh_with(how, given, s, recorder); },
               options, frame);
  }
  void run_again(Planes how) { PlanarRuns::keep_better(run_with(how, planes.options()), best); }
  void keep_surface() {
    is_kept = true;
    const Status refused = std::move(best.status);
    const Statistics split = std::move(best.statistics);
    best = run_keeping(given, planes.kept_options(), frame);
    Statistics& kept = best.statistics;
    kept.ladder += split.ladder;
    kept.predicted_tetrahedra = split.predicted_tetrahedra;
    // The smaller number is told.
    const bool took_fewer =
        split.final.tetrahedra > 0 && split.final.tetrahedra < kept.final.tetrahedra;
    if (best.status.limit == Limit::budget && took_fewer) best.status = refused;
  }
};

constexpr Step<Runs> kRuns[] = {
    {Rung::keep_surface, [](const Runs& r) { return r.is_too_heavy(); },
     [](Runs& r) { r.keep_surface(); }},
    {Rung::back_to_given, [](const Runs& r) { return r.planes.applies(Rung::back_to_given); },
     [](Runs& r) { r.run_again(Planes::while_refined); }},
    {Rung::no_planes, [](const Runs& r) { return r.planes.applies(Rung::no_planes); },
     [](Runs& r) { r.run_again(Planes::none); }},
};

Result best_of_runs(const Surface& surface, const Options& given, const LocalFrame& frame,
                    bool may_keep = true) {
  Options options = given;
  options.surface = surface_choice(given);
  Runs runs{{surface}, frame, PlanarRuns(options), may_keep, {}, false};
  runs.best =
      runs.run_with(goes_back(options) ? Planes::while_refined : Planes::to_the_end, options);
  RungCounts taken;
  climb(runs, kRuns, taken);
  runs.best.statistics.ladder += taken;
  return std::move(runs.best);
}

// More runs, with sizes: if the mesh is too coarse without, or has fewer tetrahedra than it may.
struct Sizing {
  using Clock = std::chrono::steady_clock;

  const Surface& surface;
  const LocalFrame& frame;
  const Options& options;
  const Clock::time_point start = Clock::now();
  Result best{};
  DefaultSize chosen{};
  std::optional<BudgetSize> filling{};

  bool good_enough() const { return chosen.size == 0 && (!filling || filling->is_done()); }
  bool is_kept() const { return best.statistics.ladder[Rung::keep_surface] > 0; }

  void attempt() {
    best = options.surface == SurfaceChoice::keep ? run_kept(surface, options, frame)
                                                  : best_of_runs(surface, options, frame);
    if (may_choose_size(options) && best.status.ok()) chosen = default_size(best);
    if (BudgetSize::is_wanted(options, best)) filling.emplace(options, best);
  }
  Result run_with(double size, std::uint64_t most_vertices) {
    Options sized = options;
    sized.max_edge = kMostOfSize * size;
    sized.max_vertices = most_vertices;
    sized.time_limit_seconds = seconds_left();
    // What is not too heavy without a size is not to be kept with one.
    const bool keeps = options.surface == SurfaceChoice::keep || (filling && is_kept());
    Result result =
        keeps ? run_kept(surface, sized, frame) : best_of_runs(surface, sized, frame, is_kept());
    Statistics& s = result.statistics;
    if (filling) s.ladder[Rung::keep_surface] = best.statistics.ladder[Rung::keep_surface];
    if (keeps) s.predicted_tetrahedra = best.statistics.predicted_tetrahedra;
    for (std::size_t i = 0; i < kPhaseCount; ++i) {
      best.statistics.phase_seconds[i] += s.phase_seconds[i];
      s.phase_seconds[i] = best.statistics.phase_seconds[i];
    }
    return result;
  }
  void take(Result sized, double size) {
    sized.statistics.tetrahedra_without_size = best.statistics.chosen_size > 0
                                                   ? best.statistics.tetrahedra_without_size
                                                   : best.mesh.tetrahedra.size();
    sized.statistics.chosen_size = size;
    best = std::move(sized);
  }
  void take_size() {
    const std::uint64_t asked = options.max_vertices;
    const bool bounded = asked == 0 || chosen.most_vertices < asked;
    Result sized = run_with(chosen.size, bounded ? chosen.most_vertices : asked);
    const Status& status = sized.status;
    const bool is_far_more = status.limit == Limit::size && bounded;
    const std::string why = is_far_more
                                ? "more than " + std::to_string(chosen.most_vertices) + " vertices"
                            : status.ok() ? why_not(sized, best)
                                          : status.message;
    if (status.ok() ? !why.empty() : is_far_more || is_of_the_mesh(status.limit)) {
      best.warnings.push_back("coarse for a solver, but with a size: " + why);
    } else {
      take(std::move(sized), chosen.size);
    }
  }
  void fill() {
    const double size = filling->size();
    Result sized = run_with(size, options.max_vertices);
    const Status& status = sized.status;
    const std::uint64_t made = sized.statistics.final.tetrahedra;
    // Lengths that no one asked for keep to all limits but that of time.
    const bool is_large = status.limit == Limit::size || is_of_the_mesh(status.limit);
    if (status.ok() ? PlanarRuns::is_worse(sized, best) : is_large) {
      filling->is_too_much(static_cast<double>(made));
      return;
    }
    if (status.ok()) {
      filling->fits(static_cast<double>(made));
    } else {
      filling.reset();
    }
    if (!status.ok() || made > best.mesh.tetrahedra.size()) take(std::move(sized), size);
  }
  // Not one that the caller has set.
  static bool is_of_the_mesh(Limit limit) {
    return limit == Limit::precision || limit == Limit::budget;
  }
  double seconds_left() const {
    if (options.time_limit_seconds == 0) return 0;
    const std::chrono::duration<double> spent = Clock::now() - start;
    return std::max(options.time_limit_seconds - spent.count(), 1e-9);
  }
};

constexpr Step<Sizing> kSizing[] = {
    {Rung::default_size, [](const Sizing& s) { return s.chosen.size > 0; },
     [](Sizing& s) { s.take_size(); }},
    {Rung::fill_budget, [](const Sizing& s) { return s.filling.has_value(); },
     [](Sizing& s) { s.fill(); }},
};

Result run_mesh(const Surface& surface, const Options& options, const LocalFrame& frame) {
  Sizing sizing{surface, frame, options};
  sizing.attempt();
  RungCounts taken;
  climb(sizing, kSizing, taken);
  sizing.best.statistics.ladder += taken;
  return std::move(sizing.best);
}

Result run_plain_cdt(const Surface& surface, const Options& options, const LocalFrame& frame) {
  return run([&](Session& s, Recorder& recorder) { return surface_alone({surface}, s, recorder); },
             options, frame);
}

// A mesh of another surface, within the tolerance.
Result run_within(const Surface& surface, const Options& options, const LocalFrame& frame) {
  if (options.tolerance == 0) return run_mesh(surface, options, frame);
  Result result;
  remesh::Remeshed remeshed;
  Control control(options);
  result.status = guarded(control, [&]() -> Status {
    if (const std::string defect = options_defect(options); !defect.empty()) {
      return {StatusCode::invalid_options, defect};
    }
    remeshed = remesh::remesh(surface, remesh::goals_of(options), frame, control);
    if (remeshed.status.ok()) add_loose_points(surface, remeshed.surface);
    return remeshed.status;
  });
  const auto& seconds = control.phase_seconds();
  if (result.status.ok()) {
    Options left = options;
    if (left.time_limit_seconds > 0) {
      const double spent = std::accumulate(seconds.begin(), seconds.end(), 0.0);
      left.time_limit_seconds = std::max(left.time_limit_seconds - spent, 1e-3);
    }
    result = run_mesh(remeshed.surface, left, frame);
  }
  result.warnings.insert(result.warnings.begin(), remeshed.warnings.begin(),
                         remeshed.warnings.end());
  Statistics& s = result.statistics;
  for (std::size_t i = 0; i < kPhaseCount; ++i) s.phase_seconds[i] += seconds[i];
  s.tolerance = remeshed.tolerance;
  s.remeshed_triangles = remeshed.surface.triangles.size();
  return result;
}

}  // namespace

Result tetrahedralize(const Surface& surface, const Options& given) {
  Options options = given;
  options.max_edge = bound_on_edges(given);
  if (options.regions != Regions::solid) return in_ordinary_units(surface, options, run_complex);
  return in_ordinary_units(surface, options, run_within);
}

Result constrained_delaunay(const Surface& surface, const CdtOptions& given) {
  auto options = options::taken_from<Options>(given);
  options.want_exact = given.want_exact;
  return in_ordinary_units(surface, options, run_plain_cdt);
}

}  // namespace delmesher
