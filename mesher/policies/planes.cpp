#include "mesher/policies/planes.h"

#include <utility>

#include "mesher/policies/planar_bound.h"

namespace delmesher::policies {

namespace {

Surface in_given_coordinates(const Surface& surface, const Session& s) {
  Surface result = surface;
  for (Vec3& p : result.vertices) p = s.frame.given(p);
  return result;
}

}  // namespace

PlanarSurface enter_surface(const Surface& surface, const ValidityResult& validity, Planes planes,
                            Session& s) {
  const Surface outwards = oriented_outwards(surface, validity);
  Options options = s.options;
  if (planes == Planes::while_refined) options.planar = kPlanarAuto;
  const auto bound_of = [&](const Surface& seen) {
    return planar_bound(seen, options, s.diagonal, s.control);
  };
  double bound = 0;
  if (planes != Planes::none) {
    // How finely coordinates are written is seen in those that were given.
    bound = s.frame.moved() ? bound_of(in_given_coordinates(outwards, s)) : bound_of(outwards);
  }
  StandIn stand_in =
      find_stand_in(outwards, bound, s.control,
                    planes == Planes::while_refined ? Retriangulate::no : Retriangulate::yes);
  SurfaceTopology topology = build_topology(outwards, s.points, s.predicates, stand_in);
  if (stand_in.planes.empty()) {
    s.surface.enter_given(std::move(topology));
  } else {
    s.surface.enter_planarized(std::move(topology), outwards.vertices);
  }
  return {std::move(stand_in), bound};
}

}  // namespace delmesher::policies
