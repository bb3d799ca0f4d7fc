// Reads input surfaces: OFF, OBJ, STL and PLY (text and binary), 3MF, TetGen's .smesh and
// .poly; compressed with gzip or not. Coordinates are rounded to the nearest double.
#pragma once

#include <string>

#include "oracles/files/polyhedron.h"

namespace tetproof::oracles {

// Throws ReadError. Faces of more corners are cut as polygon.h says; an STL soup is welded by equal
// coordinates (-0 = +0).
Polyhedron read_surface(const std::string& path);

}  // namespace tetproof::oracles
