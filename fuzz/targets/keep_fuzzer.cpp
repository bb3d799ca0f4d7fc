// A mesh with the surface kept passes the oracles.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  return on_valid_surface(data, size, keep_holds);
}
