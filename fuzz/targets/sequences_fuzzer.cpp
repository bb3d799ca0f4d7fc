// Calls of the library in any order answer what each of them answers.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tetproof::fuzz::on_bytes(data, size, tetproof::fuzz::sequences_hold);
}
