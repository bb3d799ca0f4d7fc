// The exact form of a run as text: the sidecar of --exact. exact_format.md has the grammar.
#pragma once

#include <string>
#include <string_view>

#include "mesher/delmesher.h"
#include "mesher/io/output.h"

namespace delmesher::io {

inline constexpr int kExactVersion = 3;

WriteStatus write_exact(OutputSet& outputs, const std::string& path, const ExactRecord& record);

struct ExactResult {
  std::string error;  // "file:line: reason"; empty if read
  ExactRecord record;
  bool ok() const { return error.empty(); }
};

ExactResult read_exact(const std::string& path);
ExactResult parse_exact(std::string_view text, const std::string& path);

}  // namespace delmesher::io
