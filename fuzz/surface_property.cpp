#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "corpus/generate/certify.h"
#include "fuzz/properties.h"
#include "fuzz/stages.h"
#include "mesher/surface/feature_size.h"
#include "oracles/input_surface.h"

namespace tetproof::fuzz {
namespace {

using delmesher::Defect;
using delmesher::Surface;

// Facets as sets of triangles, by our topology and by the oracles'.
using Partition = std::set<std::vector<std::uint32_t>>;

Partition our_facets(const delmesher::SurfaceTopology& topology) {
  return {topology.facet_triangles.begin(), topology.facet_triangles.end()};
}

Partition oracle_facets(const oracles::InputSurface& surface) {
  std::vector<std::vector<std::uint32_t>> groups(surface.facets().size());
  for (std::uint32_t t = 0; t < surface.facet_of_triangle().size(); ++t) {
    groups[surface.facet_of_triangle()[t]].push_back(t);
  }
  return {groups.begin(), groups.end()};
}

using Carrier = std::set<std::uint32_t>;  // vertices of an element

bool disjoint(const Carrier& a, const Carrier& b) {
  return std::none_of(a.begin(), a.end(), [&](std::uint32_t v) { return b.count(v) != 0; });
}

// The definition, over all pairs of triangles: facets share a point if they share a vertex.
double smallest_distance(const delmesher::SurfaceTopology& topology,
                         const delmesher::PointStore& points) {
  std::vector<Carrier> facet(topology.facet_triangles.size());
  for (std::uint32_t t = 0; t < topology.triangles.size(); ++t) {
    const auto& corners = topology.triangles[t];
    facet[topology.facet_of[t]].insert(corners.begin(), corners.end());
  }
  const auto corners = [&](std::uint32_t t) {
    const auto& c = topology.triangles[t];
    return std::array<delmesher::Vec3, 3>{points.nearest(c[0]), points.nearest(c[1]),
                                          points.nearest(c[2])};
  };
  double smallest = std::numeric_limits<double>::infinity();
  for (std::uint32_t s = 0; s < topology.triangles.size(); ++s) {
    for (std::uint32_t t = 0; t < s; ++t) {
      if (!disjoint(facet[topology.facet_of[s]], facet[topology.facet_of[t]])) continue;
      smallest = std::min(smallest, delmesher::triangle_triangle_distance(corners(s), corners(t)));
    }
  }
  return smallest;
}

// The volume of a valid surface is that of the oracles, who look on their own which components are
// cavities.
Finding volume_agrees(const Surface& surface, double ours) {
  oracles::ExactPoints points;
  oracles::InputSurface judge;
  const oracles::Polyhedron polyhedron = {surface.vertices, surface.triangles, surface.labels, {}};
  if (!points.assign(surface.vertices).empty() || !judge.assign(polyhedron, points).empty()) {
    return "check input: the oracles cannot read a valid surface";
  }
  const double theirs = oracles::to_double(judge.volume6(), 3 * points.exponent()) / 6;
  const double box = std::pow(judge.diagonal(), 3);
  if (!std::isfinite(box) || std::fabs(ours - theirs) <= 1e-9 * theirs + 1e-12 * box) return {};
  return "check volume: ours " + std::to_string(ours) + ", oracles " + std::to_string(theirs);
}

}  // namespace

Finding check_agrees(const Surface& surface) {
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
  if (defect && report.defect_counts[static_cast<std::size_t>(*defect)] == 0 &&
      *defect != Defect::Kind::inconsistent_orientation) {
    return std::string("check reason: ours does not count any ") + delmesher::defect_name(*defect) +
           " but says " + report.status.message;
  }
  return ours ? volume_agrees(surface, report.volume) : "";
}

Finding features_agree(const Surface& surface) {
  Stages stages(surface);
  oracles::ExactPoints points;
  oracles::InputSurface judge;
  const oracles::Polyhedron polyhedron = {surface.vertices, surface.triangles, surface.labels, {}};
  if (!points.assign(surface.vertices).empty() || !judge.assign(polyhedron, points).empty()) {
    return "features input: the oracles cannot read a valid surface";
  }
  if (our_facets(stages.topology) != oracle_facets(judge)) return "features facets: differ";
  const double ours =
      delmesher::smallest_local_feature_size(stages.topology, stages.points, stages.control);
  const double facets = smallest_distance(stages.topology, stages.points);
  double largest = 0;
  for (const auto& p : surface.vertices) {
    for (const double x : p) largest = std::max(largest, std::fabs(x));
  }
  // Elements of touching facets count as well, so ours is at most the distance of the facets, up to
  // the rounding of coordinates.
  if (!(ours <= facets * (1 + 1e-9) + largest * 0x1p-48)) {
    return "features size: ours " + std::to_string(ours) + ", facets are " +
           std::to_string(facets) + " apart";
  }
  return {};
}

}  // namespace tetproof::fuzz
