// A planar graph is refused exactly if it is invalid; else its mesh passes the oracles.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  if (const Finding finding = plane_holds({data, size}); !finding.empty()) report(finding);
  return 0;
}
