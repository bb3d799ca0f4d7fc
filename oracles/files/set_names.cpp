#include "oracles/files/set_names.h"

#include <algorithm>
#include <array>
#include <bit>
#include <set>
#include <sstream>
#include <string_view>

namespace tetproof::oracles {
namespace {

// The number of the character at the front, whose bytes are taken; -1 if they are not UTF-8.
std::int64_t take_character(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text.front());
  const int size = std::countl_one(first);
  if (size == 1 || size > 4 || text.size() < static_cast<std::size_t>(size)) return -1;
  std::int64_t code = first & (0xffU >> static_cast<unsigned>(size));
  for (int i = 1; i < size; ++i) {
    const auto next = static_cast<unsigned char>(text[static_cast<std::size_t>(i)]);
    if (std::countl_one(next) != 1) return -1;
    code = code * 64 + (next & 0x3f);
  }
  // The least number that takes so many bytes.
  constexpr std::array<std::int64_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < kLeast[static_cast<std::size_t>(size)] || code > 0x10ffff || surrogate) return -1;
  text.remove_prefix(static_cast<std::size_t>(std::max(size, 1)));
  return code;
}

// A name that is not in UTF-8 is in Latin-1; nor is one with characters that XML does not have.
std::string in_utf8(const std::string& name) {
  bool is_utf8 = true;
  for (std::string_view rest = name; is_utf8 && !rest.empty();) {
    const std::int64_t code = take_character(rest);
    is_utf8 = code >= 0 && code != 0xfffe && code != 0xffff;
  }
  if (is_utf8) return name;
  std::string text;
  for (const char c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (code >= 0x80) text += static_cast<char>(0xc0 | code / 64);
    text += static_cast<char>(code >= 0x80 ? 0x80 | code % 64 : code);
  }
  return text;
}

SetNames in_utf8(SetNames names) {
  for (auto& [set, name] : names) name = in_utf8(name);
  return names;
}

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

void compare_names(const SetNames& names_wanted, const SetNames& found, int dimension,
                   const std::vector<std::int64_t>& numbers, OracleReport& report) {
  const SetNames wanted = in_utf8(names_wanted), distinct = distinct_names(wanted);
  for (const std::int64_t number : std::set<std::int64_t>(numbers.begin(), numbers.end())) {
    ++report.checked;
    const std::string name = plain(found, dimension, number),
                      right = plain(distinct, dimension, number);
    // Names that differ in blanks alone are different ones for delmesher.
    if (name == right || name == plain(wanted, dimension, number)) continue;
    const auto called = [](const std::string& text) {
      return text.empty() ? std::string("without a name") : "called \"" + in_utf8(text) + "\"";
    };
    report.fail(std::string(dimension == 2 ? "label " : "region ") + std::to_string(number) +
                " is " + called(name) + ", and was " + called(right));
  }
}

bool is_called(const std::string& name, const std::string& wanted) {
  if (!name.starts_with(wanted)) return false;
  const std::string rest = name.substr(wanted.size());
  return rest.empty() || (rest.size() > 1 && rest[0] == ' ' &&
                          rest.find_first_not_of("0123456789", 1) == rest.npos);
}

}  // namespace tetproof::oracles
