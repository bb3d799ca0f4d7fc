#include "fuzz/scratch.h"

#include <unistd.h>

#include <cstdlib>
#include <string>

namespace tetproof::fuzz {

namespace fs = std::filesystem;

const fs::path& scratch() {
  static const struct Folder {
    Folder() {
      // In memory where there is such a folder: a campaign writes millions of files.
      const bool memory = access("/dev/shm", W_OK) == 0;
      std::string name =
          (fs::path(memory ? "/dev/shm" : fs::temp_directory_path()) / "tetproof-fuzz-XXXXXX")
              .string();
      if (mkdtemp(name.data()) == nullptr) std::abort();
      path = name;
    }
    ~Folder() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
    fs::path path;
  } folder;
  return folder.path;
}

}  // namespace tetproof::fuzz
