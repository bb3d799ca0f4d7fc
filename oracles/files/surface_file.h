// Reads input surfaces: OFF, OBJ, STL and PLY (text and binary), 3MF, TetGen's .smesh and
// .poly; compressed with gzip or not. Coordinates are rounded to the nearest double.
#pragma once

#include <string>

#include "oracles/files/polyhedron.h"

namespace tetproof::oracles {

// Throws ReadError. Faces of more corners are cut as polygon.h says; an STL soup is welded by equal
// coordinates (-0 = +0).
// Vertices of an OBJ may have two coordinates if it is `planar`.
Polyhedron read_surface(const std::string& path, bool planar = false);

// The text of a file with line feeds alone at the ends of its lines, which may be carriage returns,
// and with blanks for vertical tabs and form feeds. `comment` ends its line wherever it stands;
// '\0': none does.
std::string in_plain_lines(std::string text, char comment);
// The same of an OBJ, its continued lines joined: a backslash ends them, before blanks or a
// comment.
std::string in_obj_lines(std::string text);

}  // namespace tetproof::oracles
