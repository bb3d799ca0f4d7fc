// Bodies and open sheets as one complex: nothing is dropped, and `mesh --regions` takes it.
//
// How: what lies on each other but for roundings becomes the same triangles (snapping.h), the rest
// is cut exactly (arrangement.h) and rounded; again, with a larger reach, until nothing meets.
//
// Laws:
// - No two triangles meet outside of a common vertex or edge, but for repeated ones: a piece occurs
//   with each of the labels of the triangles that contain it.
// - Vertices that are left are where they were; `largest_move` bounds how far the surface moved.
// - What comes out stays as it is when it goes in once more.
// - The same input gives the same result. Times a power of two it gives the same times that, or no
//   complex where coordinates would be subnormal; but text of few digits has more of them then.
//
// The reach is `snap`, or if that is 0, a few units in the last place of the largest coordinate: of
// single precision if no coordinate has more digits (binary STL and most text have not), else of
// doubles; where that is in its own way, up to 4 times as much. Where it does not do, the message
// names another one that does.
#pragma once

#include <functional>

#include "corpus/union/unite.h"

namespace tetproof::unite {

// `snap` and `go_on` as in UnionOptions. Codes: done, unsound, empty, imprecise and stopped.
UnionResult cut_into_walls(const delmesher::Surface& surface, double snap,
                           const std::function<bool()>& go_on);

}  // namespace tetproof::unite
