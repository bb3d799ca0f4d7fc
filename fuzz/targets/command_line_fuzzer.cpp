// One argument per line: the command line ends with a documented code and says one line.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetproof::fuzz;
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const Finding finding = command_line_holds(text); !finding.empty()) report(finding);
  return 0;
}
