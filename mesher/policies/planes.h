// Policy: how long near-coplanar triangles lie in exactly one plane (Options::planar), and the
// surface that the stages see.
#pragma once

#include "mesher/run/session.h"
#include "mesher/surface/planar_groups.h"
#include "mesher/surface/validity.h"

namespace delmesher::policies {

// Never, only until the refined mesh is put back onto the surface as given, or to the end.
enum class Planes : std::uint8_t { none, while_refined, to_the_end };

struct PlanarSurface {
  StandIn stand_in;
  double bound;  // of its facets (planar_bound)
};

// Gives the session the surface, which is valid, has the session's diagonal, and is meant to be
// meshed with the session's options: its points and its topology, oriented outwards, with
// near-coplanar triangles in one plane where that is asked for, and then the vertices as given.
PlanarSurface enter_surface(const Surface& surface, const ValidityResult& validity, Planes planes,
                            Session& s);

}  // namespace delmesher::policies
