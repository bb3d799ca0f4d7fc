#include "mesher/policies/as_given.h"

#include <algorithm>
#include <utility>

#include "mesher/enrich/enrichment.h"
#include "mesher/surface/given_place.h"

namespace delmesher::policies {

cdt::CdtResult tetrahedrize_as_given(const ConformingMesh& mesh, SurfaceAsGiven returned,
                                     Session& session) {
  append_as_given(session.points, session.surface.given_vertices(), returned.points);
  double farthest = 0;
  for (VertexId v = 0; v < session.input_vertices(); ++v) {
    farthest = std::max(farthest, distance(returned.points.nearest(v), session.points.nearest(v)));
  }
  // Factor 2 covers rounding errors with room to spare.
  const double reach = 2 * farthest + 0x1p-40 * session.diagonal;
  Predicates predicates(returned.points);
  cdt::CdtInput input = enrich::input_as_given(mesh, returned.topology, reach, returned.points,
                                               predicates, session.control);
  return_to(std::move(returned), session);
  input.topology = &session.surface.topology();
  return cdt::constrained_delaunay_tetrahedrization(input, session.points, session.predicates,
                                                    session.control);
}

}  // namespace delmesher::policies
