// Angles and counts of triangulations.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "mesher/delmesher/planar_graph.h"
#include "mesher/plane/refine.h"

namespace delmesher::plane {

PlaneMeshStatistics plane_statistics(std::span<const std::array<double, 2>> vertices,
                                     std::span<const std::array<std::uint32_t, 3>> triangles);

// The same for triangles given by ids, on nearest doubles.
PlaneMeshStatistics refined_statistics(const RefinedMesh& refined, const PointStore& points,
                                       Region region);

}  // namespace delmesher::plane
