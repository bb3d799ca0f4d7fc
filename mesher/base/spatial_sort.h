// Biased randomized insertion order along a Hilbert curve (Amenta, Choi, Rote 2003; Skilling 2004).
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace delmesher {

// Permutes `order` (indices into `coordinates`): rounds of doubling size, drawn by a fixed hash of
// the position in `order`, each sorted along a Hilbert curve. Deterministic, and the same for
// coordinates scaled by a power of two.
void spatial_sort(std::span<std::uint32_t> order,
                  std::span<const std::array<double, 3>> coordinates);

}  // namespace delmesher
