// What meshing costs, in units that neither a clock nor a machine decides.
#include "fuzz/properties.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
namespace {

Leniency stopped("stopped-by-a-limit", 0.4);
// Most of what was refined is not written: doubles do not tell its points apart, which only
// rounding, the last step, can know, or the mesh of the input alone is better. So the run is judged
// by the tetrahedra made.
Leniency few_written("few-of-those-made-are-written", 0.05);

// A run that would take more vertices ends there, and its cost is not judged: a campaign is not the
// place for large meshes.
constexpr std::uint64_t kMostVertices = 20000;

// Work of a run, about 0.17 microseconds each: predicates by the stage that decided them, signs of
// rounded tetrahedra, and calls of the progress callback, one of which stands for 64 rounds of the
// long loops. The weights were chosen so that the quotient of time and work spreads least: over the
// 221 of the surfaces below that take 4 ms or more, its logarithm has a standard deviation of 0.26.
double work_of(const delmesher::Statistics& s, std::uint64_t callbacks) {
  const auto number = [](std::uint64_t n) { return static_cast<double>(n); };
  return number(s.predicate_filter + s.predicate_by_support) +
         8 * number(s.predicate_extended + s.predicate_fixed) + 60 * number(s.predicate_exact) +
         0.25 * number(s.rounding_signs) + 200 * number(callbacks);
}

// The median, over 242 surfaces (members of all families, and findings of campaigns), of the work
// per triangle of the input and tetrahedron of the result; and how far above it is a finding.
constexpr double kMedian = 435;
constexpr double kMost = 20;

}  // namespace

Finding complexity_holds(const delmesher::Surface& surface) {
  judging({&stopped, &few_written});
  std::uint64_t callbacks = 0;
  delmesher::Options options;
  // A refinement that was given up for a kept surface would count without its tetrahedra.
  options.surface = delmesher::SurfaceChoice::split;
  options.max_vertices = kMostVertices;
  options.progress = [&](const delmesher::Progress&) { return ++callbacks > 0; };
  const delmesher::Result result = delmesher::tetrahedralize(surface, options);
  if (!result.status.ok()) {
    if (result.status.code != delmesher::StatusCode::limit_reached) {
      return "complexity status: " + result.status.message;
    }
    stopped.take();
    return {};
  }
  const delmesher::Statistics& s = result.statistics;
  const double work = work_of(s, callbacks);
  const auto times_median = [&](std::uint64_t tetrahedra) {
    return work / static_cast<double>(surface.triangles.size() + tetrahedra) / kMedian;
  };
  const double share = times_median(result.mesh.tetrahedra.size());
  if (share <= kMost) return {};
  if ((s.rounding_thinned > 0 || !s.enriched) && times_median(s.refined.tetrahedra) <= kMost) {
    few_written.take();
    return {};
  }
  return "complexity: " + std::to_string(share) + " times the median work";
}

}  // namespace tetproof::fuzz
