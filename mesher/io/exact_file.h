// The exact form of a run as text: the sidecar of --exact. exact_format.md has the grammar.
#pragma once

#include <string>
#include <string_view>

#include "mesher/delmesher_files.h"
#include "mesher/io/output.h"

namespace delmesher::io {

inline constexpr int kExactVersion = 7;

WriteStatus write_exact(OutputSet& outputs, const std::string& path, const ExactRecord& record);

// read_exact() of a file's bytes; `path` names it in errors.
ExactResult parse_exact(std::string_view text, const std::string& path);

}  // namespace delmesher::io
