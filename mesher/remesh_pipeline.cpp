// Another surface within a tolerance, without a mesh.
#include <utility>

#include "mesher/base/guarded.h"
#include "mesher/delmesher.h"
#include "mesher/remesh/remesh.h"
#include "mesher/results/units.h"
#include "mesher/run/options.h"

namespace delmesher {
namespace {

// As in the other drivers: policies see the shared folders.
using namespace policies;  // NOLINT(google-build-using-namespace)

RemeshResult run_remeshing(const Surface& surface, const RemeshOptions& options) {
  RemeshResult result;
  Control control(options);
  result.status = guarded(control, [&]() -> Status {
    if (std::string defect = options_defect(options); !defect.empty()) {
      return {StatusCode::invalid_options, std::move(defect)};
    }
    remesh::Remeshed remeshed = remesh::remesh(surface, remesh::goals_of(options), {}, control);
    result.warnings = std::move(remeshed.warnings);
    result.surface = std::move(remeshed.surface);
    result.tolerance = remeshed.tolerance;
    return remeshed.status;
  });
  if (!result.status.ok()) result.surface = {};
  return result;
}

}  // namespace

RemeshResult remesh_surface(const Surface& surface, const RemeshOptions& given) {
  RemeshOptions options = given;
  options.max_edge = bound_on_edges(given);
  return in_ordinary_units(surface, options, run_remeshing);
}

}  // namespace delmesher
