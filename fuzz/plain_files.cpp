#include "fuzz/plain_files.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace tetproof::fuzz {
namespace {

using Words = std::vector<std::string_view>;
using Point = std::array<double, 3>;

// The words of each line that has any; nothing if there are other characters than visible ones,
// spaces and ends of lines.
std::optional<std::vector<Words>> lines_of(std::string_view text) {
  std::vector<Words> lines(1);
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : '\n';
    if (c > ' ' && c <= '~') continue;
    if (c != ' ' && c != '\n') return {};
    if (i > begin) lines.back().push_back(text.substr(begin, i - begin));
    begin = i + 1;
    if (c == '\n' && !lines.back().empty()) lines.emplace_back();
  }
  lines.pop_back();
  return lines;
}

template <class Number>
bool number(std::string_view word, Number& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

bool point(const Words& words, std::size_t from, Point& p) {
  for (std::size_t i = 0; i < 3; ++i) {
    const bool digits =
        words[from + i].find_first_not_of("-.e0123456789") == std::string_view::npos;
    if (!digits || !number(words[from + i], p[i]) || !std::isfinite(p[i])) return false;
  }
  return true;
}

bool distinct(const std::array<Point, 3>& t) {
  return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

// Three numbers of vertices counted from `base`, or, if `backwards`, negative ones from the end.
bool triangle(const Words& words, const std::vector<Point>& vertices, int base, bool backwards,
              std::array<Point, 3>& t) {
  const auto count = static_cast<int>(vertices.size());
  for (std::size_t i = 0; i < 3; ++i) {
    int v = 0;
    if (!number(words[1 + i], v)) return false;
    v = backwards && v < 0 ? count + v : v - base;
    if (v < 0 || v >= count) return false;
    t[i] = vertices[static_cast<std::size_t>(v)];
  }
  return distinct(t);
}

bool read_obj(const std::vector<Words>& lines, TriangleSoup& soup) {
  std::vector<Point> vertices;
  for (const Words& words : lines) {
    if (words.size() != 4) return false;
    if (words[0] == "v") {
      if (!point(words, 1, vertices.emplace_back())) return false;
    } else if (words[0] != "f" || !triangle(words, vertices, 1, true, soup.emplace_back())) {
      return false;
    }
  }
  return true;
}

bool read_off(const std::vector<Words>& lines, TriangleSoup& soup) {
  std::size_t counts[2];
  if (lines.size() < 2 || lines[0] != Words{"OFF"} || lines[1].size() != 3 ||
      !number(lines[1][0], counts[0]) || !number(lines[1][1], counts[1]) || lines[1][2] != "0" ||
      counts[0] > lines.size() || lines.size() != 2 + counts[0] + counts[1]) {
    return false;
  }
  std::vector<Point> vertices(counts[0]);
  for (std::size_t v = 0; v < counts[0]; ++v) {
    if (lines[2 + v].size() != 3 || !point(lines[2 + v], 0, vertices[v])) return false;
  }
  for (std::size_t n = 2 + counts[0]; n < lines.size(); ++n) {
    const Words& words = lines[n];
    if (words.size() != 4 || words[0] != "3" ||
        !triangle(words, vertices, 0, false, soup.emplace_back())) {
      return false;
    }
  }
  return true;
}

bool read_stl(const std::vector<Words>& lines, TriangleSoup& soup) {
  constexpr std::size_t kLines = 7;  // of a facet
  if (lines.size() < 2 || lines.size() % kLines != 2 || lines[0] != Words{"solid"} ||
      lines.back() != Words{"endsolid"}) {
    return false;
  }
  for (std::size_t n = 1; n + 1 < lines.size(); n += kLines) {
    const auto* line = &lines[n];
    Point normal;
    if (line[0].size() != 5 || line[0][0] != "facet" || line[0][1] != "normal" ||
        !point(line[0], 2, normal) || line[1] != Words{"outer", "loop"} ||
        line[5] != Words{"endloop"} || line[6] != Words{"endfacet"}) {
      return false;
    }
    auto& t = soup.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      if (line[2 + i].size() != 4 || line[2 + i][0] != "vertex" || !point(line[2 + i], 1, t[i])) {
        return false;
      }
    }
    if (!distinct(t)) return false;
  }
  return true;
}

}  // namespace

std::optional<TriangleSoup> plain_triangles(const std::string& text, const std::string& name) {
  const auto lines = lines_of(text);
  if (!lines) return {};
  const auto has = [&](std::string_view extension) {
    return name.size() > extension.size() &&
           std::string_view(name).substr(name.size() - extension.size()) == extension;
  };
  TriangleSoup soup;
  const bool plain = has(".obj")   ? read_obj(*lines, soup)
                     : has(".off") ? read_off(*lines, soup)
                     : has(".stl") ? read_stl(*lines, soup)
                                   : false;
  if (!plain || soup.empty()) return {};
  return soup;
}

}  // namespace tetproof::fuzz
