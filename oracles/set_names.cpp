#include "oracles/set_names.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace tetproof::oracles {
namespace {

// Empty if it is what a set without a name is called.
std::string plain(const SetNames& names, int dimension, std::int64_t number) {
  const auto found = names.find({dimension, number});
  if (found == names.end()) return {};
  std::string text = found->second;
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  std::istringstream words(text);
  std::string name;
  for (std::string word; words >> word;) name += (name.empty() ? "" : " ") + word;
  std::ranges::replace(name, '"', '\'');
  const std::string unnamed = (dimension == 2 ? "label " : "region ") + std::to_string(number);
  const bool side = dimension == 3 && (name == "inside" || name == "outside");
  return name == unnamed || side ? std::string() : name;
}

SetNames distinct_names(SetNames names) {
  for (const int dimension : {2, 3}) {
    std::set<std::string> given, used;
    std::map<std::string, int> last;  // number of a name
    for (const auto& [set, name] : names) {
      if (set.first == dimension) given.insert(name);
    }
    for (auto& [set, name] : names) {
      if (set.first != dimension || name.empty() || used.insert(name).second) continue;
      int& number = last.try_emplace(name, 1).first->second;
      std::string other;
      do {
        other = name + " " + std::to_string(++number);
      } while (given.contains(other) || !used.insert(other).second);
      name = other;
    }
  }
  return names;
}

}  // namespace

void compare_names(const SetNames& wanted, const SetNames& found, int dimension,
                   const std::vector<std::int64_t>& numbers, OracleReport& report) {
  const SetNames distinct = distinct_names(wanted);
  for (const std::int64_t number : std::set<std::int64_t>(numbers.begin(), numbers.end())) {
    ++report.checked;
    const std::string name = plain(found, dimension, number),
                      right = plain(distinct, dimension, number);
    // Names that differ in blanks alone are different ones for delmesher.
    if (name == right || name == plain(wanted, dimension, number)) continue;
    const auto called = [](const std::string& text) {
      return text.empty() ? std::string("without a name") : "called \"" + text + "\"";
    };
    report.fail(std::string(dimension == 2 ? "label " : "region ") + std::to_string(number) +
                " is " + called(name) + ", and was " + called(right));
  }
}

}  // namespace tetproof::oracles
