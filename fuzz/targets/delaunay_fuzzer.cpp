// The tetrahedrization of points is Delaunay, and that of CGAL where there is only one.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tetproof::fuzz::on_bytes(data, size, tetproof::fuzz::delaunay_agrees);
}
