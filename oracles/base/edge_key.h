// Edges as single numbers, to be sorted, searched and compared.
#pragma once

#include <algorithm>
#include <cstdint>

#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

// From a to b; the other way round it is another number.
inline std::uint64_t directed_key(Index a, Index b) {
  return static_cast<std::uint64_t>(a) << 32 | b;
}

// The same for both directions.
inline std::uint64_t edge_key(Index a, Index b) {
  return directed_key(std::min(a, b), std::max(a, b));
}

}  // namespace tetproof::oracles
