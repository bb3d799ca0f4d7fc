// Checks a surface without meshing it: its validity, its facets and how hard it is to mesh.
#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "mesher/base/control.h"
#include "mesher/base/guarded.h"
#include "mesher/cdt/cdt.h"
#include "mesher/chamfer/chamfer.h"
#include "mesher/delmesher.h"
#include "mesher/delmesher/option_table.h"
#include "mesher/enrich/enrichment.h"
#include "mesher/planar/planar.h"
#include "mesher/policies/fallback.h"
#include "mesher/results/region_list.h"
#include "mesher/results/region_points.h"
#include "mesher/run/options.h"
#include "mesher/run/session.h"
#include "mesher/surface/complex.h"
#include "mesher/surface/feature_size.h"
#include "mesher/surface/validity.h"

namespace delmesher {
namespace {

// As in the other drivers: policies see the shared folders.
using namespace policies;  // NOLINT(google-build-using-namespace)

// Bodies of several labels, or something that is no solid: but nothing that no complex has, nor an
// open surface alone. That several bodies of one label are apart costs too much to find out.
// Without repetitions the surface is a valid complex then.
bool may_have_regions(const Surface& surface, const SurfaceReport& report) {
  using Kind = Defect::Kind;
  constexpr Kind kOfNoComplex[] = {Kind::non_finite, Kind::index_out_of_range, Kind::empty,
                                   Kind::degenerate_triangle, Kind::self_intersection};
  const auto count = [&](Kind kind) {
    return report.defect_counts[static_cast<std::size_t>(kind)];
  };
  if (std::ranges::any_of(kOfNoComplex, [&](Kind kind) { return count(kind) > 0; })) return false;
  const bool several =
      std::ranges::adjacent_find(surface.labels, std::not_equal_to()) != surface.labels.end();
  return count(Kind::non_manifold_edge) > 0 || count(Kind::non_manifold_vertex) > 0 ||
         (several && (report.components > 1 || count(Kind::open_edge) > 0));
}

// By the constrained tetrahedrization.
ComplexReport find_regions(const Surface& surface, const Options& options, Control& control,
                           std::vector<std::string>& warnings) {
  const MergedSurface merged = merge_repeated(surface);
  Session s(options, control);
  const SurfaceTopology topology = with_facet_per_triangle(
      build_topology(merged.surface, s.points, s.predicates, Rules::complex));
  if (topology.plane_count == 1) return {};
  cdt::CdtInput input = enrich::plain_input(topology);
  input.partition = cdt::Partition::regions;
  cdt::CdtResult cdt =
      cdt::constrained_delaunay_tetrahedrization(input, s.points, s.predicates, control);
  ComplexReport report = list_regions(merged, s.points, cdt.mesh).report;
  const Status entered =
      enter_region_points(options.region_points, cdt.mesh, s.points, report.regions, warnings);
  if (!entered.ok()) warnings.push_back(entered.message);
  return report;
}

// Of a valid surface: its facets, and how hard it is to mesh.
void look_at_facets(const Surface& surface, const ValidityResult& validity, const Options& options,
                    Control& control, SurfaceReport& report) {
  Session s(options, control);
  s.diagonal = report.bbox_diagonal;
  const PlanarizedSurface planarized = enter_surface(surface, validity, Planes::to_the_end, s);
  report.planar_bound = planarized.bound;
  report.planar_facets = s.surface.topology().facet_triangles.size();
  report.facets = planarized.planes.empty() ? report.planar_facets : planarized.given_facets;
  report.smallest_local_feature_size =
      smallest_local_feature_size(s.surface.topology(), s.points, control);
  const chamfer::AcuteCount acute = chamfer::count_acute(
      s.surface.topology(), s.points, s.predicates, chamfer_options(options), control);
  report.acute_vertices = acute.vertices;
  report.acute_edges = acute.edges;
}

}  // namespace

SurfaceReport check_surface(const Surface& surface, const CheckOptions& given) {
  SurfaceReport report;
  auto options = options::taken_from<Options>(given);
  options.region_points = given.region_points;
  Control control(options);
  const Status status = guarded(control, [&]() -> Status {
    if (std::string defect = options_defect(given); !defect.empty()) {
      return {StatusCode::invalid_options, std::move(defect)};
    }
    control.enter(Phase::check);
    ValidityResult validity = check_validity(surface, false, control);
    report = std::move(validity.report);
    Status found = report.status;
    if (found.ok()) look_at_facets(surface, validity, options, control, report);
    // Last: a limit that this meets leaves the others.
    if (given.want_regions && may_have_regions(surface, report)) {
      report.complex = find_regions(surface, options, control, report.warnings);
    }
    return found;
  });
  report.status = status;
  return report;
}

}  // namespace delmesher
