// Which triangles meet? Decided exactly, by CGAL.
#pragma once

#include <vector>

#include "corpus/union/poll.h"
#include "corpus/union/soup.h"

namespace tetproof::unite {

struct MeetingPair {
  Index a, b;     // triangles, a < b
  bool coplanar;  // are both in one plane?
};

// All pairs of triangles with a common point that is on no vertex and no edge of both of them. So
// are two triangles of the same corners. In the order of their numbers.
std::vector<MeetingPair> meeting_pairs(const Soup& soup, Poll& poll);

}  // namespace tetproof::unite
