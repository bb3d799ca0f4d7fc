// Distances from triangles, in doubles.
#pragma once

#include <array>
#include <span>

#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

using Corners = std::array<Position, 3>;

double distance_to_triangle(const Position& p, const Corners& triangle);

// The segment begins within `distance` of the triangle and ends farther away; the share of it at
// which it leaves what is so near.
double share_near(const Position& a, const Position& b, const Corners& triangle, double distance);

// Is every point of the segment within `distance` of some of the triangles?
bool is_segment_near(const Position& a, const Position& b, std::span<const Corners> triangles,
                     double distance);

}  // namespace tetproof::oracles
