// Text for XML and HTML.
#pragma once

#include <string>

namespace tetproof {

// Escapes all characters that have a meaning in markup. Control characters, which XML 1.0 cannot
// express, become question marks.
std::string markup_text(const std::string& text);

}  // namespace tetproof
