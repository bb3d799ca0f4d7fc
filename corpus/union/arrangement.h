// The exact arrangement of triangles: pieces that meet in common vertices and edges only.
#pragma once

#include <cstdint>
#include <functional>
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
  // If all pieces are kept: the given triangles that contain it.
  std::vector<Index> parents = {};
};

// Are those pieces kept where as many triangles face either way?
enum class Cancelled : std::uint8_t { dropped, kept };

struct Arrangement {
  Points points;
  std::vector<Piece> pieces;
  std::uint64_t cut = 0;  // given triangles of more than one piece, or with others in their plane
};

std::vector<Triangle> triangles_of(std::span<const Piece> pieces);

// `pairs`: meeting_pairs() of the soup. With Cancelled::kept, `times` is 1.
Arrangement arrange(const Soup& soup, const std::vector<MeetingPair>& pairs, Cancelled cancelled,
                    Poll& poll);

// The pieces, with new points at the nearest doubles, and the label of each. Adds how far one moved
// at most to `moved`.
delmesher::Surface rounded(const Points& points, std::span<const Piece> pieces,
                           const std::function<std::int32_t(const Piece&)>& label, double& moved,
                           Poll& poll);

}  // namespace tetproof::unite
