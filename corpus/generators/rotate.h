// Surfaces in other positions, with coordinates rounded as files round them, so that roundings bend
// flat parts.
#pragma once

#include <array>
#include <cstdint>

#include "corpus/generators/random.h"
#include "mesher/delmesher.h"

namespace tetproof {

enum class Precision : std::uint8_t {
  doubles,
  single,   // to float32, as a binary STL has them
  decimals  // to six significant digits, as text often has them
};

// A rotation; not all zero. The matrix is rational: integers over the sum of squares.
using Quaternion = std::array<int, 4>;

// Three rotations for campaigns, by about 57, 98 and 154 degrees, none about a coordinate axis.
inline constexpr std::array<Quaternion, 3> kRotations = {
    Quaternion{11, 2, 3, 5}, Quaternion{4, 1, -3, 3}, Quaternion{3, 7, 8, -7}};

// Another one, about no coordinate axis and by no half turn.
Quaternion rotation_from(Random& random);

// Rotates about the origin, in doubles, to a few roundings; the same on every machine.
delmesher::Surface rotated(const delmesher::Surface& surface, const Quaternion& rotation,
                           Precision precision);

// Somewhere else, at most 2^26 away, and so small there that its longest side is 2^bits roundings
// of the largest of the new origin's coordinates: each vertex is rounded, and few doubles are left
// for the points that a mesher adds. Flat surfaces and single points stay as they are.
delmesher::Surface coarsened(const delmesher::Surface& surface, int bits, Random& random);

// Every coordinate moved by up to `amplitude` times the largest coordinate.
void add_noise(delmesher::Surface& surface, double amplitude, Random& random);

// A point inside of triangle t, or on its edge h (0 to 2) and so in its neighbour too, becomes a
// vertex, where doubles have it.
void split_at_rounded_point(delmesher::Surface& surface, std::uint32_t t, Random& random);
void split_at_rounded_point(delmesher::Surface& surface, std::uint32_t t, int h, Random& random);

// `p` becomes a vertex of edge h (0 to 2) of triangle t, and so of its neighbour too, which has to
// be there.
void split_edge_at(delmesher::Surface& surface, std::uint32_t t, int h,
                   const std::array<double, 3>& p);

}  // namespace tetproof
