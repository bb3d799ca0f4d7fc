// The oracles take no mesh more steps per element than others, however damaged it is.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tetproof::fuzz::on_bytes(data, size, tetproof::fuzz::verification_cost_holds);
}
