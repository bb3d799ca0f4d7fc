// How much the edges of a surface are bent, and what of that is noise.
#pragma once

#include <cstddef>
#include <vector>

#include "mesher/delmesher/surface.h"

namespace delmesher::planar {

// The bend of an edge is the largest distance of the corners of its two triangles from the plane of
// the sum of their area vectors. Of the edges of a valid surface: positive where it is convex if
// triangles face outwards (else all are the other way round), negative where it is concave,
// infinite where the triangles are at a right angle or more.
std::vector<double> edge_bends(const Surface& surface);

// Coordinates that were rounded more than once, or to integers, do not say how coarse they are.
// Bends do: those that noise makes are as often convex as concave and of all sizes up to its own,
// while a fillet bends its edges to one side. So of the bends of a range, twice those to the side
// that has fewer may be noise. Returns the smallest bend above `least` such that
//   - at least `fewest` edges are bent by up to it (and by more than `rounding`, as edges are that
//     were only rounded), and those of them that may be noise are seven times as many as those
//     beyond, up to four times it,
//   - at least an eighth as many by a 16th to a quarter of it as by a quarter or more,
//   - at least a quarter of all these by more than a quarter of it,
//   - at least a quarter of all these to either side, and an eighth of those by more than a
//   quarter.
// or, up to 2.5 times that, the first of these that is followed by a tenth as many bends at all.
// 0 if there is none up to `most`. What it finds may still be a surface that is curved.
double noise_of_bends(const std::vector<double>& bends, double rounding, double least, double most,
                      std::ptrdiff_t fewest);

// Noise bends an edge whatever it does to the next one; where edges were meant to be bent, those
// beside each other, as long and in the same direction, are bent alike. Returns the mean square of
// the differences of such edges over that of two independent ones, for edges bent by more than
// `rounding` and up to `noise`: around 1 or more of noise, hardly anything of a smooth surface. 1
// if fewer than 32 edges tell.
double roughness(const Surface& surface, double rounding, double noise);

}  // namespace delmesher::planar
