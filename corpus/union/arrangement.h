// The exact arrangement of triangles: pieces that meet in common vertices and edges only.
#pragma once

#include <span>
#include <vector>

#include "corpus/union/pairs.h"
#include "corpus/union/points.h"
#include "corpus/union/poll.h"
#include "corpus/union/soup.h"

namespace tetproof::unite {

// A triangle of the arrangement. Crossing it against its normal adds `times` to the winding number:
// so many more of the given triangles that contain it face this way than the other way.
struct Piece {
  Triangle corners;
  int times;     // at least 1
  Index parent;  // the first given triangle that contains it and faces this way
  bool cut;      // the parent meets another triangle
};

struct Arrangement {
  Points points;
  // Those where as many triangles face either way are left out.
  std::vector<Piece> pieces;
  std::uint64_t cut = 0;  // given triangles of more than one piece, or with others in their plane
};

std::vector<Triangle> triangles_of(std::span<const Piece> pieces);

// `pairs`: meeting_pairs() of the soup.
Arrangement arrange(const Soup& soup, const std::vector<MeetingPair>& pairs, Poll& poll);

}  // namespace tetproof::unite
