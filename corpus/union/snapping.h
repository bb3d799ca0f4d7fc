// What is meant to coincide, and is roundings apart, does: vertices, edges and faces of a complex.
//
// Bodies of an assembly touch in faces that were computed one by one. Cut exactly, these would
// cross in countless slivers. So vertices near each other become one; an edge goes through the
// vertices near it, and near crossings of edges are vertices of both; then triangles that lie on
// each other are cut together, as if they were in one plane.
//
// Laws:
//  - No vertex is within `reach` of an edge that does not have it, no two are within 2 `reach`.
//  - Pieces that lay on each other are the same piece, with all their triangles as parents.
//  - Vertices keep their doubles or become the first of those near; new ones lie between two edges.
#pragma once

#include <vector>

#include "corpus/union/arrangement.h"
#include "corpus/union/poll.h"
#include "corpus/union/soup.h"

namespace tetproof::unite {

struct Snapped {
  std::vector<Position> vertices;
  std::vector<Piece> pieces;  // of at least one parent
  double moved = 0;           // how far the surface moved at most
  bool done = true;           // false: too much is too near for this reach
  Index place = kNone;        // then a vertex there
};

Snapped snap(const Soup& soup, double reach, Poll& poll);

}  // namespace tetproof::unite
