// Mutation of bytes that a target reads numbers from. Now and then all of them are replaced, so
// that inputs are long enough for a target from the start. Deterministic in the seed.
#include <algorithm>

#include "corpus/generators/random.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  constexpr std::size_t kLongest = 512;
  tetproof::Random random(seed);
  const std::size_t most = std::min(kLongest, max_size);
  if (size > 1 && !random.chance(0.1)) return LLVMFuzzerMutate(data, size, std::max(size, most));
  // Few different values make ties: below 1 in 256, 16 or 2.
  const std::uint64_t values = std::uint64_t{1} << (random.chance(0.5) ? 8 : random.integer(1, 8));
  const std::size_t length = 1 + random.below(most);
  for (std::size_t i = 0; i < length; ++i) {
    data[i] = static_cast<std::uint8_t>(random.below(values));
  }
  return length;
}
