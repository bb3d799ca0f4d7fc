// A reader of planar graphs refuses in one line, or delivers a consistent graph. The first byte
// chooses the format.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  if (size == 0) return 0;
  static const char* const kNames[] = {"input.poly", "input.txt", "input.off", "input.obj"};
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const Finding finding = plane_reader_holds(text, kNames[data[0] % 4]);
  if (!finding.empty()) report(finding);
  return 0;
}
