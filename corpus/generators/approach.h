// Moving a vertex towards a facet until the surface is just valid, or just not.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "corpus/generators/random.h"
#include "mesher/delmesher.h"

namespace tetproof {

// A vertex on its way through a facet that it does not belong to. `valid` is the last place found
// where the surface is valid, `invalid` the first where it is not; they are neighbouring points of
// the way in doubles.
struct Approach {
  std::uint32_t vertex = 0;
  std::array<double, 3> from{}, valid{}, invalid{};
  delmesher::Defect::Kind defect = delmesher::Defect::Kind::self_intersection;  // at `invalid`
};

// Nothing if none of a few random attempts met any facet. The surface must be valid.
std::optional<Approach> approach(const delmesher::Surface& surface, Random& random);

// Pulls a random vertex to within about 2^-k of a facet, k <= bits; the surface stays valid.
// Returns whether it did.
bool pull_near(delmesher::Surface& surface, Random& random, int bits);

}  // namespace tetproof
