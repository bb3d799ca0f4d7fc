// Rounder triangles, and edges that are no longer than wanted.
#pragma once

#include "mesher/remesh/state.h"

namespace delmesher::remesh {

// Flips, moves and collapses until triangles have angles of 30 degrees or nothing helps. With
// `new_points` edges are also split, so that rounder triangles fit in.
void make_rounder(State& state, bool new_points, Control& control);

// Splits the longest edge of each triangle that has one that is too long, once. Was there any?
bool split_long(State& state, Control& control);

}  // namespace delmesher::remesh
