// The input of the last step for a mesh of a stand-in (planar_groups.h) that is to become one of
// the surface as given: that surface, with the vertices of the mesh.
#pragma once

#include "mesher/cdt/cdt.h"

namespace delmesher::enrich {

// `mesh` is one of the surface `stand_in`, on points of the store `refined`. `points` holds the
// same points by the same numbers, but with the vertices of the surface `as_given`, whose triangles
// are the same; points that are placed again are appended, and all on the surface get supports.
//
// Inside a facet of the stand-in, a point that is nearer than a share of its spacing to an edge of
// the surface as given is put on it; the others are put inside a triangle as given, or left out if
// they would not be strictly inside its facet. Points in the volume that the vertices, when they go
// back, may have passed over are left out, and of points that coincide all but one.
cdt::CdtInput input_as_given(const ConformingMesh& mesh, const SurfaceTopology& stand_in,
                             const PointStore& refined, const SurfaceTopology& as_given,
                             PointStore& points, Predicates& predicates, Control& control);

}  // namespace delmesher::enrich
