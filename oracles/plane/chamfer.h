// Corners that the refinement in the plane was spared because they were cut off, and segments that
// it was spared because they were dropped.
#pragma once

#include <functional>
#include <set>

#include "oracles/plane/graph.h"
#include "oracles/verdict/promise.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// The part of a piece that the refined mesh keeps, as distances from its ends in input units.
struct PieceRest {
  bool kept = false;
  double cut_a = 0, cut_b = 0;  // exactly 0 where the part reaches the end
};

// Is anything inside between two directions from a vertex, towards the other ends of two pieces?
// The angle is less than a right angle, counter-clockwise from the first direction to the second.
using WedgeSide = std::function<bool(std::uint32_t v, std::uint32_t from, std::uint32_t to)>;

// Adds to the report:
// - refined-chamfer-distance: every corner is an input vertex, once; its distance is positive, at
// most
//   a third of its local feature size and at most --chamfer-radius;
// - refined-chamfer-need: a vertex is chamfered exactly if two neighbouring kept pieces form an
//   angle there below the promised threshold, on a side that is refined;
// - refined-chamfer-cuts: kept pieces are cut at the distance of their chamfered ends, and nowhere
//   else;
// - refined-drops: a piece is missing exactly if its segment is called dropped, and has a reason to
//   be: a channel narrower than tau beside it (its narrow part, or the squares that fit into all of
//   it), or features closer to each other than doubles leave
//   room for. Pieces without a reason of their own are counted, not failed, if they meet a piece
//   that has one, or if there is no room somewhere else: trouble spreads in the refinement.
void check_plane_chamfers(PlaneGraph& graph, const delmesher::PlaneRecord& record,
                          const std::vector<PieceRest>& rests, const WedgeSide& wedge_side,
                          const Promise& promise, VerifyReport& report);

}  // namespace tetproof::oracles
