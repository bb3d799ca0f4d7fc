// Parts of triangles that meet, too near each other for doubles, become one.
#pragma once

#include <vector>

#include "corpus/union/pairs.h"
#include "corpus/union/poll.h"
#include "corpus/union/soup.h"

namespace tetproof::unite {

// Corners of meeting triangles become one vertex, the first of them, where they are at most `reach`
// from each other; an edge goes through a corner of a triangle that its own meets, if it is so
// near. What closed up still does. Returns how far the surface moved at most.
double join_near(Soup& soup, const std::vector<MeetingPair>& pairs, double reach, Poll& poll);

}  // namespace tetproof::unite
