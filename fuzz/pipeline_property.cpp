#include <algorithm>
#include <cmath>

#include "fuzz/properties.h"
#include "oracles/verify.h"

namespace tetproof::fuzz {
namespace {

using delmesher::Options;
using delmesher::Result;
using delmesher::StatusCode;
using delmesher::Surface;
using oracles::Stage;

// A run that reaches it has said nothing wrong; a campaign is not the place for large meshes.
constexpr std::uint64_t kMostVertices = 6000;

oracles::MeshFile as_file(const delmesher::TetMesh& mesh) {
  oracles::MeshFile file;
  file.vertices = mesh.vertices;
  file.tetrahedra = mesh.tetrahedra;
  file.regions.assign(mesh.inside.begin(), mesh.inside.end());
  file.boundary = mesh.boundary;
  file.labels = mesh.boundary_labels;
  return file;
}

std::string first_failure(const oracles::VerifyReport& report) {
  for (const auto& oracle : report.oracles) {
    if (!oracle.findings.empty()) return oracle.name + ": " + oracle.findings[0];
  }
  return "verdict: " + std::string(oracles::verdict_name(report.verdict));
}

Finding verified(const Surface& surface, const Result& result, Stage stage,
                 const Options& options) {
  const oracles::Polyhedron input = {surface.vertices, surface.triangles, surface.labels, {}};
  oracles::VerifyOptions wanted;
  wanted.stage = stage;
  wanted.delta = options.delta;
  wanted.scope = options.region == delmesher::Region::hull ? oracles::AngleScope::all
                                                           : oracles::AngleScope::solid;
  wanted.declared_deviation = 1e-9;
  oracles::VerifyReport report;
  const std::string refusal =
      oracles::verify(input, as_file(result.mesh), &result.exact, wanted, report);
  if (!refusal.empty()) return "oracles refuse: " + refusal;
  bool violated = false;
  for (const auto& oracle : report.oracles) violated = violated || oracle.violations > 0;
  // An oracle that had nothing to look at (no facet left by the filter, say) makes the verdict of
  // the refined stage "broken", but is no finding.
  if (violated || (stage == Stage::final && oracles::failed(report, wanted))) {
    return std::string(stage == Stage::refined ? "refined " : "final ") + first_failure(report);
  }
  return {};
}

// Are doubles fine enough for the surface? Its features are thousands of roundings apart.
bool roomy(const Surface& surface) {
  double largest = 0;
  for (const auto& p : surface.vertices) {
    for (const double x : p) largest = std::max(largest, std::fabs(x));
  }
  return delmesher::check_surface(surface).smallest_local_feature_size > largest * 0x1p-40;
}

Finding judged(const Surface& surface, const Result& result, const Options& options, bool refined) {
  switch (result.status.code) {
    case StatusCode::ok:
      break;
    case StatusCode::limit_reached:
      return {};
    default:
      return "status: " + result.status.message;
  }
  if (result.statistics.rounding_inverted + result.statistics.rounding_flat > 0) {
    // The contract: where parts of the surface are hardly more than roundings apart, it may happen,
    // and is said.
    return roomy(surface) ? "rounding: inverted or flat tetrahedra are left" : "";
  }
  if (refined) {
    if (Finding f = verified(surface, result, Stage::refined, options); !f.empty()) return f;
  }
  return verified(surface, result, Stage::final, options);
}

// Options vary with the surface, so that the same bytes always mean the same run.
Options options_for(const Surface& surface) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const auto& t : surface.triangles) {
    for (const auto v : t) hash = (hash ^ v) * 0x100000001b3ULL;
  }
  hash ^= hash >> 29;
  Options options;
  options.want_exact = true;
  options.max_vertices = kMostVertices;
  options.acute = (hash & 1) != 0 ? 60 : 90;
  options.slivers = (hash & 2) != 0;
  options.tau = (hash & 4) != 0 ? 1e-4 : 1e-2;
  options.region = (hash & 24) == 0 ? delmesher::Region::hull : delmesher::Region::interior;
  options.simplify_bridges = (hash & 96) != 0;
  return options;
}

}  // namespace

Finding cdt_holds(const Surface& surface) {
  Options options;
  options.want_exact = true;
  options.max_vertices = kMostVertices;
  const Result result = delmesher::constrained_delaunay(surface, options);
  return judged(surface, result, options, false);
}

Finding refinement_holds(const Surface& surface) {
  Options options = options_for(surface);
  options.approximate = true;
  const Result result = delmesher::tetrahedralize(surface, options);
  if (result.status.code == StatusCode::limit_reached) return {};
  if (!result.status.ok()) return "status: " + result.status.message;
  return verified(surface, result, Stage::refined, options);
}

Finding pipeline_holds(const Surface& surface) {
  const Options options = options_for(surface);
  return judged(surface, delmesher::tetrahedralize(surface, options), options, true);
}

}  // namespace tetproof::fuzz
