// How much bend at an edge is taken for rounding.
#pragma once

#include "mesher/base/control.h"
#include "mesher/delmesher/surface.h"

namespace delmesher::planar {

// An edge that is bent (edge_bends.h) by less than 2^-20 of the diagonal of the bounding box is
// called flat. Returns four times the largest such bend, since the corners of many triangles are
// farther from their plane than those of two, at most 2^-20 of the diagonal and at least 64 ulp of
// the largest coordinate; these 64 ulp where all of a double's digits are used and the small bends
// are of a curved surface: as many edges are bent by up to four times that limit, or edges beside
// each other are bent alike (`roughness`, below 0.45).
//
// Where coordinates were rounded more coarsely (resolution.h), flat faces are bent by more. That
// shows: hardly an edge is bent by a bit more than rounding explains, while there are edges of
// every small bend on a curved surface. So if more than four edges can be explained by it (up to
// 1.25 of the rounding), and 4.5 times as many as are bent by up to four times that, it returns at
// least 1.5 times the rounding, at most 2^-14 of the diagonal.
//
// Coordinates may be noisier than their digits tell: they were rounded more than once, or are
// integers. If the bends alone tell of noise (`noise_of_bends`), it returns two to four times that
// noise, unless edges beside each other are bent alike (`roughness`, below 0.45): twice, unless
// more makes further planar groups one with others, and then hardly any. That is if it makes at
// least three of a hundred groups one with others, and twice as much hardly more: not one in ten,
// not a fiftieth as many, or not one in four and not a third as many. Faces that are flat except
// for noise stay the same, those of a curved surface grow together more and more. At most 2^-14 of
// the diagonal, too. Bends that the coordinates cannot resolve (up to 1.25 of the rounding), or
// below 2^-22 of the diagonal, may hide such noise, so it is looked for without them as well; then
// at least 16 edges have to tell of it, not 8. In the units of the surface, which is valid.
double flatness(const Surface& surface, Control& control);

}  // namespace delmesher::planar
