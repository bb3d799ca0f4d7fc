// A reader of planar graphs rejects in one line, or delivers a consistent graph. The first byte
// chooses the format.
#include "fuzz/properties.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tetproof::fuzz::on_text(
      data, size, [](const std::string& text) -> tetproof::fuzz::Finding {
        if (text.empty()) return {};
        static const char* const kNames[] = {"input.poly", "input.txt", "input.off", "input.obj"};
        const auto format = static_cast<unsigned char>(text[0]) % 4;
        return tetproof::fuzz::plane_reader_holds(text.substr(1), kNames[format]);
      });
}
