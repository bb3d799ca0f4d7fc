#include <fmt/core.h>

#include "corpus/cli/copies.h"
#include "corpus/generate/certify.h"
#include "corpus/generate/rotate.h"

namespace tetproof {
namespace {

std::vector<Copy> rotated_copies(const delmesher::Surface& given, const std::string& name) {
  std::vector<Copy> copies;
  for (std::size_t r = 0; r < kRotations.size(); ++r) {
    for (const Precision precision : {Precision::doubles, Precision::single}) {
      Copy& copy = copies.emplace_back();
      copy.name = fmt::format("{}@r{}{}", name, r + 1, precision == Precision::single ? "s" : "");
      copy.surface = rotated(given, kRotations[r], precision);
      if (!certified_valid(*copy.surface)) copy.surface.reset();
    }
  }
  return copies;
}

}  // namespace

int rotate_command(const CopiesArguments& arguments) {
  return write_copies(arguments,
                      {"rotated copies", "not valid once it is rounded", rotated_copies});
}

}  // namespace tetproof
