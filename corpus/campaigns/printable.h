// Prepares names of files for lines of text.
#pragma once

#include <string>

namespace tetproof {

// Control characters become '?', among them newlines and characters that move a terminal's cursor,
// so that a line stays one line whatever a file is called.
inline std::string printable(std::string text) {
  for (char& c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 32 || code == 127) c = '?';
  }
  return text;
}

}  // namespace tetproof
