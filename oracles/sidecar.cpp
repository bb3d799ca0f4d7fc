#include "oracles/sidecar.h"

#include "oracles/text_reader.h"

namespace tetproof::oracles {

delmesher::ExactRecord read_sidecar(const std::string& path) {
  throw ReadError(path + ": sidecars are not read yet");
}

}  // namespace tetproof::oracles
