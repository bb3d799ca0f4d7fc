// Policy: how long near-coplanar triangles lie in exactly one plane (Options::planar), and the
// surface that the stages see.
#pragma once

#include "mesher/run/session.h"
#include "mesher/surface/planar_groups.h"
#include "mesher/surface/validity.h"

namespace delmesher::policies {

// none: never. while_refined: until the final mesh goes back to the surface as given, after it has
// been improved once. to_the_end: in the final mesh, too.
enum class Planes : std::uint8_t { none, while_refined, to_the_end };

struct PlanarSurface {
  StandIn stand_in;
  double bound;  // of its facets (planar_bound)
};

// Fills the session's points and topology with the surface, oriented outwards. If `planes` and the
// options ask for it, near-coplanar triangles lie in one plane there; the session then keeps the
// vertices as given, too. The surface has to be valid, and the session has to know its diagonal.
PlanarSurface enter_surface(const Surface& surface, const ValidityResult& validity, Planes planes,
                            Session& s);

}  // namespace delmesher::policies
