// Cuts faces of more than three corners into triangles by the rule of mesher/io/formats.md, which
// decides which solid is meant where they are not planar.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "oracles/files/polyhedron.h"

namespace tetproof::oracles {

// Replaces the fans of every face of more than three corners by as many triangles. The axis along
// which the face's area vector (in doubles) is largest is left out, and corners are taken
// counter-clockwise in the projection. As long as there are more than three, the ear with the
// shortest diagonal (squared, in doubles; of equals the first corner) is cut off. An ear turns
// left, and no corner that does not turn left lies in its closed triangle; signs are exact. If the
// projection is not simple the next axis is tried. A face that is simple along no axis stays a fan,
// one `polygon`; each triangle of a face that was cut is a polygon of its own.
void cut_polygons(Polyhedron& surface);

// The triangles of a facet of several polygons, less the innermost polygon around each hole point:
// in the projection of the first polygon each hole goes to the innermost polygon around it. Holes
// are linked from the one that reaches farthest to the right (x, then y) on, by that corner and the
// nearest corner that sees it, and the ring that results is cut as above. Nothing if that cannot be
// done along any axis.
std::optional<std::vector<std::array<Index, 3>>> cut_facet(
    const std::vector<Position>& vertices, const std::vector<std::vector<Index>>& polygons,
    const std::vector<Position>& holes);

}  // namespace tetproof::oracles
