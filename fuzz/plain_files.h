// A second reader, for the plainest text files only: for them there is no doubt what a reader has
// to deliver.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tetproof::fuzz {

// The corners of each triangle.
using TriangleSoup = std::vector<std::array<std::array<double, 3>, 3>>;

// The triangles of an OFF, OBJ or STL text whose lines are just vertices and triangles, with
// decimal numbers in the range of doubles and distinct corners; nothing for any other text, valid
// or not. `name` gives the format by its extension.
std::optional<TriangleSoup> plain_triangles(const std::string& text, const std::string& name);

}  // namespace tetproof::fuzz
