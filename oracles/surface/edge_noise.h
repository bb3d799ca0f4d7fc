// How noisy the flat faces of a surface are, by its edges alone.
#pragma once

#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {

// The bend of an edge: how far a corner of its two triangles is at most from the plane through
// their common centroid that is perpendicular to the sum of their area vectors. Edges at which the
// triangles make a right angle or less are not asked. Noise bends edges to both sides alike, so of
// those in a range no more can be noise than twice the convex ones, or twice the concave ones.
// Returns the largest bend, as a fraction of the diagonal of the bounding box, that may be noise:
//   - at least 8 edges are bent by up to it (and by more than 2^-46 of the largest coordinate, and
//     by more than `resolved`, a fraction of the diagonal: then at least 15); with one more, those
//     that can be noise are at least 6 times as many as those bent by more, up to 4 times it;
//   - those bent by more than a quarter of it are at least a fifth of these, and those bent by a
//     16th to a quarter of it at least a tenth of those;
//   - at least a fifth, with one more, are convex, and as many concave; of those bent by more than
//   a
//     quarter of it at least a tenth, with one more;
//   - it is at most a quarter of 2^-14, and that much of it is allowed for what doubles make of it.
// 0 if there is none. A mesher that wants more evidence (flat faces that stay what they are if it
// is laxer) finds no more noise than this.
double noise_of_edges(const Polyhedron& surface, double resolved = 0);

}  // namespace tetproof::oracles
