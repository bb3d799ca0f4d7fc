// Angles of triangles and tetrahedra in degrees, measures of their shape, and the exact orientation
// of a tetrahedron, for meshes of any program. Independent of the mesher's own statistics.
//
// All angles are atan2(sine, cosine) with both computed to the same scale (Shewchuk, Lecture Notes
// on Geometric Robustness, 2013); tetrahedra whose faces are needles, where rounding would show,
// are redone in rational arithmetic. Angles are accurate to about 1e-8 degrees at any scale.
#pragma once

#include <array>

namespace tetproof {

using Point = std::array<double, 3>;
using Corners = std::array<Point, 4>;

// Sign of det(b - a, c - a, d - a), exactly: 1 for the orientation that .mesh and .msh files use.
int orientation(const Corners& corners);

// Angles at a, b and c; 0 beside an edge of length 0.
std::array<double, 3> triangle_angles(const Point& a, const Point& b, const Point& c);

// Dihedral angles at the edges 01, 02, 03, 12, 13, 23, of the tetrahedron taken as positively
// oriented. Flat tetrahedra have 0 and 180, or 0 where even a face has no area.
std::array<double, 6> dihedral_angles(const Corners& corners);

// Measures that are 1 for a regular tetrahedron, positive for every other one, and 0 for a flat
// one. They do not depend on the orientation, and are right to about 1e-9.
struct TetrahedronShape {
  double gamma = 0;  // 3 times the radius of the inscribed sphere over that of the circumsphere
  // Gmsh's SICN except for the sign: 3 over the product of the Frobenius norms of S and its
  // inverse, where S maps a regular tetrahedron to this one.
  double sicn = 0;
};

TetrahedronShape tetrahedron_shape(const Corners& corners);

}  // namespace tetproof
