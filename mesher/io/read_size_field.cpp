#include <array>
#include <utility>

#include "mesher/io/reading.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

double number_of(std::string_view token, Position here) {
  double value = 0;
  if (parse_double(token, value) != NumberStatus::ok)
    fail(here, "not a number: " + in_quotes(token));
  return value;
}

void add(const SizeSource& source, Position here, std::vector<SizeSource>& sources) {
  if (!(source.size > 0)) fail(here, "sizes have to be above 0");
  sources.push_back(source);
}

// The name of a column, not a number with a mistake in it.
bool is_name(std::string_view token) {
  double value = 0;
  return parse_double(token, value) == NumberStatus::malformed &&
         std::string_view("+-.0123456789").find(token.front()) == std::string_view::npos;
}

// Calls visit(numbers, here) for each line of so many numbers. The first line may be of names.
template <std::size_t kCount, class Visit>
void parse_lines(std::string_view text, const std::string& expected, const Visit& visit) {
  TextLines in(text, Comments::at_token_start, ',');
  for (bool first = true; in.next_line(); first = false) {
    const Position here = at_line(in.line());
    std::array<double, kCount> numbers;
    std::size_t count = 0;
    bool names = false;
    for (std::string_view token; in.next_token(token); ++count) {
      names = names || (first && count == 0 && is_name(token));
      if (names) continue;
      if (count == kCount) fail(here, "more numbers than expected: " + expected);
      numbers[count] = number_of(token, here);
    }
    if (names) continue;
    if (count != kCount) fail(here, "fewer numbers than expected: " + expected);
    visit(numbers, here);
  }
}

std::vector<SizeSource> parse_sources(std::string_view text) {
  std::vector<SizeSource> sources;
  parse_lines<4>(text, "X Y Z SIZE", [&](const std::array<double, 4>& x, Position here) {
    add({{x[0], x[1], x[2]}, x[3]}, here, sources);
  });
  return sources;
}

// View "name" { SP(x,y,z){value}; SS(x,y,z, ... four of them){value, ... four}; ... };
class ViewReader {
 public:
  explicit ViewReader(std::string_view text) : text_(text) {}

  std::vector<SizeSource> read() {
    while (next_view()) {
      expect('{');
      while (!accept('}')) read_element();
      accept(';');
    }
    return std::move(sources_);
  }

 private:
  Position here() const { return at_line(line_); }

  void skip_space() {
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\n') {
        ++line_;
      } else if (text_.substr(at_, 2) == "//") {
        while (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
      } else if (text_[at_] != ' ' && text_[at_] != '\t' && text_[at_] != '\r') {
        return;
      }
    }
  }
  bool accept(char c) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail(here(), std::string("this is not a view of Gmsh: a ") + c + " is missing");
  }
  std::string_view word() {
    skip_space();
    const std::size_t begin = at_;
    while (at_ < text_.size() &&
           std::string_view(" \t\r\n(){},;\"").find(text_[at_]) == std::string_view::npos) {
      ++at_;
    }
    return text_.substr(begin, at_ - begin);
  }

  bool next_view() {
    skip_space();
    if (at_ == text_.size()) return false;
    const std::string_view name = word();
    if (name != "View") fail(here(), "not a view: " + in_quotes(name));
    expect('"');
    while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n') ++at_;
    expect('"');
    return true;
  }

  std::vector<double> numbers(char open, char close) {
    std::vector<double> list;
    expect(open);
    do {
      list.push_back(number_of(word(), here()));
    } while (accept(','));
    expect(close);
    return list;
  }

  // If a corner has several values, which are steps of time, the first one counts.
  void read_element() {
    const std::string_view name = word();
    if (name.size() != 2 || name[0] != 'S') {
      fail(here(), "only views of scalars have sizes, no " + in_quotes(name));
    }
    const std::vector<double> at = numbers('(', ')'), size = numbers('{', '}');
    const std::size_t corners = at.size() / 3;
    if (corners == 0 || at.size() % 3 != 0 || size.size() % corners != 0) {
      fail(here(), std::to_string(at.size()) + " coordinates, but " + std::to_string(size.size()) +
                       " values");
    }
    for (std::size_t n = 0; n < corners; ++n) {
      add({{at[3 * n], at[3 * n + 1], at[3 * n + 2]}, size[n]}, here(), sources_);
    }
    expect(';');
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::uint64_t line_ = 1;
  std::vector<SizeSource> sources_;
};

std::vector<SizeSource> parse(std::string_view text) {
  TextLines in(text, Comments::none);
  std::string_view first;
  const bool is_view = in.next_line() && in.next_token(first) && first == "View";
  std::vector<SizeSource> sources = is_view ? ViewReader(text).read() : parse_sources(text);
  if (sources.empty()) fail({}, "no sizes in it");
  return sources;
}

}  // namespace

SizeFieldResult read_size_field(const std::string& path) {
  try {
    return {{}, parse(read_file(path))};
  } catch (...) {
    return {end_of_reading(path).error, {}};
  }
}

PointsResult read_points(const std::string& path) {
  PointsResult result;
  try {
    parse_lines<3>(read_file(path), "X Y Z",
                   [&](const std::array<double, 3>& x, Position) { result.points.push_back(x); });
    if (result.points.empty()) fail({}, "no points in it");
  } catch (...) {
    return {end_of_reading(path).error, {}};
  }
  return result;
}

}  // namespace delmesher::io
