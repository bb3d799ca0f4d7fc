// What meshing costs, in units that neither a clock nor a machine decides.
#include "fuzz/properties.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
namespace {

Leniency stopped("stopped-by-a-limit", 0.4);

// A run that would take more vertices ends there, and its cost is not judged: a campaign is not the
// place for large meshes.
constexpr std::uint64_t kMostVertices = 20000;

// Work of a run, about 0.14 microseconds each: predicates by the stage that decided them, signs of
// rounded tetrahedra, and calls of the progress callback, one of which stands for 64 rounds of the
// long loops. The weights were chosen so that the quotient of time and work spreads least.
double work_of(const delmesher::Statistics& s, std::uint64_t callbacks) {
  const auto number = [](std::uint64_t n) { return static_cast<double>(n); };
  return number(s.predicate_filter + s.predicate_by_support) + 8 * number(s.predicate_extended) +
         60 * number(s.predicate_exact) + 0.5 * number(s.rounding_signs) + 100 * number(callbacks);
}

// The median, over 306 surfaces (members of all families, and of a campaign of this target), of the
// work per triangle of the input and tetrahedron of the result; and how far above it is a finding.
constexpr double kMedian = 391;
constexpr double kMost = 20;

}  // namespace

Finding complexity_holds(const delmesher::Surface& surface) {
  judging({&stopped});
  std::uint64_t callbacks = 0;
  delmesher::Options options;
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
  const double size = static_cast<double>(surface.triangles.size() + result.mesh.tetrahedra.size());
  const double share = work_of(result.statistics, callbacks) / size / kMedian;
  if (share <= kMost) return {};
  return "complexity: " + std::to_string(share) + " times the median work";
}

}  // namespace tetproof::fuzz
