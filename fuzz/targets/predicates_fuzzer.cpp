// Every predicate agrees with rationals on any mix of points.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  if (const Finding finding = predicates_agree({data, size}); !finding.empty()) report(finding);
  return 0;
}
