// A planar graph is rejected exactly if it is invalid; else its mesh passes the oracles.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tetproof::fuzz::on_bytes(data, size, tetproof::fuzz::plane_holds);
}
