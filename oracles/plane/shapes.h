// Planar graphs that are valid by construction: families that grow, and seeded ones with tiny
// angles. For property tests, benchmarks and tables.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesher/delmesher_plane.h"

namespace tetproof::shapes {

using delmesher::PlanarGraph;

// One closed polygon.
PlanarGraph polygon(const std::vector<std::array<double, 2>>& corners);

PlanarGraph square();
// A triangle with this angle (radians) at the origin and sides of length 1.
PlanarGraph needle(double angle);
// 2n corners, at distances of 1 and `ratio` from the centre in turn.
PlanarGraph star(int n, double ratio);
// n teeth of height 1 side by side on a bar, 2 * width wide at the foot and `width` at the tip.
PlanarGraph comb(int n, double width);
// Von Koch's snowflake: 3 * 4^level corners.
PlanarGraph koch(int level);
// n corners around a circle, at distances of 1 to 1 + noise.
PlanarGraph rough_circle(int n, double noise, std::uint64_t seed);
// n segments from one point, `angle` apart, in a square.
PlanarGraph fan(int n, double angle);
// n squares, one inside the other, every second one a hole.
PlanarGraph nested_squares(int n);
// A closed ring of n corners like a coast, its radius a sum of random waves, and `islands` small
// rings beside it.
PlanarGraph archipelago(int n, int islands, std::uint64_t seed);
// About the shape of the paper's figure 2: lobes with sharp tips, and a hole.
PlanarGraph figure();

// A graph with angles down to 1e-12, of one of the families above or a combination, turned, scaled
// and moved. The name says which. The same for the same seed on every machine.
struct Named {
  std::string name;
  PlanarGraph graph;
};
Named tiny_angles(std::uint64_t seed);

// The graph moved, turned and scaled (coordinates are rounded).
PlanarGraph moved(PlanarGraph graph, double angle, double scale, double x, double y);

}  // namespace tetproof::shapes
