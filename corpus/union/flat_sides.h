// Flat sides that were cut become whole again: edges and vertices that the shape does not need go.
#pragma once

#include <cstdint>
#include <vector>

#include "corpus/union/arrangement.h"
#include "corpus/union/poll.h"
#include "corpus/union/soup.h"

namespace tetproof::unite {

// `pieces` are some of an arrangement of the soup that close up, each counted once. Those that were
// cut, or have a corner at an edge of more than two triangles of the soup, are a flat side if they
// are connected over edges of two, lie in one plane and have one label. A vertex goes if no other
// pieces are around it and it is within a flat side, or on a straight line between flat sides. Flat
// sides around such a vertex are triangulated again; what they cover is the same, exactly. The new
// pieces have a parent of their flat side. Returns how many vertices went.
std::uint64_t restore_flat_sides(const Soup& soup, const Points& points, std::vector<Piece>& pieces,
                                 Poll& poll);

}  // namespace tetproof::unite
