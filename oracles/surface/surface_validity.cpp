#include "oracles/surface/surface_validity.h"

#include <algorithm>

#include "oracles/cgal/surface_opinion.h"

namespace tetproof::oracles {

OracleReport check_surface_validity(const Polyhedron& surface) {
  OracleReport report("input", "triangles");
  report.checked = surface.triangles.size();
  std::vector<Index> polygons = surface.polygons;
  std::sort(polygons.begin(), polygons.end());
  const bool fans = std::adjacent_find(polygons.begin(), polygons.end()) != polygons.end();
  const SurfaceOpinion cgal = cgal_surface_opinion(surface, {.intersections = !fans});
  if (fans) report.notes.push_back("intersections are not looked for: a face is not simple");
  const bool valid = cgal.manifold && cgal.closed && (fans || cgal.free_of_intersections);
  if (!valid) report.fail("CGAL: " + cgal.reason);
  const SurfaceOpinion openmesh = openmesh_surface_opinion(surface);
  if (!openmesh.valid()) report.fail("OpenMesh: " + openmesh.reason);
  return report;
}

OracleReport check_complex_validity(const Polyhedron& complex) {
  OracleReport report("input", "triangles");
  report.checked = complex.triangles.size();
  if (const std::string reason = cgal_complex_defect(complex); !reason.empty()) {
    report.fail("CGAL: " + reason);
  }
  return report;
}

}  // namespace tetproof::oracles
