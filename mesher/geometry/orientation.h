// Which way triangles go round: the same way as their neighbours, and outwards.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mesher/base/polling.h"
#include "mesher/delmesher/surface.h"

namespace delmesher::geometry {

// Triangles that hang together by edges of exactly two, in the order in which they were reached
// from the first; `turned`: it has to be turned round to agree with that one.
struct PatchTriangle {
  std::uint32_t triangle;
  bool turned;
};
using Patch = std::vector<PatchTriangle>;
std::vector<Patch> patches_of(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                              Polling& polling);

// Facets of TetGen's files have no orientation. Turns the triangles of each patch outwards, or of
// one inside an odd number of others inwards. Answers with warnings where TetGen would mesh another
// part than that inside an odd number of patches: it fills what has no hole point. Where more than
// two triangles meet at an edge, or fewer, the orientation is open.
std::vector<std::string> orient_facets(Surface& surface,
                                       const std::vector<std::array<double, 3>>& holes,
                                       Polling& polling);

}  // namespace delmesher::geometry
