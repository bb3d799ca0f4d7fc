// Mutation of compressed bytes: now and then all of them are what zlib makes of some text, and
// otherwise they are changed as they are. Deterministic in the seed.
#include <algorithm>
#include <string>

#include "corpus/generate/random.h"
#include "mesher/io/test_zlib.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

// Runs and repetitions, of few or of many different characters.
std::string some_text(tetproof::Random& random) {
  std::string text;
  const std::uint64_t values = std::uint64_t{1} << random.integer(0, 8);
  for (std::uint64_t left = random.below(60); left > 0; --left) {
    const auto c = static_cast<char>(random.below(values));
    text.append(random.chance(0.1) ? 1 + random.below(400) : 1, c);
    if (random.chance(0.1)) text += text.substr(random.below(text.size()));
  }
  return text;
}

// With the byte before that chooses the wrapping.
std::string packed(const std::string& text, tetproof::Random& random) {
  const std::uint64_t wrapping = random.below(3);
  const int level = static_cast<int>(random.below(10)),
            strategy = static_cast<int>(random.below(5));
  return static_cast<char>(wrapping) +
         delmesher::io::packed_by_zlib(text, static_cast<delmesher::io::Wrapping>(wrapping), level,
                                       strategy);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  tetproof::Random random(seed);
  if (size > 1 && !random.chance(0.1)) return LLVMFuzzerMutate(data, size, max_size);
  const std::string bytes = packed(some_text(random), random);
  const std::size_t length = std::min(bytes.size(), max_size);
  std::copy_n(bytes.begin(), length, data);
  return length;
}
