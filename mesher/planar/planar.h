// Facets that are planar except for rounding (Options::planar): the door to this folder. What is
// made of them is the planarized surface (planarized_surface.h); its owner in a run is
// Session::surface.
#pragma once

#include "mesher/planar/planarized_surface.h"
#include "mesher/run/session.h"
#include "mesher/surface/validity.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::planar {

// How long near-coplanar triangles lie in exactly one plane. none: never. while_refined: until the
// final mesh goes back to the surface as given, after it has been improved once. to_the_end: in the
// final mesh, too.
enum class Planes : std::uint8_t { none, while_refined, to_the_end };

// Will the final mesh have to go back? It will with --planar 0, unless nothing is improved or the
// run is approximate: then nothing is planarized.
bool goes_back(const Options& options);

// Fills the session's points and topology with the surface, oriented outwards, and planarized if
// `planes` and the options ask for it. The surface has to be valid, and the session has to know its
// diagonal.
PlanarizedSurface enter_surface(const Surface& surface, const ValidityResult& validity,
                                Planes planes, Session& session);

// The surface as given, whose triangles are those of the session's planarized surface, and its
// vertices, with supports.
struct SurfaceAsGiven {
  SurfaceTopology topology;
  PointStore points;
};
SurfaceAsGiven as_given(const Session& session);

// From now on the session is one of the surface as given, and `points` are the session's, by the
// same definitions and numbers, on its vertices.
void return_to(SurfaceAsGiven as_given, Session& session);

// The same for a mesh whose faces have the facets of the surface as given, if, by exact signs, all
// tetrahedra are positive on that surface and every face is on its facet. Otherwise nothing changes
// and the result is false.
bool go_back(const ConformingMesh& mesh, SurfaceAsGiven& as_given, Session& session);

}  // namespace delmesher::planar
