// Which triangles of a surface may meet? In doubles: who asks decides each pair exactly.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>

#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

// For each triangle. Models have 10 to 20.
inline constexpr std::size_t kMostBoxPairs = 64;

// Calls `visit` for pairs of triangles, the smaller number first, some twice. Those that have a
// point in common besides common corners are among them. No triangle is flat.
//
// Boxes find them, but give n^2 pairs where n triangles are around one vertex, or long, slanted and
// side by side. If there are too many (kMostBoxPairs), triangles at such a vertex, a hub, are
// compared as arcs of the sphere around it, and groups of others are told apart by a plane between
// them. n triangles at one edge, as in a complex, still are n^2 pairs.
void for_each_near_pair(std::span<const Position> points,
                        std::span<const std::array<Index, 3>> triangles,
                        const std::function<void(Index, Index)>& visit);

}  // namespace tetproof::oracles
