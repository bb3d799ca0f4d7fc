// On which side of the pieces of an arrangement is the inside?
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "corpus/union/arrangement.h"
#include "corpus/union/poll.h"

namespace tetproof::unite {

// Do the pieces bound something? At each edge as many have to go one way as the other, each counted
// as often as it is there.
struct OpenEdges {
  std::uint64_t count = 0;
  Index place = kNone;  // a vertex of the first
};
OpenEdges find_open_edges(std::span<const Piece> pieces);

// The winding number in front of each piece, where its normal points to; behind it, it is larger by
// Piece::times. The arrangement has no open edges. One exact ray for each patch.
std::vector<int> windings_in_front(const Arrangement& arrangement, Poll& poll);

}  // namespace tetproof::unite
