// Files written all or none: into temporaries beside their targets, renamed when all are complete.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "mesher/delmesher_files.h"

namespace delmesher::io {

// Buffered text. Errors of the disk are remembered until the file is closed.
class TextSink {
 public:
  explicit TextSink(std::FILE* file) : file_(file) { buffer_.reserve(kBufferSize + 256); }

  void text(std::string_view s) {
    buffer_ += s;
    flush_if_full();
  }
  // The shortest decimal that reads back as the same double.
  void number(double value);
  void hex(double value);
  template <typename T>
  void integer(T value) {
    char digits[24];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    text(std::string_view(digits, static_cast<std::size_t>(end - digits)));
  }
  template <typename... T>
  void integers(T... values) {  // with a space after each
    ((integer(values), text(" ")), ...);
  }
  // x y z, separated by spaces.
  void point(const std::array<double, 3>& p);

  // The headline of a list, as records have it.
  void section(const char* name, std::size_t count) {
    text(name);
    text(" ");
    integer(count);
    text("\n");
  }

  bool flush();
  // errno of the first write that failed, or 0.
  int failure() const { return failure_; }

 private:
  static constexpr std::size_t kBufferSize = std::size_t{1} << 18;
  void flush_if_full() {
    if (buffer_.size() >= kBufferSize) flush();
  }
  std::FILE* file_;
  std::string buffer_;
  bool failed_ = false;
  int failure_ = 0;
};

class OutputSet {
 public:
  // Told the paths of the temporaries whenever there is one more (and the empty list when there are
  // none left), so that a program can remove them should it be killed; after them the folders that
  // were made, inner ones first.
  using Watcher = std::function<void(const std::vector<std::string>&)>;

  explicit OutputSet(Watcher watcher = nullptr) : watcher_(std::move(watcher)) {}
  ~OutputSet();  // removes the files that were not committed
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;

  // From now on open() makes the folders that are missing; those it made go with the files, should
  // they not be committed.
  void make_folders() { makes_folders_ = true; }

  // Begins a file. A symbolic link is followed; something that exists and is not a regular file (a
  // device, a pipe) is written directly. Returns null with status.error on failure.
  TextSink* open(const std::string& path, WriteStatus& status);

  // Completes all files, brings them to the disk, then renames them to their targets. Where one
  // cannot be written or renamed, every target stays as it was. A power cut between the renamings
  // can leave some targets new and some old, each of them complete, and the former ones under
  // hidden names that end in .oldN.
  WriteStatus commit();

 private:
  struct File {
    std::string path, target, temporary;
    std::string former;   // where the target's former content is while others are renamed
    bool placed = false;  // the target is the new file
    std::FILE* file = nullptr;
    std::unique_ptr<TextSink> sink;
  };
  WriteStatus put_in_place();
  void restore_targets() noexcept;  // without memory, too
  void discard();
  void tell_watcher();
  bool make_folder(const std::string& target);
  std::FILE* create(const std::string& target, std::string& temporary);

  Watcher watcher_;
  bool makes_folders_ = false;
  std::vector<std::string> made_folders_;  // outer ones first
  std::vector<File> files_;
};

// "-", or "-.EXT", which names a format as well: standard input where it is read, standard output
// where it is written. ("./-" is a file of that name.)
bool is_standard_stream(const std::string& path);

// Whether a file could be created at `path` now; leaves nothing behind. What is missing of its
// folder may be made later.
enum class MissingFolder { is_an_error, is_made };
WriteStatus check_writable(const std::string& path, MissingFolder missing);

}  // namespace delmesher::io
