// What the refinement in the plane was spared: corners cut off, and segments dropped.
#pragma once

#include <functional>
#include <set>

#include "oracles/plane_graph.h"
#include "oracles/promise.h"
#include "oracles/report.h"

namespace tetproof::oracles {

// What is left of a piece in the refined mesh, as distances from its ends.
struct PieceRest {
  bool kept = false;
  double cut_a = 0, cut_b = 0;  // exactly 0 where it reaches the end
};

// Is something of what is between two directions from a vertex (less than a right angle, counter-
// clockwise, towards the other ends of two pieces) inside? 1, 0, or -1 where nobody knows.
using WedgeSide = std::function<int(std::uint32_t v, std::uint32_t from, std::uint32_t to)>;

// Adds to the report:
//  - refined-chamfer-radius: every corner is an input vertex, once, its radius positive, at most a
//    third of its local feature size and at most what was promised;
//  - refined-chamfer-need: exactly those vertices are chamfered at which two neighbouring kept
//    pieces form an angle below the promised threshold on a side that is refined;
//  - refined-chamfer-cuts: kept pieces are cut at the radius of their chamfered ends, and nowhere
//    else;
//  - refined-drops: every piece that is missing is of a segment called dropped, and the other way
//    round; each has a reason: a channel narrower than tau beside it, or features closer to each
//    other than doubles leave room for. Counted are those that only meet a piece with such a
//    reason, and those for which there is no room but elsewhere: grief spreads in the refinement.
void check_plane_chamfers(PlaneGraph& graph, const delmesher::PlaneRecord& record,
                          const std::vector<PieceRest>& rests, const WedgeSide& wedge_side,
                          const Promise& promise, VerifyReport& report);

}  // namespace tetproof::oracles
