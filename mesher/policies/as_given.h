// Policy: with --planar 0, a mesh of the stand-in becomes a mesh of the surface as given.
#pragma once

#include "mesher/cdt/cdt.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// Will the final mesh have to go back from the stand-in to the surface as given? It will with
// --planar 0, unless nothing is improved or the run is approximate: then there is no stand-in.
bool goes_back(const Options& options);

// Of the surface as given, whose triangles are those of the session's stand-in.
SurfaceTopology topology_as_given(const Session& session);

// Moves the vertices of the surface to where they were given; all other points keep their
// definitions and numbers. The faces of `mesh` have to have the facets of `as_given`. True if, by
// exact signs, all tetrahedra are then positive and every face is on its facet: the session's
// points and topology are those of the surface as given from now on. Otherwise nothing changes.
bool go_back(const ConformingMesh& mesh, SurfaceTopology as_given, Session& session);

// Where that fails: the constrained Delaunay tetrahedrization of the surface as given, with the
// vertices of a mesh of the planarized surface (enrich::input_as_given). The session is one of the
// surface as given from now on. New points are appended.
cdt::CdtResult tetrahedrize_as_given(const ConformingMesh& mesh, Session& session);

}  // namespace delmesher::policies
