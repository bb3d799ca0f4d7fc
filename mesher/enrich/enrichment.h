// The input of the last step: the input surface, with the vertices of the refined mesh
// (section 6).
#pragma once

#include "mesher/cdt/cdt.h"
#include "mesher/chamfer/filter.h"
#include "mesher/refine/refine.h"

namespace delmesher::enrich {

// The input surface alone.
cdt::CdtInput plain_input(const SurfaceTopology& topology);
// With the vertices that it has beside its triangles (loose_points.h), as the other ones.
cdt::CdtInput plain_input(const SurfaceTopology& topology, const PointStore& points,
                          Predicates& predicates);

// The input surface with the vertices of the refined mesh, but without the points on artificial
// segments, volume vertices too near to removed parts of the surface (RemovedSurface), and points
// that coincide with input vertices. `keep_all`: leaves out only the volume vertices inside
// chamfers or within 2^-20 of that distance from dropped facets, and the points that coincide.
cdt::CdtInput enriched_input(const chamfer::ChamferResult& chamfered,
                             const std::vector<std::uint8_t>& facet_kept,
                             const refine::RefineResult& refined, const SurfaceTopology& topology,
                             const PointStore& points, Predicates& predicates, bool keep_all,
                             Control& control);

// The surface as given, with vertices of a mesh of one that has the same triangles and vertices
// within half of `reach`: those on edges that are not flat, and those in the volume farther than
// `reach` from the surface. `points` has the points of the mesh by their definitions, with the
// vertices as given; points on edges get supports.
cdt::CdtInput input_as_given(const ConformingMesh& mesh, const SurfaceTopology& as_given,
                             double reach, PointStore& points, Predicates& predicates,
                             Control& control);

}  // namespace delmesher::enrich
