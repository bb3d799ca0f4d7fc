#include <fmt/core.h>

#include <stdexcept>
#include <utility>

#include "corpus/cli/copies.h"
#include "corpus/generators/certify.h"
#include "corpus/generators/vary.h"

namespace tetproof {
namespace {

std::vector<Copy> varied_copies(const delmesher::Surface& given, const std::string& name) {
  std::vector<Copy> copies;
  for (ExactCopy& exact : exact_copies(given)) {
    const Copy& copy = copies.emplace_back(
        Copy{fmt::format("{}@{}", name, exact.suffix), std::move(exact.surface)});
    // An exact copy is as valid as what it is a copy of.
    if (copy.surface && !certified_valid(*copy.surface)) {
      throw std::logic_error(copy.name + ": not valid");
    }
  }
  return copies;
}

}  // namespace

int vary_command(const CopiesArguments& arguments) {
  return write_copies(arguments, {"exact copies", "not in doubles", varied_copies});
}

}  // namespace tetproof
