// Policy: a mesh of the planarized surface that finds no way back to the surface as given.
#pragma once

#include "mesher/cdt/cdt.h"
#include "mesher/planar/planar.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// The constrained Delaunay tetrahedrization of the surface as given, with vertices of the mesh
// (enrich::input_as_given). The session is one of the surface as given from now on.
cdt::CdtResult tetrahedrize_as_given(const ConformingMesh& mesh, SurfaceAsGiven returned,
                                     Session& session);

}  // namespace delmesher::policies
