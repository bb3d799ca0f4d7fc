// Parts of the reader of surfaces; see formats.md. read_surface() is public.
#pragma once

#include <string>
#include <string_view>

#include "mesher/delmesher_files.h"

namespace delmesher::io {

// read_surface() of a file's bytes; `path` gives the extension and the name for messages, and no
// file is opened.
ReadResult parse_surface(std::string_view bytes, const std::string& path,
                         const ReadOptions& options = {});

}  // namespace delmesher::io
