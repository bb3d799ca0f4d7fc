// Files of other kinds than the mesher reads, known by their first bytes.
#pragma once

#include <string_view>

namespace delmesher::io {

// What the file is and what to do about it ("compressed with gzip: unpack it first"); empty if
// nothing is known.
std::string_view foreign_content(std::string_view bytes);

}  // namespace delmesher::io
