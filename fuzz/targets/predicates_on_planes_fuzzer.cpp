// Every predicate agrees with rationals where points are the meeting points of planes.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  return on_bytes(data, size, predicates_on_planes_agree);
}
