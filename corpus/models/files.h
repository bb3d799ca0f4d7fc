// Writes files that are complete or not there, and makes folders that are removed again.
#pragma once

#include <filesystem>
#include <string>

namespace tetproof {

// Writes the text to a file beside it, which is then renamed. \throw std::runtime_error if that
// fails.
void write_whole(const std::filesystem::path& path, const std::string& text);

// A new folder for temporary files, removed with all that is in it.
class ScratchFolder {
 public:
  // \throw std::runtime_error if it cannot be made.
  explicit ScratchFolder(const std::string& purpose);
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace tetproof
