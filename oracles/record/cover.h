// The part of the surface that a mesh's faces on facets cover.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "oracles/mesh/places.h"
#include "oracles/record/refinement.h"

namespace tetproof::oracles {

// Per tetrahedron, bit i: its face opposite to corner i is one of these faces (a, b, c, facet).
std::vector<std::uint8_t> walls_of(const TetComplex& complex,
                                   std::span<const std::array<std::uint32_t, 4>> faces);

// Right where the oracles of the segments and of the facets of the record pass.
Cover cover_of(const RefinedMesh& mesh);

}  // namespace tetproof::oracles
