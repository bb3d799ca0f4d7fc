// The tetrahedrization of points is that of CGAL.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  if (const Finding finding = delaunay_agrees({data, size}); !finding.empty()) report(finding);
  return 0;
}
