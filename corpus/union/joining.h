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

// Is the triangle no higher than this, over its longest side? In doubles.
bool is_needle(const Soup& soup, const Triangle& corners, double height);

// Such triangles go: corners at most `reach` from each other become one, the first of them, and a
// long side goes through the corner across. As above, what closed up still does.
double remove_needles(Soup& soup, const std::vector<Index>& needles, double reach, Poll& poll);

}  // namespace tetproof::unite
