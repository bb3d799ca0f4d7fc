// Checks a surface without meshing it: its validity, its facets and how hard it is to mesh.
#include <string>
#include <utility>

#include "mesher/base/control.h"
#include "mesher/base/guarded.h"
#include "mesher/chamfer/chamfer.h"
#include "mesher/delmesher.h"
#include "mesher/delmesher/option_table.h"
#include "mesher/planar/planar.h"
#include "mesher/policies/fallback.h"
#include "mesher/run/options.h"
#include "mesher/run/session.h"
#include "mesher/surface/feature_size.h"
#include "mesher/surface/validity.h"

namespace delmesher {
namespace {

// As in the other drivers: policies see the shared folders.
using namespace policies;  // NOLINT(google-build-using-namespace)

}  // namespace

SurfaceReport check_surface(const Surface& surface, const CheckOptions& given) {
  SurfaceReport report;
  const auto options = options::taken_from<Options>(given);
  Control control(options);
  const Status status = guarded(control, [&]() -> Status {
    if (std::string defect = options_defect(given); !defect.empty()) {
      return {StatusCode::invalid_options, std::move(defect)};
    }
    control.enter(Phase::check);
    ValidityResult validity = check_validity(surface, false, control);
    report = std::move(validity.report);
    if (!report.status.ok()) return report.status;
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
    return {};
  });
  report.status = status;
  return report;
}

}  // namespace delmesher
