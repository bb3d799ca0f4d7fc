// The labels that `--label-by-angle DEGREES` promises, from its documentation (docs/names.md).
#pragma once

#include <string>

#include "oracles/files/polyhedron.h"

namespace tetproof::oracles {

// Labels the triangles 1, 2, ... by their faces, which part where two triangles bend by at least
// `degrees`, and calls them face_1, face_2, ... Angles of 30, 45, 60 and 90 degrees have rational
// squares of their cosines and are decided exactly; others where the angle is no nearer than the
// cosine is known. Empty on success, else why there are no such labels.
std::string label_by_angle(Polyhedron& input, double degrees);

}  // namespace tetproof::oracles
