// Every format reads back the mesh that was written.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tetproof::fuzz::on_bytes(data, size, tetproof::fuzz::writers_hold);
}
