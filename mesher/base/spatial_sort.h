// Biased randomized insertion order along a Hilbert curve (Amenta, Choi, Rote 2003; Skilling 2004).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mesher/base/namespaces.h"

namespace delmesher::base {

// The rounds of doubling size of a biased randomized insertion order: point n of them is in the
// last round with probability 1/2, in the one before with 1/4, ... Below 64 points a round is not
// worth its scatter.
class InsertionRounds {
 public:
  explicit InsertionRounds(std::size_t points);
  int last() const { return last_; }
  int operator()(std::uint32_t n) const;  // 0 ... last()

 private:
  int last_;
};

// Permutes `order` (indices into `coordinates`): rounds of doubling size, drawn by a fixed hash of
// the position in `order`, each sorted along a Hilbert curve. Deterministic, and the same for
// coordinates scaled by a power of two.
void spatial_sort(std::span<std::uint32_t> order,
                  std::span<const std::array<double, 3>> coordinates);

// Permutes `order` along a Hilbert curve, without rounds.
void hilbert_sort(std::span<std::uint32_t> order,
                  std::span<const std::array<double, 3>> coordinates);

}  // namespace delmesher::base
