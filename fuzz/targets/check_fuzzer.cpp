// Our check of a surface agrees with CGAL, on valid and on invalid ones.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  return on_any_surface(data, size, check_agrees);
}
