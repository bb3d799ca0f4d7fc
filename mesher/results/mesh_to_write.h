// From the exact meshes of the stages to the mesh that is rounded and written.
#pragma once

#include <vector>

#include "mesher/cdt/cdt.h"
#include "mesher/chamfer/chamfer.h"
#include "mesher/output/rounding.h"
#include "mesher/refine/refine.h"
#include "mesher/run/session.h"

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

// Where vertices were moved so that facets are planar, points on the surface are placed anew on the
// given ones, with the same parameters.
MeshToWrite conforming_mesh(const cdt::CdtResult& cdt, const Session& session);

// The refined mesh itself; its boundary is the part of the surface that was neither chamfered nor
// filtered.
MeshToWrite approximate_mesh(const chamfer::ChamferResult& chamfered,
                             const refine::RefineResult& refined, const Session& session);

}  // namespace delmesher::results
