// What passes between the stages, for pipeline.cpp: gathers, converts and records, but decides
// nothing.
#pragma once

#include <vector>

#include "mesher/cdt/cdt.h"
#include "mesher/chamfer/filter.h"
#include "mesher/delmesher.h"
#include "mesher/output/rounding.h"
#include "mesher/refine/refine.h"

namespace delmesher {

// --- towards the refinement

// Sets the squared cosine of the input vertices around a place to 0 (90 degrees) in a list with one
// entry per input vertex, which is created with the value `otherwise` if it is empty.
void tighten_corners(const Vec3& place, double otherwise, const SurfaceTopology& topology,
                     const PointStore& points, std::vector<double>& vertex_cosine_squared);

// Boxes covering what chamfering and filtering removed from the surface.
std::vector<Box> removed_boxes(const ChamferResult& chamfered,
                               const std::vector<std::uint8_t>& facet_kept,
                               const SurfaceTopology& topology, const PointStore& points);

// --- towards the enriched CDT (section 6)

// The input surface alone.
CdtInput plain_input(const SurfaceTopology& topology);

// The input surface with the vertices of the refined mesh, without those volume vertices that lie
// in the spheres and cylinders of the chamfering.
CdtInput enriched_input(const ChamferResult& chamfered, const std::vector<std::uint8_t>& facet_kept,
                        const RefineResult& refined, const SurfaceTopology& topology,
                        const PointStore& points, Predicates& predicates, Control& control);

// --- towards rounding

struct MeshToWrite {
  RoundingInput rounding;
  std::vector<FacetId> boundary_facet;  // per face of rounding.boundary
  // Per tetrahedron: bit i if an earlier one has face i too. May be empty.
  std::vector<std::uint8_t> repeated_faces;
};

MeshToWrite conforming_mesh(const CdtResult& cdt, const SurfaceTopology& topology,
                            const PointStore& points, Region region);
// The refined mesh itself; its boundary is the part of the surface that was neither chamfered nor
// filtered.
MeshToWrite approximate_mesh(const ChamferResult& chamfered, const RefineResult& refined,
                             const SurfaceTopology& topology, const PointStore& points,
                             Region region);

// --- towards the caller

MeshStatistics refined_statistics(const RefineResult& refined, const PointStore& points,
                                  Region region, Control& control);
// Of a final mesh's inside, before rounding.
MeshStatistics interior_statistics(const CdtResult& cdt, const PointStore& points,
                                   Control& control);

// The chamfered surface with rounded coordinates, for display, in the triangulation that the
// refinement gave it.
Surface chamfered_surface(const ChamferResult& chamfered, const RefineResult& refined,
                          const SurfaceTopology& topology, const PointStore& points);

// --- the exact record; point indices are ids of the store until record_points renumbers them
// `tolerance`: the filter's, in input units.
void record_parameters(const Options& options, double tolerance, ExactRecord& record);
// `filter` is null if nothing was filtered.
void record_facets(const SurfaceTopology& topology, const FilterResult* filter,
                   ExactRecord& record);
void record_chamfer(const ChamferResult& chamfered, double threshold_degrees,
                    const std::vector<double>& vertex_cosine_squared, ExactRecord& record);
void record_refined(const ChamferResult& chamfered, const RefineResult& refined,
                    const SurfaceTopology& topology, ExactRecord& record);
void record_final(const CdtResult& cdt, const SurfaceTopology& topology, ExactRecord& record);
// Replaces the final tetrahedra by those left after thinning.
void record_thinned(const CdtResult& thinned, const SurfaceTopology& topology, ExactRecord& record);
// Replaces the final tetrahedra that were handed to rounding by those that it returned.
void record_repaired(const RoundingResult& rounded, Region region, ExactRecord& record);
// Adds the points that the record uses, input vertices first, and renumbers.
void record_points(const PointStore& points, std::size_t input_vertices,
                   const RoundingResult& rounded, ExactRecord& record);

}  // namespace delmesher
