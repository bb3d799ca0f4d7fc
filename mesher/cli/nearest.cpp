#include "mesher/cli/nearest.h"

#include <algorithm>
#include <cstddef>

namespace delmesher::cli {
namespace {

// Damerau's distance, without changes of letters that have been exchanged.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min(
          {d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& words) {
  constexpr std::size_t kLongest = 64;  // nobody means an option by more
  std::string best;
  if (word.size() > kLongest) return best;
  std::size_t fewest = std::min<std::size_t>(3, word.size() / 3 + 1);
  for (const std::string& candidate : words) {
    const std::size_t letters = distance(word, candidate);
    if (letters < fewest) {
      fewest = letters;
      best = candidate;
    }
  }
  return best;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& words) {
  const std::string meant = nearest(word, words);
  return meant.empty() ? "" : ": did you mean " + meant + "?";
}

}  // namespace delmesher::cli
