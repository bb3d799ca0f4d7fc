#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include "corpus/generators/certify.h"
#include "fuzz/feature_size.h"
#include "fuzz/properties.h"
#include "fuzz/stages.h"
#include "mesher/surface/feature_size.h"
#include "oracles/surface/input_surface.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
namespace {

using delmesher::Defect;
using delmesher::Surface;

// Facets as sets of triangles, by our topology and by the oracles'.
using Partition = std::set<std::vector<std::uint32_t>>;

Partition our_facets(const delmesher::surface::SurfaceTopology& topology) {
  return {topology.facet_triangles.begin(), topology.facet_triangles.end()};
}

Partition oracle_facets(const oracles::InputSurface& surface) {
  std::vector<std::vector<std::uint32_t>> groups(surface.facets().size());
  for (std::uint32_t t = 0; t < surface.facet_of_triangle().size(); ++t) {
    groups[surface.facet_of_triangle()[t]].push_back(t);
  }
  return {groups.begin(), groups.end()};
}

Leniency no_volume("volume-is-no-double", 0.1);
Leniency not_counted("turned-named-otherwise", 0.3);
Leniency within_roundings("feature-size-4-to-16-ulp-off", 0.02);

// The volume of a valid surface is that of the oracles, which decide on their own which components
// are cavities.
Finding volume_agrees(const Surface& surface, double ours) {
  oracles::ExactPoints points;
  oracles::InputSurface judge;
  const oracles::Polyhedron polyhedron = {surface.vertices, surface.triangles, surface.labels, {}};
  if (!points.assign(surface.vertices).empty() || !judge.assign(polyhedron, points).empty()) {
    return "check input: the oracles cannot read a valid surface";
  }
  const double theirs = judge.volume6().value(3 * points.exponent()) / 6;
  const double box = std::pow(judge.diagonal(), 3);
  if (!std::isfinite(box)) {
    no_volume.take();
    return {};
  }
  // Ours is a sum in doubles of a term per triangle, each at most the box. Rounding may lose so
  // much.
  const auto terms = static_cast<double>(surface.triangles.size());
  const double lost = terms * (terms + 32) * 0x1p-52 * box;
  if (std::fabs(ours - theirs) <= lost + 4 * std::numeric_limits<double>::denorm_min()) return {};
  std::ostringstream out;
  out << "check volume: ours " << ours << ", oracles " << theirs;
  return out.str();
}

}  // namespace

Finding check_agrees(const Surface& surface) {
  judging({&no_volume, &not_counted});
  const auto report = delmesher::check_surface(surface);
  const auto defect = first_defect(surface);
  const bool ours = report.status.ok();
  if (report.status.code != delmesher::StatusCode::ok &&
      report.status.code != delmesher::StatusCode::invalid_surface) {
    return "check fails: " + report.status.message;
  }
  if (ours == defect.has_value()) {
    return std::string("check validity: ours says ") + (ours ? "valid" : report.status.message) +
           ", CGAL " + (defect ? delmesher::defect_name(*defect) : "valid");
  }
  if (defect && report.defect_counts[static_cast<std::size_t>(*defect)] == 0) {
    if (*defect != Defect::Kind::inconsistent_orientation) {
      return std::string("check reason: ours does not count any ") +
             delmesher::defect_name(*defect) + " but says " + report.status.message;
    }
    not_counted.take();
  }
  return ours ? volume_agrees(surface, report.volume) : "";
}

Finding features_agree(const Surface& surface) {
  judging({&within_roundings});
  Stages stages(surface);
  FeatureSizes sizes;
  if (!sizes.assign(surface).empty()) return "features input: the oracles cannot read it";
  if (our_facets(stages.topology) != oracle_facets(sizes.surface())) {
    return "features facets: differ";
  }
  const double ours = delmesher::surface::smallest_local_feature_size(
      stages.topology, stages.points, stages.control);
  const double theirs = sizes.smallest(), largest = sizes.largest_coordinate();
  // Ours is measured in doubles.
  const double off = std::fabs(ours - theirs);
  if (!(off <= largest * 0x1p-48)) {
    std::ostringstream out;
    out << "features size: ours " << ours << ", oracles " << theirs;
    return out.str();
  }
  if (off > largest * 0x1p-50) within_roundings.take();
  return {};
}

}  // namespace tetproof::fuzz
