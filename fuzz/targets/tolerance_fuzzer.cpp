// The whole pipeline passes all oracles.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  return on_valid_surface(data, size, tolerance_holds);
}
