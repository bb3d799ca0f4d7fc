#include "oracles/verdict/edge_sizes.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string_view>
#include <system_error>

#include "oracles/base/text_reader.h"

namespace tetproof::oracles {
namespace {

using delmesher::SizeSource;

// Distance of a point from the nearest one of the edge.
double distance_between(const Position& p, const Position& a, const Position& b) {
  double along = 0, square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    along += (p[k] - a[k]) * (b[k] - a[k]);
    square += (b[k] - a[k]) * (b[k] - a[k]);
  }
  const double share = square > 0 ? std::min(std::max(along / square, 0.0), 1.0) : 0;
  return std::hypot(a[0] + share * (b[0] - a[0]) - p[0], a[1] + share * (b[1] - a[1]) - p[1],
                    a[2] + share * (b[2] - a[2]) - p[2]);
}

// In no locale, and finite. A number too small for a double is 0.
bool parse_number(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::invalid_argument || end != word.data() + word.size()) return false;
  if (error == std::errc::result_out_of_range)
    value = std::strtod(std::string(word).c_str(), nullptr);
  return std::isfinite(value);
}

bool is_number(const std::string& word) {
  double value = 0;
  return parse_number(word, value);
}

// Without a byte order mark; lines of all systems end alike.
void unify_lines(std::string& text) {
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  std::replace(text.begin(), text.end(), '\r', '\n');
}

// Spaces for the names of views and for comments, which may hold any brackets.
void blank_words(std::string& text) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool name = text[at] == '"';
    if (!name && text.compare(at, 2, "//") != 0) continue;
    std::size_t end = text.find_first_of(name ? "\"\n" : "\n", at + 1);
    end = std::min(end, text.size() - 1);
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(at),
              text.begin() + static_cast<std::ptrdiff_t>(end) + 1, ' ');
    at = end;
  }
}

std::string read_text(const std::string& path, std::string& text) {
  try {
    text = read_whole_file(path);
  } catch (const ReadError& error) {
    return error.what();
  }
  unify_lines(text);
  return {};
}

// Whatever is between numbers in lines becomes a space.
std::vector<std::string> words_of_line(std::string line) {
  if (const auto comment = line.find('#'); comment != std::string::npos) line.resize(comment);
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

// Appends the numbers of each line, so many of them.
std::string read_lines(const std::string& text, std::size_t count, const std::string& what,
                       std::vector<std::vector<double>>& rows) {
  std::istringstream in(text);
  bool first = true;
  for (std::string line; std::getline(in, line);) {
    const std::vector<std::string> words = words_of_line(line);
    if (words.empty()) continue;
    const bool numbers = std::all_of(words.begin(), words.end(), is_number);
    const bool is_head = first && !is_number(words[0]) &&
                         std::string_view("+-.0123456789").find(words[0][0]) == std::string::npos;
    first = false;
    if (is_head) continue;
    if (!numbers || words.size() != count) return "a line is not " + what + ": " + line;
    std::vector<double>& row = rows.emplace_back(count);
    for (std::size_t k = 0; k < count; ++k) parse_number(words[k], row[k]);
  }
  return {};
}

std::string read_sources(const std::string& text, std::vector<SizeSource>& sources) {
  std::vector<std::vector<double>> rows;
  std::string why = read_lines(text, 4, "X Y Z SIZE", rows);
  for (const auto& x : rows) sources.push_back({{x[0], x[1], x[2]}, x[3]});
  return why;
}

// The numbers up to the closing bracket, behind which `at` is then.
std::vector<double> numbers_to(char close, const std::string& text, std::size_t& at) {
  std::vector<double> numbers;
  while (at < text.size() && text[at] != close) {
    char* end = nullptr;
    const double number = std::strtod(text.c_str() + at, &end);
    const auto next = static_cast<std::size_t>(end - text.c_str());
    if (next > at) numbers.push_back(number);
    at = std::max(next, at + 1);
  }
  ++at;
  return numbers;
}

// The first brace opens the view; from there on every ( begins an element.
std::string read_view(const std::string& text, std::vector<SizeSource>& sources) {
  std::size_t at = text.find('{');
  while (at < text.size()) {
    at = text.find('(', at);
    if (at == std::string::npos) break;
    const std::vector<double> places = numbers_to(')', text, ++at);
    at = std::min(text.find('{', at), text.size());
    const std::vector<double> sizes = numbers_to('}', text, ++at);
    if (places.size() % 3 != 0 || 3 * sizes.size() < places.size()) return "a view without sizes";
    for (std::size_t n = 0; 3 * n < places.size(); ++n) {
      sources.push_back({{places[3 * n], places[3 * n + 1], places[3 * n + 2]}, sizes[n]});
    }
  }
  return {};
}

}  // namespace

EdgeSizes::EdgeSizes(std::vector<SizeSource> sources, double growth, double longest)
    : growth_(growth), longest_(longest) {
  if (!sources.empty()) divide(std::move(sources));
}

void EdgeSizes::divide(std::vector<SizeSource> sources) {
  constexpr std::size_t kTogether = 32;
  constexpr double kEmpty = std::numeric_limits<double>::infinity();
  Block block{{}, {kEmpty, kEmpty, kEmpty}, {-kEmpty, -kEmpty, -kEmpty}, kEmpty};
  for (const SizeSource& source : sources) {
    block.size = std::min(block.size, source.size);
    for (std::size_t k = 0; k < 3; ++k) {
      block.low[k] = std::min(block.low[k], source.point[k]);
      block.high[k] = std::max(block.high[k], source.point[k]);
    }
  }
  if (sources.size() <= kTogether) {
    block.sources = std::move(sources);
    blocks_.push_back(std::move(block));
    return;
  }
  std::size_t widest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (block.high[k] - block.low[k] > block.high[widest] - block.low[widest]) widest = k;
  }
  std::sort(sources.begin(), sources.end(), [widest](const SizeSource& x, const SizeSource& y) {
    return x.point[widest] < y.point[widest];
  });
  const auto middle = sources.begin() + static_cast<std::ptrdiff_t>(sources.size() / 2);
  divide({sources.begin(), middle});
  divide({middle, sources.end()});
}

double EdgeSizes::excess(const Position& a, const Position& b) const {
  constexpr double kSlack = 1 - 1e-9;  // of the bound of a block
  double smallest = longest_ > 0 ? longest_ : std::numeric_limits<double>::infinity();
  for (const Block& block : blocks_) {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double gap = std::max(
          {0.0, block.low[k] - std::max(a[k], b[k]), std::min(a[k], b[k]) - block.high[k]});
      square += gap * gap;
    }
    if ((block.size + growth_ * std::sqrt(square)) * kSlack > smallest) continue;
    for (const SizeSource& source : block.sources) {
      smallest = std::min(smallest, source.size + growth_ * distance_between(source.point, a, b));
    }
  }
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) / smallest;
}

std::string read_points(const std::string& path, std::vector<Position>& points) {
  points.clear();
  std::string text;
  std::vector<std::vector<double>> rows;
  std::string why = read_text(path, text);
  if (!why.empty()) return why;
  why = read_lines(text, 3, "X Y Z", rows);
  for (const auto& x : rows) points.push_back({x[0], x[1], x[2]});
  if (why.empty() && points.empty()) why = "no points in it";
  return why.empty() ? why : path + ": " + why;
}

std::string read_size_field(const std::string& path, std::vector<SizeSource>& sources) {
  sources.clear();
  std::string text;
  if (std::string why = read_text(path, text); !why.empty()) return why;
  std::istringstream words(text);
  std::string first;
  words >> first;
  const bool view = first == "View";
  if (view) blank_words(text);
  std::string why = view ? read_view(text, sources) : read_sources(text, sources);
  if (why.empty() && sources.empty()) why = "no sizes in it";
  for (const SizeSource& source : sources) {
    if (why.empty() && !(source.size > 0)) why = "sizes have to be above 0";
  }
  return why.empty() ? why : path + ": " + why;
}

void excuse_long_edges(const char* option, bool recorded, OracleReport& lengths,
                       std::vector<std::string>& unproven) {
  if (lengths.figure(kTooLong).value_or(0) == 0) return;
  char text[100];
  std::snprintf(text, sizeof text, "%s (%.0f edges are longer, up to %.3g times)", option,
                lengths.figure(kTooLong).value_or(0), lengths.figure(kLargestEdge).value_or(0));
  unproven.emplace_back(text);
  if (recorded) {
    lengths.only_count();
  } else {
    lengths.undecided = true;
    lengths.notes.emplace_back(
        "edges at corners that were chamfered may be longer; a record (--exact) says where");
  }
}

}  // namespace tetproof::oracles
