// Suggestions for mistyped words.
#pragma once

#include <string>
#include <vector>

namespace delmesher::cli {

// The word that is fewest letters away (left out, added, replaced, or two exchanged); empty if that
// are more than two, or more than a third of the letters.
std::string nearest(const std::string& word, const std::vector<std::string>& words);

// ": did you mean WORD?", or nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& words);

}  // namespace delmesher::cli
