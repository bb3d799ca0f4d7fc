// Text for XML and HTML.
#pragma once

#include <string>

namespace tetproof {

// With everything escaped that has a meaning there, and with control characters, which XML 1.0 has
// no way to write, as question marks.
std::string markup_text(const std::string& text);

}  // namespace tetproof
