// The contribution of each stage to the exact record (command-line option --exact). Point indices
// are ids of the store until record_points renumbers them.
#pragma once

#include "mesher/chamfer/filter.h"
#include "mesher/delmesher.h"
#include "mesher/output/rounding.h"
#include "mesher/refine/refine.h"
#include "mesher/results/in_force.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::results {

// `diagonal`: of the input's bounding box.
void record_parameters(const Options& options, const InForce& force, double diagonal, double planar,
                       ExactRecord& record);
// `filter` is null if nothing was filtered.
void record_facets(const SurfaceTopology& topology, const chamfer::FilterResult* filter,
                   ExactRecord& record);
void record_chamfer(const chamfer::ChamferResult& chamfered, ExactRecord& record);
void record_refined(const chamfer::ChamferResult& chamfered, const refine::RefineResult& refined,
                    const SurfaceTopology& topology, ExactRecord& record);
void record_final(const ConformingMesh& mesh, const SurfaceTopology& topology, ExactRecord& record);
// Replaces the final tetrahedra by what local operations made of them; those before the first are
// kept as `unrepaired`.
void record_changed(const ConformingMesh& changed, const SurfaceTopology& topology,
                    ExactRecord& record);
// Replaces the final tetrahedra that were handed to rounding by those that it returned.
void record_repaired(const output::RoundingResult& rounded, Region region, ExactRecord& record);
// Adds the points that the record uses, input vertices first, and renumbers. `as_refined` has the
// input vertices as they were refined, and is null if that is as they are in `points`.
void record_points(const PointStore& points, const PointStore* as_refined,
                   std::size_t input_vertices, const output::RoundingResult& rounded,
                   ExactRecord& record);

}  // namespace delmesher::results
