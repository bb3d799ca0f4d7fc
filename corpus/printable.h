// Names of files in lines of text.
#pragma once

#include <string>

namespace tetproof {

// Control characters, among them newlines and what moves a terminal's cursor, become '?', so that a
// line stays one line whatever a file is called.
inline std::string printable(std::string text) {
  for (char& c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 32 || code == 127) c = '?';
  }
  return text;
}

}  // namespace tetproof
