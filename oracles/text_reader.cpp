#include "oracles/text_reader.h"

#include <charconv>
#include <fstream>
#include <sstream>

namespace tetproof::oracles {

std::string read_whole_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw ReadError(path + ": cannot be opened");
  std::ostringstream contents;
  contents << stream.rdbuf();
  if (!stream.good()) throw ReadError(path + ": cannot be read, or is empty");
  return std::move(contents).str();
}

TextReader::TextReader(std::string name, std::string_view text, char comment)
    : name_(std::move(name)), text_(text), comment_(comment) {}

void TextReader::fail(const std::string& reason) const {
  throw ReadError(name_ + ":" + std::to_string(line_) + ": " + reason);
}

void TextReader::skip_blanks(bool over_lines) {
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '\n') {
      if (!over_lines) return;
      ++line_;
    } else if (c == comment_ && comment_ != '\0') {
      while (at_ < text_.size() && text_[at_] != '\n') ++at_;
      --at_;
    } else if (c != ' ' && c != '\t' && c != '\r') {
      return;
    }
  }
}

std::string_view TextReader::word() {
  skip_blanks(true);
  return word_in_line();
}

std::string_view TextReader::word_in_line() {
  skip_blanks(false);
  const std::size_t start = at_;
  while (at_ < text_.size() && text_[at_] != ' ' && text_[at_] != '\t' && text_[at_] != '\r' &&
         text_[at_] != '\n') {
    ++at_;
  }
  return text_.substr(start, at_ - start);
}

std::string_view TextReader::required_word(const char* what) {
  const std::string_view found = word();
  if (found.empty()) fail(std::string("the file ends where ") + what + " should be");
  return found;
}

void TextReader::skip_line() {
  while (at_ < text_.size() && text_[at_] != '\n') ++at_;
}

bool TextReader::at_end() {
  skip_blanks(true);
  return at_ >= text_.size();
}

double TextReader::number() {
  const std::string_view text = required_word("a number");
  std::string_view digits = text;
  const bool negative = digits.starts_with('-');
  if (negative || digits.starts_with('+')) digits.remove_prefix(1);
  const bool hexadecimal = digits.starts_with("0x") || digits.starts_with("0X");
  if (hexadecimal) digits.remove_prefix(2);
  double value = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value,
                      hexadecimal ? std::chars_format::hex : std::chars_format::general);
  // Out of range leaves the value alone: what underflows is zero, what overflows is refused.
  const bool underflow =
      error == std::errc::result_out_of_range && digits.find("e-") != std::string_view::npos;
  if ((error != std::errc() && !underflow) || end != digits.data() + digits.size() ||
      digits.starts_with('-')) {
    fail("\"" + std::string(text.substr(0, 40)) + "\" is no number");
  }
  return negative ? -value : value;
}

void TextReader::expect(const std::string& wanted) {
  const std::string_view word = required_word(wanted.c_str());
  if (word != wanted) {
    fail("\"" + std::string(word.substr(0, 40)) + "\" where " + wanted + " should be");
  }
}

void TextReader::expect_end(const std::string& wanted) {
  expect(wanted);
  if (!at_end()) fail("something follows the end");
}

std::int64_t TextReader::integer() {
  std::string_view text = required_word("an integer");
  if (text.starts_with('+')) text.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    fail("\"" + std::string(text.substr(0, 40)) + "\" is no integer");
  }
  return value;
}

std::uint32_t TextReader::index(std::int64_t first, std::uint64_t count) {
  const std::int64_t value = integer();
  if (value < first || static_cast<std::uint64_t>(value - first) >= count) {
    fail("index " + std::to_string(value) + " is out of range");
  }
  return static_cast<std::uint32_t>(value - first);
}

std::uint64_t TextReader::count() {
  const std::int64_t value = integer();
  if (value < 0 || static_cast<std::uint64_t>(value) > text_.size() / 2 + 1) {
    fail("count " + std::to_string(value) + " is more than the file can hold");
  }
  return static_cast<std::uint64_t>(value);
}

}  // namespace tetproof::oracles
