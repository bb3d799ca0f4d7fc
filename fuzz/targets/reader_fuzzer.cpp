// A reader refuses in one line, or what it delivers can be written and read back. Compiled once per
// format.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const Finding finding = reader_holds(text, "input." TETPROOF_FORMAT);
  if (!finding.empty()) report(finding);
  return 0;
}
