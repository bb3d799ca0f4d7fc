// From the exact meshes of the stages to the mesh that is rounded and written.
#pragma once

#include <vector>

#include "mesher/cdt/cdt.h"
#include "mesher/chamfer/chamfer.h"
#include "mesher/output/rounding.h"
#include "mesher/refine/refine.h"

namespace delmesher::results {

struct MeshToWrite {
  output::RoundingInput rounding;
  std::vector<FacetId> facet_of_boundary;  // per face of rounding.boundary
  // Per tetrahedron: bit i if an earlier one has face i too. May be empty.
  std::vector<std::uint8_t> repeated_faces;
};

// Of the faces of a tetrahedron that earlier ones have too (RefineResult, CdtResult), those
// repeated within the region.
inline std::uint8_t repeated_within(Region region, std::uint8_t repeated) {
  return static_cast<std::uint8_t>(region == Region::interior ? repeated >> 4U : repeated & 15U);
}

// `given`: the vertices as given, where they were moved so that facets are planar; else empty.
// Points on the surface are placed anew on the given vertices, with the same parameters.
MeshToWrite conforming_mesh(const cdt::CdtResult& cdt, const SurfaceTopology& topology,
                            const PointStore& points, std::span<const Vec3> given, Region region);

// The refined mesh itself; its boundary is the part of the surface that was neither chamfered nor
// filtered.
MeshToWrite approximate_mesh(const chamfer::ChamferResult& chamfered,
                             const refine::RefineResult& refined, const SurfaceTopology& topology,
                             const PointStore& points, std::span<const Vec3> given, Region region);

}  // namespace delmesher::results
