// The oracles on the refined mesh of the record.
#include <algorithm>

#include "oracles/mesh/delaunay.h"
#include "oracles/mesh/hull.h"
#include "oracles/mesh/places.h"
#include "oracles/record/chamfer.h"
#include "oracles/record/enrichment.h"
#include "oracles/record/filter.h"
#include "oracles/record/refinement.h"
#include "oracles/verdict/edge_sizes.h"
#include "oracles/verification.h"

namespace tetproof::oracles {

std::string Verification::check_refined_complex() {
  if (!shared_.sidecar().usable) return {};
  const auto& [complex, neighbours, shape, places] = shared_.refined();
  add(shape, "refined-");
  if (!shape.passed()) return {};
  OracleReport orientation = check_orientation(complex);
  OracleReport delaunay = check_delaunay(complex, neighbours);
  if (orientation.passed() && delaunay.passed()) shared_.tell_refined_is_delaunay();
  add(std::move(orientation), "refined-");
  add(check_hull(complex, neighbours), "refined-");
  add(std::move(delaunay), "refined-");
  return {};
}

std::string Verification::check_refined_angles() {
  if (!shared_.sidecar().usable || !shared_.refined().shape.passed()) return {};
  const auto& [complex, neighbours, shape, places] = shared_.refined();
  add(check_angles(complex, neighbours, *places, delta(), scope()), "refined-");
  return {};
}

std::string Verification::check_refined_inside() {
  if (!shared_.sidecar().usable || !shared_.refined().shape.passed()) return {};
  add(check_contained(shared_.refined().complex, *shared_.refined().places), "refined-");
  return {};
}

std::string Verification::check_refined_promises() {
  if (!shared_.sidecar().usable || !shared_.refined().shape.passed()) return {};
  check_promises(shared_.refined_mesh());
  return {};
}

void Verification::check_promises(const RefinedMesh& mesh) {
  add(check_refined_facets(mesh), "refined-");
  add(check_segments(mesh), "refined-");
  if (!exact_->segments.empty() || !exact_->refined_facets.empty()) {  // else check_promise fails
    add(check_encroachment(mesh), "refined-");
    add(check_chamfer_angles(mesh), "refined-");
  }
  add(check_balls(mesh), "refined-");
  add(check_chamfer_need(mesh), "refined-");
  if (!exact_->refined_facets.empty()) add(check_chamfer_cuts(mesh), "refined-");
  if (!exact_->chamfer_points.empty()) add(check_chamfer_extent(mesh), "refined-");
  const bool dropped = std::any_of(exact_->facets.begin(), exact_->facets.end(),
                                   [](const auto& facet) { return facet.filtered != 0; });
  // Without a tolerance nothing may have been dropped.
  if (options_.promised.tau > 0 || exact_->parameters.tolerance > 0 || dropped) {
    add(check_filter(mesh), "refined-");
  }
  if (options_.promised.max_edge > 0) add(check_edges(*mesh.complex), "refined-");
  if (!options_.promised.size_field.empty()) add(check_sizes(*mesh.complex), "refined-");
  if (!options_.promised.approximate) add(check_enrichment(mesh));
}

// No edge of a tetrahedron of the region measures more than this.
template <class Measure>
void Verification::check_edges(const TetComplex& complex, const std::string& option, double most,
                               const std::string& figure, const Measure& measure,
                               OracleReport& report) const {
  double largest = 0;
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    ++report.checked;  // there may be none in the region
    if (complex.inside[t] == 0 && scope() == AngleScope::solid) continue;
    const Tet& tet = complex.tetrahedra[t];
    double here = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) here = std::max(here, measure(tet[i], tet[j]));
    }
    largest = std::max(largest, here);
    if (here > most) report.fail(complex.tet_name(t) + " has an edge above " + option);
  }
  report.figures.emplace_back(figure, largest);
}

OracleReport Verification::check_edges(const TetComplex& complex) const {
  OracleReport report("edges", "tetrahedra");
  check_edges(
      complex, "--max-edge", options_.promised.max_edge * (1 + 1e-9), "longest edge",
      [&](Index v, Index w) { return exact::distance(*complex.points, v, w); }, report);
  return report;
}

OracleReport Verification::check_sizes(const TetComplex& complex) const {
  OracleReport report("sizes", "tetrahedra");
  const EdgeSizes sizes(options_.promised.size_field, options_.promised.size_growth);
  check_edges(
      complex, "--size-field", EdgeSizes::kMost, "largest edge over its size",
      [&](Index v, Index w) {
        return sizes.excess(complex.points->nearest(v), complex.points->nearest(w));
      },
      report);
  return report;
}

// A tetrahedron is called inside exactly if it is contained in the solid.
OracleReport Verification::check_contained(const TetComplex& complex, const Places& places) const {
  OracleReport contained("contained", "tetrahedra");
  std::uint64_t inside = 0;
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    const bool within = places.of(t) == Place::inside;
    ++contained.checked;
    inside += complex.inside[t];
    if (within == (complex.inside[t] != 0)) continue;
    contained.fail(complex.tet_name(t) +
                   (within ? " is contained in the solid but is not called inside"
                           : " is called inside but is not contained in the solid"));
  }
  contained.figures.emplace_back("called inside", static_cast<double>(inside));
  return contained;
}

}  // namespace tetproof::oracles
