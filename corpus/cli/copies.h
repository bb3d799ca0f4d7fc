// Folders of valid surfaces with copies of each, for `tetproof rotate` and `tetproof vary`.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "corpus/cli/commands.h"
#include "mesher/delmesher.h"

namespace tetproof {

struct Copy {
  std::string name;
  std::optional<delmesher::Surface> surface;  // nothing if there is none
};

struct CopyKind {
  const char* name;      // "rotated copies"
  const char* left_out;  // why there is none
  // The copies of a surface of this name.
  std::function<std::vector<Copy>(const delmesher::Surface&, const std::string&)> copies_of;
};

// Writes the surfaces that are valid, and their copies. The exit code.
int write_copies(const CopiesArguments& arguments, const CopyKind& kind);

}  // namespace tetproof
