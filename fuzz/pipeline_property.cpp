#include <algorithm>
#include <cmath>

#include "fuzz/properties.h"
#include "fuzz/stages.h"
#include "oracles/improvement/local_operations.h"
#include "oracles/verify.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
namespace {

using delmesher::Options;
using delmesher::Result;
using delmesher::StatusCode;
using delmesher::Surface;
using oracles::Stage;

// A run that reaches this limit is not a finding; a campaign is not the place for large meshes.
constexpr std::uint64_t kMostVertices = 3000;
constexpr std::uint64_t kFewVertices = 1000;

Leniency too_many_vertices("stopped-at-3000-vertices", 0.03);
Leniency less_planar("stopped-with-facets-less-planar", 0.05);
Leniency too_precise("stopped-features-below-2^-40", 0.05);
Leniency nothing_refined("refined-oracle-without-work", 0.2);
Leniency too_large_to_scale("too-large-to-mesh-twice", 0.1);
Leniency out_of_range("out-of-range-when-scaled", 0.1);
Leniency within_roundings("file-of-features-below-8-ulp", 0.01);
Leniency inexact_repairs("file-of-inexact-repairs-below-8-ulp", 0.01);
Leniency left_by_rounding("not-positive-as-written-below-8-ulp", 0.01);
Leniency left_on_surface("vertices-left-on-a-kept-surface", 0.05);
Leniency explained_by_place("bad-tetrahedra-explained-by-place", 0.01);
Leniency explained_with_size("bad-tetrahedra-explained-by-place-with-default-size", 0.2);

using Points = std::vector<std::array<double, 3>>;

double largest_coordinate(const Points& points) {
  double largest = 0;
  for (const auto& p : points) {
    for (const double x : p) largest = std::max(largest, std::fabs(x));
  }
  return largest;
}

oracles::Polyhedron as_polyhedron(const Surface& surface) {
  return {surface.vertices, surface.triangles, surface.labels, {}};
}

oracles::MeshFile as_file(const delmesher::TetMesh& mesh) {
  oracles::MeshFile file;
  file.vertices = mesh.vertices;
  file.tetrahedra = mesh.tetrahedra;
  file.regions.assign(mesh.inside.begin(), mesh.inside.end());
  file.boundary = mesh.boundary;
  file.labels = mesh.boundary_labels;
  file.facets = mesh.boundary_facets;
  file.planar_within = mesh.planar_within;
  return file;
}

std::string first_failure(const oracles::VerifyReport& report) {
  for (const auto& oracle : report.oracles) {
    if (!oracle.findings.empty()) return oracle.name + ": " + oracle.findings[0];
  }
  return "verdict: " + std::string(oracles::verdict_name(report.verdict));
}

// Features of a few roundings.
bool below_8_ulp(const Surface& surface) {
  return !roomy(surface, 0x1p-49);
}

// Where features are a few roundings apart and points were added, the written file may have other
// sides of the surface than the exact mesh, which is judged all the same.
bool rounded_beyond_features(const Surface& surface, const oracles::VerifyReport& report) {
  for (const auto& oracle : report.oracles) {
    const bool of_file = oracle.name == "conformity" || oracle.name == "volume" ||
                         oracle.name == "boundary-list" || oracle.name == "regions" ||
                         oracle.name == "hull";
    if (oracle.violations > 0 && !of_file) return false;
  }
  return below_8_ulp(surface);
}

Finding verified(const Surface& surface, const Result& result, Stage stage,
                 const oracles::Promise& promise) {
  oracles::VerifyOptions wanted;
  wanted.stage = stage;
  wanted.promised = promise;
  oracles::VerifyReport report;
  const std::string refusal =
      oracles::verify(as_polyhedron(surface), as_file(result.mesh), &result.exact, wanted, report);
  if (!refusal.empty()) return "oracles refuse: " + refusal;
  if (const oracles::OracleReport* improvement = report.find("improvement")) {
    if (improvement->figure(oracles::kByPlace)) {
      (result.statistics.chosen_size > 0 ? explained_with_size : explained_by_place).take();
    }
  }
  bool violated = false;
  for (const auto& oracle : report.oracles) violated = violated || oracle.violations > 0;
  // An oracle that had nothing to look at (for instance because the filter left no facet) makes the
  // verdict of the refined stage "broken", but is not a finding.
  if (!violated && !oracles::failed(report, wanted)) return {};
  if (stage == Stage::final && rounded_beyond_features(surface, report)) {
    within_roundings.take();
    return {};
  }
  if (violated || stage == Stage::final) {
    return (stage == Stage::refined ? "refined " : "final ") + first_failure(report);
  }
  nothing_refined.take();
  return {};
}

// Reaching the limit on vertices is not a finding: it is counted by its cause, and features that
// doubles can hardly tell apart take thousands of vertices by themselves. Stopping for want of
// precision is a finding if there is room. No other limit was set.
Finding at_limit(const Surface& surface, const delmesher::Status& status) {
  switch (status.limit) {
    case delmesher::Limit::size:
      (roomy(surface) ? too_many_vertices : too_precise).take();
      return {};
    case delmesher::Limit::precision:
      if (roomy(surface)) return "status: " + status.message;
      too_precise.take();
      return {};
    default:
      return "limit: " + status.message;
  }
}

// Where features are so close to each other that rounding left tetrahedra inverted or flat, or its
// last repairs hold as written alone. Then the file is not what the record says, and is judged by
// itself: it must be as good as the run says that it is.
Finding judged_as_written(const Surface& surface, const Result& result) {
  if (!below_8_ulp(surface)) return "rounding: inverted, flat or inexact, and there is room";
  const delmesher::Statistics& s = result.statistics;
  const bool left = s.rounding_inverted + s.rounding_flat > 0;
  (left ? left_by_rounding : inexact_repairs).take();
  oracles::VerifyReport report;
  const std::string refusal =
      oracles::verify(as_polyhedron(surface), as_file(result.mesh), nullptr, {}, report);
  if (!refusal.empty()) return "oracles refuse: " + refusal;
  if (report.inverted != s.rounding_inverted || report.flat != s.rounding_flat) {
    return "rounding: other numbers of inverted and flat tetrahedra than the run says";
  }
  return !left && report.any_failed() ? "file " + first_failure(report) : "";
}

Finding judged(const Surface& surface, const Result& result, const oracles::Promise& promise) {
  switch (result.status.code) {
    case StatusCode::ok:
      break;
    case StatusCode::limit_reached:
      return at_limit(surface, result.status);
    default:
      return "status: " + result.status.message;
  }
  const delmesher::Statistics& s = result.statistics;
  const std::uint64_t left = s.rounding_inverted + s.rounding_flat;
  // A run with facets less planar may leave none, but had no more vertices.
  if (left + s.rounding_inexact > 0 &&
      (s.planar_limit == delmesher::Limit::size || s.planar_limit == delmesher::Limit::budget)) {
    less_planar.take();
    return {};
  }
  if (left + s.rounding_inexact > 0) return judged_as_written(surface, result);
  if (promise.task == oracles::Task::mesh) {
    if (Finding f = verified(surface, result, Stage::refined, promise); !f.empty()) return f;
  }
  return verified(surface, result, Stage::final, promise);
}

Points times(Points points, int exponent) {
  for (auto& p : points) {
    for (double& x : p) x = std::ldexp(x, exponent);
  }
  return points;
}

// A power of two changes the size of the result and nothing else, even where the run is made in
// other units than the input's.
Finding same_when_scaled(const Surface& surface, const Result& plain, const Options& options,
                         int exponent) {
  Surface scaled = surface;
  scaled.vertices = times(surface.vertices, exponent);
  // Left out where coordinates are so small that they are rounded, or so large.
  if (!(largest_coordinate(scaled.vertices) < 0x1p450) ||
      largest_coordinate(scaled.vertices) < 0x1p-450 ||
      times(scaled.vertices, -exponent) != surface.vertices) {
    out_of_range.take();
    return {};
  }
  Options units = options;
  units.max_edge = std::ldexp(options.max_edge, exponent);
  units.chamfer_radius = std::ldexp(options.chamfer_radius, exponent);
  for (delmesher::SizeSource& source : units.size_field) {
    for (double& x : source.point) x = std::ldexp(x, exponent);
    source.size = std::ldexp(source.size, exponent);
  }
  const Result result = delmesher::tetrahedralize(scaled, units);
  if (!result.status.ok()) return "scale status: " + result.status.message;
  if (result.mesh.tetrahedra != plain.mesh.tetrahedra || result.mesh.inside != plain.mesh.inside ||
      result.mesh.boundary != plain.mesh.boundary) {
    return "scale mesh: another mesh at 2^" + std::to_string(exponent);
  }
  if (times(plain.mesh.vertices, exponent) != result.mesh.vertices) {
    return "scale vertices: not the same at 2^" + std::to_string(exponent);
  }
  bool same = plain.exact.corners.size() == result.exact.corners.size();
  for (std::size_t c = 0; same && c < plain.exact.corners.size(); ++c) {
    same =
        result.exact.corners[c].distance == std::ldexp(plain.exact.corners[c].distance, exponent);
  }
  same = same && result.exact.parameters.tolerance ==
                     std::ldexp(plain.exact.parameters.tolerance, exponent);
  same =
      same && result.exact.parameters.planar == std::ldexp(plain.exact.parameters.planar, exponent);
  same = same &&
         result.statistics.bbox_diagonal == std::ldexp(plain.statistics.bbox_diagonal, exponent);
  return same ? "" : "scale record: lengths do not follow";
}

// A hash of the connectivity, so that the same bytes always mean the same run.
std::uint64_t hash_of(const Surface& surface) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const auto& t : surface.triangles) {
    for (const auto v : t) hash = (hash ^ v) * 0x100000001b3ULL;
  }
  return hash ^ hash >> 29;
}

Options options_for(const Surface& surface) {
  const std::uint64_t hash = hash_of(surface);
  const double size = largest_coordinate(surface.vertices);
  Options options;
  options.want_exact = true;
  options.max_vertices = kMostVertices;
  options.acute = (hash & 1) != 0 ? 60 : 90;
  options.slivers = (hash & 2) != 0;
  options.tau = (hash & 4) != 0 ? 1e-4 : 1e-2;
  options.region = (hash & 24) == 0 ? delmesher::Region::hull : delmesher::Region::interior;
  options.simplify_bridges = (hash & 96) != 0;
  options.gabriel = (hash >> 16) % 2 == 0;
  options.improve = (hash >> 19) % 4 != 0;
  if ((hash >> 24) % 4 != 0) options.size = 0;
  if ((hash >> 26) % 32 == 0) options.budget = kMostVertices;
  constexpr double kPlanar[] = {delmesher::kPlanarAuto, delmesher::kPlanarAuto, 0, 1e-4};
  options.planar = kPlanar[(hash >> 17) % 4];
  if ((hash >> 7) % 8 == 0) options.max_edge = size / 4;
  if ((hash >> 10) % 8 == 0) options.chamfer_radius = size / 64;
  if ((hash >> 21) % 8 == 0 && size > 0 && std::isfinite(size)) {
    options.size_field = {{{size / 2, 0, 0}, size / 16}, {{0, size, size / 4}, size / 8}};
  }
  return options;
}

// Without the options that ask for many vertices on any surface, and with less of the surface in
// the refinement.
Options coarser(Options options) {
  options.max_edge = options.chamfer_radius = options.size = 0;
  options.budget = 0;
  options.size_field.clear();
  options.gabriel = false;
  options.region = delmesher::Region::interior;
  options.tau = 0.1;
  return options;
}

// A surface that would need more vertices than the limit is meshed with coarser options instead.
Result meshed(const Surface& surface, Options& options) {
  Result result = delmesher::tetrahedralize(surface, options);
  const delmesher::Limit limit = result.status.limit;
  if (limit != delmesher::Limit::size && limit != delmesher::Limit::budget) return result;
  options = coarser(options);
  return delmesher::tetrahedralize(surface, options);
}

}  // namespace

Finding cdt_holds(const Surface& surface) {
  judging(
      {&too_many_vertices, &too_precise, &within_roundings, &inexact_repairs, &left_by_rounding});
  delmesher::CdtOptions options;
  options.want_exact = true;
  options.region = delmesher::Region::interior;
  options.max_vertices = kMostVertices;
  const Result result = delmesher::constrained_delaunay(surface, options);
  return judged(surface, result, oracles::promise_of(options));
}

Finding keep_holds(const Surface& surface) {
  judging({&too_many_vertices, &too_precise, &within_roundings, &inexact_repairs, &left_by_rounding,
           &left_on_surface});
  Options options;
  options.want_exact = true;
  options.max_vertices = kMostVertices;
  options.surface = delmesher::SurfaceChoice::keep;
  if (hash_of(surface) % 4 == 0) options.max_edge = options_for(surface).max_edge;
  const Result result = delmesher::tetrahedralize(surface, options);
  if (result.statistics.left_on_surface > 0) {
    left_on_surface.take();
  } else {
    options.strict = true;  // judged as if nothing might be left
  }
  return judged(surface, result, oracles::promise_of(options));
}

Finding refinement_holds(const Surface& surface) {
  judging({&too_many_vertices, &too_precise, &nothing_refined, &left_by_rounding});
  Options options = options_for(surface);
  options.approximate = true;
  const Result result = meshed(surface, options);
  if (result.status.code == StatusCode::limit_reached) return at_limit(surface, result.status);
  if (!result.status.ok()) return "status: " + result.status.message;
  // The refined mesh keeps all its points, also where there is no room for them as written.
  const delmesher::Statistics& s = result.statistics;
  if (s.rounding_inverted + s.rounding_flat > 0) return judged_as_written(surface, result);
  return verified(surface, result, Stage::refined, oracles::promise_of(options));
}

Finding pipeline_holds(const Surface& surface) {
  judging({&too_many_vertices, &less_planar, &too_precise, &nothing_refined, &too_large_to_scale,
           &out_of_range, &within_roundings, &inexact_repairs, &left_by_rounding,
           &explained_by_place, &explained_with_size});
  Options options = options_for(surface);
  const Result result = meshed(surface, options);
  if (Finding f = judged(surface, result, oracles::promise_of(options)); !f.empty()) return f;
  if (!result.status.ok()) return {};
  const int scales[] = {0, 0, 0, 300, -300, 65, -47, 1};
  const int exponent = scales[(hash_of(surface) >> 13) % 8];
  if (exponent == 0) return {};
  if (result.mesh.vertices.size() <= kFewVertices) {
    return same_when_scaled(surface, result, options, exponent);
  }
  options = coarser(options);
  options.max_vertices = kFewVertices;
  const Result few = delmesher::tetrahedralize(surface, options);
  if (few.status.ok()) return same_when_scaled(surface, few, options, exponent);
  if (few.status.limit != delmesher::Limit::size) return "coarser status: " + few.status.message;
  too_large_to_scale.take();
  return {};
}

namespace {

Finding whole_pipeline_holds(const Surface& surface, const Options& options, bool& kept) {
  const Result result = delmesher::tetrahedralize(surface, options);
  kept = result.statistics.ladder[delmesher::Rung::keep_surface] > 0;
  if (!result.status.ok()) return "status: " + result.status.message;
  if (result.statistics.rounding_inverted + result.statistics.rounding_flat > 0) {
    return "rounding: inverted or flat tetrahedra are left";
  }
  const oracles::Promise promise = oracles::promise_of(options);
  if (kept) return verified(surface, result, Stage::both, promise);
  if (Finding f = verified(surface, result, Stage::refined, promise); !f.empty()) return f;
  return verified(surface, result, Stage::final, promise);
}

}  // namespace

// A surface that the defaults keep is split as well.
Finding default_pipeline_holds(const Surface& surface) {
  judging({&nothing_refined, &explained_with_size});
  Options options;
  options.want_exact = true;
  bool kept = false;
  if (Finding f = whole_pipeline_holds(surface, options, kept); !f.empty() || !kept) return f;
  options.surface = delmesher::SurfaceChoice::split;
  return whole_pipeline_holds(surface, options, kept);
}

// Features of a few roundings are left out: their meshes may be inverted as written.
Finding tolerance_holds(const Surface& surface) {
  judging({&too_many_vertices, &too_precise, &left_by_rounding, &within_roundings});
  if (below_8_ulp(surface)) {
    left_by_rounding.take();
    return {};
  }
  const std::uint64_t hash = hash_of(surface);
  constexpr double kTolerances[] = {-1e-1, -1e-2, -1e-3, -1e-5};
  Options options;
  options.tolerance = kTolerances[hash % 4];
  options.max_vertices = kMostVertices;
  if ((hash & 4) != 0) options.surface = delmesher::SurfaceChoice::keep;
  if ((hash & 24) == 0) options.max_edge = largest_coordinate(surface.vertices) / 4;
  const Result result = delmesher::tetrahedralize(surface, options);
  // Far from the origin vertices are rounded by as much; such tolerances are refused.
  if (result.statistics.tolerance < 0x1p-39 * largest_coordinate(surface.vertices)) {
    within_roundings.take();
    return {};
  }
  if (result.status.code == StatusCode::limit_reached) return at_limit(surface, result.status);
  if (!result.status.ok()) return "status: " + result.status.message;
  oracles::VerifyOptions wanted;
  wanted.promised = oracles::promise_of(options);
  oracles::VerifyReport report;
  const std::string refusal =
      oracles::verify(as_polyhedron(surface), as_file(result.mesh), nullptr, wanted, report);
  if (!refusal.empty()) return "oracles refuse: " + refusal;
  return report.any_failed() ? first_failure(report) : "";
}

}  // namespace tetproof::fuzz
