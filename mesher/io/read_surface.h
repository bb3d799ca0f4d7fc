// Reads a surface from a file of any supported format; see formats.md.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesher/delmesher.h"

namespace delmesher::io {

enum class ReadCode : std::uint8_t {
  ok,
  unreadable,
  out_of_memory,
  stopped  // ReadOptions::go_on said no
};

struct ReadResult {
  ReadCode code = ReadCode::ok;
  std::string error;  // "file:line: reason", "file: byte N: reason" or "file: reason"
  Surface surface;
  std::string format;                               // "OFF", "OBJ", "STL", "PLY", "smesh", "poly"
  std::vector<std::string> warnings;                // what the user should know
  std::vector<std::string> notes;                   // what a log may tell
  std::vector<std::array<std::uint32_t, 2>> lines;  // ReadOptions::planar: edges of polylines
  bool ok() const { return code == ReadCode::ok; }
};

struct ReadOptions {
  // OBJ vertices may have two coordinates, and polylines are read; there may be no faces then.
  bool planar = false;
  // Asked many times a second while a file is read; reading stops when it answers no.
  std::function<bool()> go_on;
};

// Larger files are refused.
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{8} << 30;

ReadResult read_surface(const std::string& path, const ReadOptions& options = {});

// The same for a file's bytes; `path` gives the extension and the name for messages, and no file is
// opened.
ReadResult parse_surface(std::string_view bytes, const std::string& path,
                         const ReadOptions& options = {});

// A whole file as bytes; nullopt with the reason in `error`. Throws ReadingStopped.
std::optional<std::string> read_file(const std::string& path, std::string& error,
                                     const std::function<bool()>& go_on = {});

}  // namespace delmesher::io
