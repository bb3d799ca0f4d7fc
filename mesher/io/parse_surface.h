// Parts of the reader of surfaces; see formats.md. read_surface() is public.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "mesher/delmesher_files.h"

namespace delmesher::io {

// Larger files are refused.
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{8} << 30;

// read_surface() of a file's bytes; `path` gives the extension and the name for messages, and no
// file is opened.
ReadResult parse_surface(std::string_view bytes, const std::string& path,
                         const ReadOptions& options = {});

// A whole file as bytes; nullopt with the reason in `error`. Throws ReadingStopped.
std::optional<std::string> read_file(const std::string& path, std::string& error,
                                     const std::function<bool()>& go_on = {});

}  // namespace delmesher::io
