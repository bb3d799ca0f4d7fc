// Fingerprints of the planes and lines that carry triangles and edges: equal carriers have equal
// keys, whatever points span them.
#pragma once

#include <array>
#include <cstdint>

#include "mesher/predicates/points.h"

namespace delmesher::surface {

// Homogeneous coordinates of a plane or line (Pluecker), computed exactly modulo the prime 2^61 - 1
// and divided by the first that is not zero. Doubles are integers times powers of two, so they have
// exact residues: no tolerance is involved and carriers that are equal get equal keys. Different
// carriers get equal keys with a probability around 2^-61: verify with exact predicates.
struct CarrierKey {
  std::array<std::uint64_t, 6> coordinates{};
  friend auto operator<=>(const CarrierKey&, const CarrierKey&) = default;
};

CarrierKey plane_key(const Vec3& a, const Vec3& b, const Vec3& c);
CarrierKey line_key(const Vec3& a, const Vec3& b);

}  // namespace delmesher::surface
