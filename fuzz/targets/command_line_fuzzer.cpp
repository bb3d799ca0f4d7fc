// One argument per line: the command line ends with a documented code and says one line.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tetproof::fuzz::on_text(data, size, tetproof::fuzz::command_line_holds);
}
