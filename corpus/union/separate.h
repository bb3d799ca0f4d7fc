// Parts that touch at edges and vertices, moved apart by a little: a surface that touches itself is
// not manifold there, and is not meshed.
//
// How: around an edge of several wedges of solid each wedge takes the edge for itself, and around a
// vertex each fan of triangles takes the vertex. An edge whose wedges have the same vertices at
// both ends gets a vertex in its middle first. Each copy of a vertex is moved to the side of its
// fan where nothing else touches it: parts that touch shrink, walls between hollows grow. Moves
// that make triangles meet are halved, or try another direction.
//
// Laws, on success, of triangles that close up, with outward normals, and that meet only in common
// vertices and edges:
// - The same is true of the result, and it is manifold.
// - No vertex is farther than `farthest` from where it was (exactly), the middle of an edge from
//   there, and so the surfaces are nowhere farther from each other. `largest_move` is the largest.
// - Vertices where nothing touches are where they were. Triangles keep their labels.
#pragma once

#include <cstdint>

#include "corpus/union/poll.h"
#include "corpus/union/soup.h"

namespace tetproof::unite {

struct Separation {
  bool done = false;
  Position place{};          // a vertex that could not be moved, where it is not done
  std::uint64_t halved = 0;  // edges that got a vertex in their middle
  std::uint64_t copies = 0;  // that the vertices where parts touch have become
  double largest_move = 0;
};

// `farthest`: how far a vertex may move, a distance. If it is not done, the soup is of no use.
Separation separate(Soup& soup, double farthest, Poll& poll);

}  // namespace tetproof::unite
