// Text for shells.
#pragma once

#include <string>

namespace tetproof {

// One word of a shell's command line, in single quotes.
inline std::string shell_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      result += c;
    }
  }
  return result + "'";
}

}  // namespace tetproof
