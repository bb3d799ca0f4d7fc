#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "corpus/cli/commands.h"

namespace tetproof {

// Commits are built, so the command is a script of the sources (ci/campaigns/bisect), which takes
// the place of this program.
int bisect_command(char** argv) {
  namespace fs = std::filesystem;
  for (fs::path folder = fs::current_path();; folder = folder.parent_path()) {
    const fs::path script = folder / "ci" / "campaigns" / "bisect";
    if (access(script.c_str(), X_OK) == 0) {
      execv(script.c_str(), argv);
      throw std::system_error(errno, std::generic_category(), script.string());
    }
    if (folder == folder.root_path()) break;
  }
  throw UsageError(
      "bisect: a clone of the project is expected here or above, with its ci/campaigns/bisect");
}

}  // namespace tetproof
