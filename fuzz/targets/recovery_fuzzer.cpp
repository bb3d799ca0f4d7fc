// Segments and facets are recovered, with nothing lost.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  return on_valid_surface(data, size, recovery_holds);
}
