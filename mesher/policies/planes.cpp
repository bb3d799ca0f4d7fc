#include "mesher/policies/planes.h"

#include "mesher/policies/planar_bound.h"

namespace delmesher::policies {

namespace {

// How finely coordinates are written is seen in those that were given.
Surface given(const Surface& surface, const Session& s) {
  Surface result = surface;
  if (!s.frame.moved()) return result;
  for (Vec3& p : result.vertices) p = s.frame.given(p);
  return result;
}

}  // namespace

PlanarSurface enter_surface(const Surface& surface, const ValidityResult& validity, Planes planes,
                            Session& s) {
  const Surface outwards = oriented_outwards(surface, validity);
  Options options = s.options;
  if (planes == Planes::while_refined) options.planar = kPlanarAuto;
  const double bound =
      planes == Planes::none ? 0 : planar_bound(given(outwards, s), options, s.diagonal, s.control);
  StandIn stand_in =
      find_stand_in(outwards, bound, s.control,
                    planes == Planes::while_refined ? Retriangulate::no : Retriangulate::yes);
  if (!stand_in.planes.empty()) s.given = outwards.vertices;
  s.topology = build_topology(outwards, s.points, s.predicates, stand_in);
  return {std::move(stand_in), bound};
}

}  // namespace delmesher::policies
