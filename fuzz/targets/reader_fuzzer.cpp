// A reader rejects in one line, or its surface can be written and read back. Compiled once per
// format.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tetproof::fuzz::on_text(data, size, [](const std::string& text) {
    return tetproof::fuzz::reader_holds(text, "input." TETPROOF_FORMAT);
  });
}
