// Building blocks of the generated polyhedra. All arithmetic is basic (no sine or cosine), so that
// a seed gives the same doubles on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "corpus/generators/random.h"
#include "mesher/delmesher.h"

namespace tetproof::shapes {

using delmesher::Surface;
using Point = std::array<double, 3>;
using Planar = std::array<double, 2>;
using Polygon = std::vector<Planar>;  // counter-clockwise

// A point of the unit circle (up to rounding) after about this many turns.
Planar circle(double turns);
// Regular polygon; `vary` (if any) gives the radius of corner i.
Polygon polygon(int corners, const std::function<double(int)>& vary = nullptr, double turned = 0);

// Triangles of a simple polygon, by cutting ears.
std::vector<std::array<std::uint32_t, 3>> triangulate(const Polygon& polygon);

Surface box(const Point& low, const Point& high);
Surface tetrahedron(const Point& a, const Point& b, const Point& c, const Point& d);
// The polygon between two heights.
Surface extrude(const Polygon& polygon, double bottom, double top);
// Rings with the same number of points above each other, closed by the fans of two apexes.
Surface spindle(const Point& bottom, const std::vector<std::vector<Point>>& rings,
                const Point& top);
// Rings closed by the triangulations of the first and the last polygon; `flip` chooses the diagonal
// of quadrangle i between two rings.
Surface tower(const std::vector<Polygon>& rings, const std::vector<double>& heights,
              const std::function<bool(int)>& flip = nullptr);
// The octahedron, subdivided, with corners at the distances that `radius` gives.
Surface sphere(int rounds, const std::function<double()>& radius);
// Two copies of the unit square's grid of n x n cells, at the heights given per grid point, closed
// at the sides.
Surface slab(int n, const std::function<double(int x, int y)>& bottom,
             const std::function<double(int x, int y)>& top);
// Tells which cells of a grid belong to the solid.
using Cells = std::function<bool(int x, int y, int z)>;
Surface walls(const std::array<std::vector<double>, 3>& lines, const Cells& solid);

void append(Surface& surface, const Surface& other);
void reverse(Surface& surface);
void move(Surface& surface, const std::function<Point(const Point&)>& map);
// Leaves out vertices without triangles and merges those of equal coordinates.
Surface welded(const Surface& surface);

Point mix(const Point& a, const Point& b, double share_of_b);
// x moved up (or down, if negative) by this many doubles.
double ulps_away(double x, int steps);
// Signed permutation of the axes, chosen at random: exact.
void turn(Surface& surface, Random& random);

}  // namespace tetproof::shapes
