// Distances between non-incident elements of a surface, in doubles (they steer, they decide nothing
// exact).
#pragma once

#include "mesher/base/control.h"
#include "mesher/surface/topology.h"

namespace delmesher::surface {

// Distances between closed simplices, relative accuracy about 1e-12 of the coordinates'
// differences.
double point_segment_distance(const Vec3& p, const Vec3& a, const Vec3& b);
double point_triangle_distance(const Vec3& p, const std::array<Vec3, 3>& t);
double segment_segment_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// The smallest distance between two input elements (vertices, non-flat edges, facets) that share no
// point.
double smallest_local_feature_size(const SurfaceTopology& topology, const PointStore& points,
                                   Control& control);

}  // namespace delmesher::surface
