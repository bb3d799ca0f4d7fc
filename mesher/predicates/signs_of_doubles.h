// Exact signs of points that are plain doubles and belong to no store: corners of the polygons of a
// file, vertices of a rounded mesh. The filters and the exact integers are those of Predicates.
//
// Laws (signs_of_doubles_test.cpp), for all finite coordinates:
//  (1) The signs are those of the determinants in rational arithmetic.
//  (2) Exchanging two arguments inverts the sign.
//  (3) Scaling by a power of two, as long as it is exact, changes no sign.
#pragma once

#include <array>

#include "mesher/predicates/points.h"

namespace delmesher::predicates {

// Sign of det(b - a, c - a): +1 if a, b, c turn counter-clockwise, 0 if they are collinear.
int orient2d_sign(const std::array<double, 2>& a, const std::array<double, 2>& b,
                  const std::array<double, 2>& c);

// Sign of det(b - a, c - a, d - a), as Predicates::orient3d; 0 if the points are coplanar.
int orient3d_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace delmesher::predicates
