// Policy: with --planar 0, the surface as given to the last bit from a mesh of its stand-in.
#pragma once

#include "mesher/cdt/cdt.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// Is the surface refined as its stand-in, and the mesh put back onto the surface as given? It is
// with --planar 0, if there is an improvement afterwards.
bool goes_back(const Options& options);

// Of the surface as given, whose triangles are those of the session's stand-in.
SurfaceTopology topology_as_given(const Session& session);

// Moves the vertices of the surface to where they were given; all other points keep their
// definitions. The mesh has the facets of `as_given`. If exact signs say that all its tetrahedra
// are positive then, and that every face is on its facet, the session is one of the surface as
// given from now on, with the same numbers of points. Otherwise it is left as it is: false.
bool go_back(const cdt::CdtResult& mesh, SurfaceTopology as_given, Session& session);

// Where that fails: the constrained Delaunay tetrahedrization of the surface as given, with the
// vertices of a mesh of its stand-in (enrich/returning.h). The session is one of the surface as
// given from now on. New points are appended.
cdt::CdtResult tetrahedrize_as_given(const cdt::CdtResult& mesh, Session& session);

}  // namespace delmesher::policies
