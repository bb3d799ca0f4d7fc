// Files of other kinds than the mesher reads, known by their first bytes.
#pragma once

#include <string_view>

namespace delmesher::io {

// The kind of the file and a way to read it ("compressed with xz: unpack it first"); empty if
// nothing is known.
std::string_view foreign_content(std::string_view bytes);

}  // namespace delmesher::io
