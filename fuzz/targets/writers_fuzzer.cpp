// Every format reads back what was written.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  if (const Finding finding = writers_hold({data, size}); !finding.empty()) report(finding);
  return 0;
}
