// Which regions of a mesh the points lie in that tell of them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mesher/delmesher.h"
#include "mesher/predicates/points.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::results {

// What the points say of `regions`, which the mesh numbers from 1 on: names, longest edges and
// holes. Of several points in a region the smallest edge counts; an error if their names differ.
// A point that lies in no region, or on a wall between two, gives a warning if it is not a hole's.
Status enter_region_points(std::span<const RegionPoint> given, const ConformingMesh& mesh,
                           PointStore& points, std::vector<MeshRegion>& regions,
                           std::vector<std::string>& warnings);

}  // namespace delmesher::results
