// Checks a surface without meshing it: its validity, its facets and how hard it is to mesh.
#include "mesher/base/control.h"
#include "mesher/base/guarded.h"
#include "mesher/chamfer/chamfer.h"
#include "mesher/delmesher.h"
#include "mesher/policies/fallback.h"
#include "mesher/policies/planar_bound.h"
#include "mesher/surface/feature_size.h"
#include "mesher/surface/planar_groups.h"
#include "mesher/surface/topology.h"
#include "mesher/surface/validity.h"

namespace delmesher {
namespace {

// As in the other drivers: policies see the shared folders.
using namespace policies;  // NOLINT(google-build-using-namespace)

}  // namespace

SurfaceReport check_surface(const Surface& surface, const Options& options) {
  SurfaceReport report;
  Control control(options);
  const Status status = guarded(control, [&]() -> Status {
    control.enter(Phase::check);
    ValidityResult validity = check_validity(surface, false, control);
    report = std::move(validity.report);
    if (!report.status.ok()) return report.status;
    PointStore points;
    Predicates predicates(points);
    const Surface outwards = oriented_outwards(surface, validity);
    report.planar_bound = planar_bound(outwards, options, report.bbox_diagonal);
    const StandIn stand_in = find_stand_in(outwards, report.planar_bound, control);
    const SurfaceTopology topology = build_topology(outwards, points, predicates, stand_in);
    report.planar_facets = topology.facet_triangles.size();
    report.facets = stand_in.planes.empty() ? report.planar_facets : stand_in.given_facets;
    report.smallest_local_feature_size = smallest_local_feature_size(topology, points, control);
    const chamfer::AcuteCount acute =
        chamfer::count_acute(topology, points, predicates, chamfer_options(options), control);
    report.acute_vertices = acute.vertices;
    report.acute_edges = acute.edges;
    return {};
  });
  report.status = status;
  return report;
}

}  // namespace delmesher
