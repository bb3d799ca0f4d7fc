// A reader of meshes rejects in one line, or its mesh is read back as written, and improved or
// refused. Compiled once per format.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tetproof::fuzz::on_text(data, size, [](const std::string& text) {
    return tetproof::fuzz::mesh_reader_holds(text, "input." TETPROOF_FORMAT);
  });
}
