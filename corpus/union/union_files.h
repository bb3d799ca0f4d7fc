// `tetproof union`: from file to file.
#pragma once

#include <functional>
#include <string>

#include "corpus/union/unite.h"

namespace tetproof::unite {

// Can a surface be written under this name?
bool is_surface_output(const std::string& path);

// Reads a surface, writes its union (.stl, .ply or .off, complete or what was there before) with
// labels and their names, and says a line for each thing that was done. The exit code: 0 done; 1
// written, but parts touch, so that it is not manifold there; 3 a file cannot be read or written; 4
// no union: it does not close up, or nothing is inside; 5 a limit: memory, the precision of
// doubles, or how far touching parts may be moved apart; 6 internal error; 130 interrupted. Nothing
// is written but with 0 and 1.
int unite_files(const std::string& input, const std::string& output, const UnionOptions& options,
                const std::function<void(const std::string&)>& say);

}  // namespace tetproof::unite
