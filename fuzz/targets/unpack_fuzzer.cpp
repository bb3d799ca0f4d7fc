// Compressed bytes unpack to what zlib makes of them. The first byte chooses the wrapping.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tetproof::fuzz::on_text(data, size, tetproof::fuzz::unpacking_agrees);
}
