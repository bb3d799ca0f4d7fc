#include <fmt/core.h>

#include <span>

#include "corpus/cli/copies.h"
#include "corpus/generators/certify.h"
#include "corpus/generators/rotate.h"

namespace tetproof {
namespace {

std::vector<Copy> rotated_copies(const delmesher::Surface& given, const std::string& name,
                                 std::span<const Quaternion> rotations) {
  std::vector<Copy> copies;
  for (std::size_t r = 0; r < rotations.size(); ++r) {
    for (const Precision precision : {Precision::doubles, Precision::single}) {
      Copy& copy = copies.emplace_back();
      copy.name = fmt::format("{}@r{}{}", name, r + 1, precision == Precision::single ? "s" : "");
      copy.surface = rotated(given, rotations[r], precision);
      if (!certified_valid(*copy.surface)) copy.surface.reset();
    }
  }
  return copies;
}

}  // namespace

int rotate_command(const CopiesArguments& arguments) {
  std::vector<Quaternion> rotations(kRotations.begin(), kRotations.end());
  if (arguments.seed) {
    Random random(*arguments.seed);
    rotations = {rotation_from(random)};
  }
  const auto copies_of = [&](const delmesher::Surface& given, const std::string& name) {
    return rotated_copies(given, name, rotations);
  };
  return write_copies(arguments, {"rotated copies", "not valid once it is rounded", copies_of});
}

}  // namespace tetproof
