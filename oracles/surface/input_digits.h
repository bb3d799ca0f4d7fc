// How far --planar auto may let a surface deviate, by the digits that its coordinates have and by
// its edges.
#pragma once

#include <span>

#include "oracles/base/exact_points.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {

// As a fraction of the diagonal of the bounding box: 2^-18, or more where the coordinates were
// rounded more coarsely: six times half a unit in the last place on every axis (as a vector), if
// that is at most 2^-12. Decimals that are not all integers have a last place: the last one that
// any of them needs. If they need six significant digits or more, that many may have been printed,
// and it is the last such digit of the largest number on the axis where that is coarser. Numbers
// that all are of single precision have that of the largest on the axis, even if they have a finer
// decimal place, and if their decimal place explains more than that. Models whose largest
// coordinate is above 2^64 or below 2^-64 are meshed in units of a power of two just above it, and
// may have been rounded before they were scaled: the digits in those units count as well.
double automatic_planar_share(std::span<const Position> vertices);

// The same, or 16 times the noise that the edges show (edge_noise.h) if that is more:
// coordinates that were rounded more than once are noisier than their digits tell. Edges that are
// bent by no more than 1.25 times what the digits explain, or than 2^-22 of the diagonal, may hide
// noise: all of them count, and all but these.
double automatic_planar_share(const Polyhedron& surface);

}  // namespace tetproof::oracles
