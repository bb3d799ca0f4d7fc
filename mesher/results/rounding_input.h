// From the exact meshes of the stages to the mesh that is rounded and written.
#pragma once

#include "mesher/chamfer/chamfer.h"
#include "mesher/output/rounding.h"
#include "mesher/refine/refine.h"
#include "mesher/run/session.h"

namespace delmesher::results {

// All tetrahedra of the mesh are written. Where vertices were moved so that facets are planar,
// points on the surface are placed again on the given ones, with the same parameters.
output::RoundingInput rounding_input(ConformingMesh mesh, const Session& session);

// The part of the refined mesh itself that is written; its boundary is the part of the surface that
// was neither chamfered nor filtered.
ConformingMesh refined_part(const chamfer::ChamferResult& chamfered,
                            const refine::RefineResult& refined, Region region);

}  // namespace delmesher::results
