// Meshing takes no input more work per triangle and tetrahedron than others.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  return on_valid_surface(data, size, complexity_holds);
}
