// Faces of more than three corners, cut into triangles by the rule of mesher/io/formats.md, which
// decides what solid is meant where they are not planar.
#pragma once

#include "oracles/input_surface.h"

namespace tetproof::oracles {

// Replaces the fans of every face of more than three corners by as many triangles: the axis along
// which the face's area vector (in doubles) is largest is left out; corners are taken
// counter-clockwise in what is left; as long as there are more than three, the ear with the
// shortest diagonal (squared, in doubles; of equals the first corner) is cut off. An ear turns
// left, and no corner that does not lies in its closed triangle; signs are exact. If the projection
// is not simple the next axis is tried. A face that is simple along none stays a fan, one
// `polygon`; what was cut is a polygon per triangle.
void cut_polygons(Polyhedron& surface);

}  // namespace tetproof::oracles
